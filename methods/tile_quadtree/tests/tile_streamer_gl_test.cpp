// Tiles in a texture of a fixed number of slots, and the region that is seen of what is drawn.

#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <thread>

#include "common/tile_streamer.h"
#include "gl/frame_blocks.h"
#include "support/context_for_test.h"
#include "support/fake_terrain.h"
#include "support/method_fixture.h"
#include "support/room_shaders.h"
#include "tile_quadtree/tile_scene.cpp"  // the room is a plugin, not a library

namespace lodbench::common {
namespace {

using namespace std::chrono_literals;
using test::FakeTerrain;

float height_of(int row, int column) {
    return float(row) + float(column) / 8192;
}

/// A tile's heights as the texture has them.
std::vector<float> layer(const TileStreamer& streamer, int slot) {
    std::vector<float> heights(kTileSampleCount);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureSubImage(streamer.heights().name(), 0, 0, 0, slot, kTileSamples, kTileSamples, 1,
                         GL_RED, GL_FLOAT, GLsizei(heights.size() * sizeof(float)), heights.data());
    return heights;
}

class Streaming : public testing::Test {
protected:
    Streaming() { terrain.height = height_of; }

    void start(int slots, int uploads = 100, int threads = 2) {
        streamer.emplace(
            terrain, TileStreamerOptions{
                         .slots = slots, .loader_threads = threads, .uploads_per_frame = uploads});
        streamer->upload(gl.device, "test: tiles");
    }
    void TearDown() override {
        if (streamer) streamer->release();
        EXPECT_TRUE(gl.device.take_errors().empty());
        EXPECT_EQ(gl.device.objects(), gl::ObjectCounts{});
        EXPECT_EQ(gl.device.allocated_bytes(), 0U);
    }
    /// Until nothing changes any more.
    void update(const std::vector<TileId>& leaves, const std::vector<TileId>& ancestors = {},
                const std::vector<TileId>& prefetch = {}) {
        for (int i = 0; i < 100; ++i) {
            streamer->update({leaves, ancestors, prefetch});
            std::this_thread::sleep_for(200us);
        }
    }
    [[nodiscard]] bool there(const TileId& tile) const { return streamer->slot(tile).has_value(); }
    void expect_right(const TileId& tile) {
        ASSERT_TRUE(there(tile));
        std::vector<float> expected(kTileSampleCount);
        terrain.read_tile(tile, expected);
        EXPECT_EQ(layer(*streamer, *streamer->slot(tile)), expected);
    }

    test::GlTest gl;
    FakeTerrain terrain{1025, 1025};  // 16 x 16 tiles, five levels
    std::optional<TileStreamer> streamer;
};

TEST_F(Streaming, has_the_root_from_the_start_and_each_tile_in_its_slot) {
    start(20);
    expect_right({4, 0, 0});
    std::vector<TileId> leaves;
    for (int i = 0; i < 19; ++i) leaves.push_back({0, i % 16, i / 2});
    update(leaves);
    for (const TileId& tile : leaves) expect_right(tile);
    expect_right({4, 0, 0});
    EXPECT_EQ(streamer->counts().uploaded, 20U);
    EXPECT_EQ(streamer->counts().bytes(), 20U * 65 * 65 * 4);
    EXPECT_EQ(streamer->counts().dropped, 0U);
    EXPECT_THROW(update(std::vector<TileId>(20, TileId{0, 0, 0})), ContractError);
}

TEST_F(Streaming, what_is_wanted_stays_and_what_was_wanted_longest_ago_goes) {
    start(5);
    update({{0, 0, 0}, {0, 0, 1}});
    update({{0, 0, 1}, {0, 0, 2}});
    update({{0, 0, 1}, {0, 0, 3}});
    EXPECT_TRUE(there({0, 0, 0})) << "there was room for all";
    update({{0, 0, 1}, {0, 0, 4}});
    EXPECT_FALSE(there({0, 0, 0}));
    for (const int column : {1, 2, 3, 4}) expect_right({0, 0, column});
}

TEST_F(Streaming, ancestors_come_first_and_only_where_the_leaves_leave_room) {
    start(8, 100, 1);
    const std::vector<TileId> leaves = {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 1, 1}};
    update(leaves, {{3, 0, 0}, {2, 0, 0}, {1, 0, 0}});
    const std::vector<TileId> read = terrain.read_so_far();
    ASSERT_EQ(read.size(), 8U);
    EXPECT_EQ(read[1].level, 3);
    // Eight slots: the root, six leaves, one more.
    const std::vector<TileId> more = {{0, 4, 0}, {0, 4, 1}, {0, 5, 0},
                                      {0, 5, 1}, {0, 4, 2}, {0, 4, 3}};
    update(more, {{3, 0, 0}, {2, 1, 0}, {1, 2, 0}});
    for (const TileId& tile : more) expect_right(tile);
    EXPECT_EQ(streamer->resident(), 8);
}

TEST_F(Streaming, tiles_are_prefetched_when_nothing_else_is_missing_and_never_in_a_leafs_place) {
    start(4);
    update({{0, 0, 0}, {0, 0, 1}}, {}, {{0, 0, 2}, {0, 0, 3}});
    EXPECT_TRUE(there({0, 0, 0}));
    EXPECT_TRUE(there({0, 0, 1}));
    EXPECT_EQ(streamer->counts().prefetched, 1U) << "one slot is left";
    EXPECT_EQ(streamer->counts().misses(), streamer->counts().requested - streamer->counts().hits);
}

TEST_F(Streaming, no_more_tiles_go_to_the_gpu_in_a_frame_than_allowed) {
    start(40, 3);
    std::vector<TileId> leaves;
    for (int i = 0; i < 16; ++i) leaves.push_back({0, 3, i});
    streamer->update({leaves, {}, {}});
    for (int frame = 0; frame < 20; ++frame) {
        std::this_thread::sleep_for(2ms);
        const int before = streamer->resident();
        streamer->update({leaves, {}, {}});
        EXPECT_LE(streamer->resident(), before + 3);
    }
    EXPECT_EQ(streamer->resident(), 17);
}

TEST_F(Streaming, load_waits_for_all_and_forget_leaves_the_root) {
    start(10);
    const std::vector<TileId> leaves = {{0, 7, 7}, {1, 0, 0}, {2, 3, 3}};
    streamer->update({std::vector<TileId>{{0, 1, 1}, {0, 2, 2}}, {}, {}});  // on their way
    streamer->load(leaves);
    for (const TileId& tile : leaves) expect_right(tile);
    streamer->forget();
    EXPECT_EQ(streamer->resident(), 1);
    expect_right({4, 0, 0});
    streamer->load(leaves);
    for (const TileId& tile : leaves) expect_right(tile);
}

TEST_F(Streaming, is_released_under_load) {
    terrain.before_read = [](const TileId&) { std::this_thread::sleep_for(1ms); };
    start(200);
    std::vector<TileId> leaves;
    for (int i = 0; i < 150; ++i) leaves.push_back({0, i / 16, i % 16});
    streamer->update({leaves, {}, {}});
    std::this_thread::sleep_for(3ms);
    streamer->release();
    EXPECT_LT(terrain.tiles_served(), 60U);
}

}  // namespace
}  // namespace lodbench::common

namespace lodbench::tile_quadtree {
namespace {

/// The samples that a camera with a field of view wider by `widening` has in view.
SampleBox samples_in_view(const terrain::HeightField& terrain, const Camera& camera,
                          double widening) {
    const TerrainInfo& info = terrain.info();
    SampleBox box{1 << 30, 1 << 30, -1, -1};
    const glm::dvec2 tangents = camera.half_tangents() * widening;
    for (int row = 0; row < info.rows; ++row) {
        for (int column = 0; column < info.columns; ++column) {
            const float height =
                terrain
                    .samples()[std::size_t(row) * std::size_t(info.columns) + std::size_t(column)];
            const glm::dvec3 there =
                glm::dvec3(info.position(row, column), height) - camera.position;
            const double depth = glm::dot(there, camera.forward());
            if (depth < camera.near_plane ||
                std::abs(glm::dot(there, camera.right())) > tangents.x * depth ||
                std::abs(glm::dot(there, camera.up())) > tangents.y * depth) {
                continue;
            }
            box.first_row = std::min(box.first_row, row);
            box.first_column = std::min(box.first_column, column);
            box.last_row = std::max(box.last_row, row);
            box.last_column = std::max(box.last_column, column);
        }
    }
    return box;
}

TEST(VisibleRegion, holds_all_ground_in_view_hidden_or_not_and_not_a_tile_more) {
    terrain::TerrainSource source;
    source.synthetic = "ridged";
    source.rows = 513;
    source.columns = 700;
    source.spacing_x = source.spacing_y = 10;
    source.origin_x = 1e6;
    source.origin_y = -3e5;
    const auto terrain = terrain::load_terrain(source);
    const TerrainInfo& info = terrain->info();
    const platform::Context context("");
    gl::Device device;
    const test::RoomShaders shaders("tile_quadtree");
    const TileCatalogue catalogue(*terrain);
    common::TileStreamer streamer(*terrain, {});
    streamer.upload(device, "test: tiles");
    TileScene scene(Cracks::snap, 64);
    scene.upload(device, shaders.get(), 256);
    gl::Buffer frozen(device, "test: Frozen", sizeof(gl::Frozen));
    std::vector<TileId> tiles;
    std::vector<DrawnTile> drawn;
    for (int row = 0; row < catalogue.pyramid().rows(0); ++row) {
        for (int column = 0; column < catalogue.pyramid().columns(0); ++column) {
            tiles.push_back({0, row, column});
            drawn.push_back({{0, row, column}, 0, {}, false});
        }
    }
    streamer.load(tiles);
    scene.freeze(drawn, catalogue, streamer);
    int seen = 0;
    for (int i = 0; i < 40; ++i) {
        const glm::dvec2 size = info.extent_max() - info.extent_min();
        Camera camera =
            test::camera_at({info.origin + size * glm::dvec2(0.1 + 0.02 * i, 0.9 - 0.017 * i),
                             info.max_height + 20 + 17 * (i % 7)},
                            37 * i, -60 + (i * 23) % 70, i % 3 == 0 ? 0 : 20, 30 + i);
        camera.viewport = {640, 360};
        const gl::Frozen block = gl::make_frozen(camera, info);
        frozen.write(0, sizeof block, &block);
        frozen.bind_uniform(gl::kFrozenBinding);
        scene.ask_region(streamer);
        const SampleBox region = scene.region(catalogue);
        const SampleBox in_view = samples_in_view(*terrain, camera, 1);
        if (in_view.last_row < 0) continue;
        ++seen;
        // Single samples at a corner of the view may lie between two texels.
        constexpr int kSlack = 4;
        EXPECT_LE(region.first_row, in_view.first_row + kSlack) << "camera " << i;
        EXPECT_LE(region.first_column, in_view.first_column + kSlack) << "camera " << i;
        EXPECT_GE(region.last_row, in_view.last_row - kSlack) << "camera " << i;
        EXPECT_GE(region.last_column, in_view.last_column - kSlack) << "camera " << i;
        constexpr int kMost = kTileCells + kTileCells / 8 + 1;
        const SampleBox wider = samples_in_view(*terrain, camera, 1.2);
        EXPECT_GE(region.first_row, wider.first_row - kMost) << "camera " << i;
        EXPECT_GE(region.first_column, wider.first_column - kMost) << "camera " << i;
        EXPECT_LE(region.last_row, wider.last_row + kMost) << "camera " << i;
        EXPECT_LE(region.last_column, wider.last_column + kMost) << "camera " << i;
    }
    EXPECT_GT(seen, 30) << "too easy to judge by";
    // Nothing but sky.
    const gl::Frozen sky =
        gl::make_frozen(test::camera_at({info.origin, info.max_height + 100}, 0, 80, 0, 40), info);
    frozen.write(0, sizeof sky, &sky);
    scene.ask_region(streamer);
    EXPECT_TRUE(scene.region(catalogue).empty());
    streamer.release();
    EXPECT_TRUE(device.take_errors().empty());
}

}  // namespace
}  // namespace lodbench::tile_quadtree
