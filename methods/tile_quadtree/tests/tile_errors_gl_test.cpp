// Errors on the GPU, from the heights of tiles that are resident, are the CPU's to the bit.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "gl/frame_blocks.h"
#include "support/context_for_test.h"
#include "support/fake_terrain.h"
#include "support/room_shaders.h"
#include "terrain/height_field.h"
#include "tile_quadtree/resident_errors.h"
#include "tile_quadtree/tile_decisions.h"

namespace lodbench::tile_quadtree {
namespace {

std::shared_ptr<const terrain::HeightField> puget() {
    terrain::TerrainSource source;
    source.file = LODBENCH_SOURCE_DIR "/scenarios/terrain/puget_sound_1025_160m.png";
    source.vertical_scale = 0.1;
    return terrain::load_terrain(source);
}
/// Most of its tiles at the southern and eastern edge are padded, some children do not exist.
std::shared_ptr<const terrain::HeightField> ridged() {
    terrain::TerrainSource source;
    source.synthetic = "ridged";
    source.rows = 700;
    source.columns = 513;
    return terrain::load_terrain(source);
}

/// All tiles of a terrain in a pool.
class Pool {
public:
    explicit Pool(const Terrain& terrain)
        : catalogue(terrain),
          shaders("tile_quadtree"),
          streamer(terrain, {.slots = int(catalogue.pyramid().count()) + 1}) {
        streamer.upload(device, "test: heights");
        errors.upload(device, shaders.get(), streamer.slots());
        for_each_tile(catalogue.pyramid(), [&](const TileId& tile) { tiles.push_back(tile); });
    }
    ~Pool() { streamer.release(); }
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;

    /// Per slot.
    [[nodiscard]] std::vector<ErrorShare> shares() const {
        static_assert(sizeof(ErrorShare) == 2 * sizeof(float));
        std::vector<ErrorShare> found(std::size_t(streamer.slots()));
        glGetTextureImage(errors.shares().name(), 0, GL_RG, GL_FLOAT,
                          GLsizei(found.size() * sizeof(ErrorShare)), found.data());
        return found;
    }

    platform::Context context{""};
    gl::Device device;
    TileCatalogue catalogue;
    test::RoomShaders shaders;
    common::TileStreamer streamer;
    ResidentErrors errors;
    std::vector<TileId> tiles;
};

class Errors : public testing::TestWithParam<const char*> {
protected:
    [[nodiscard]] static std::shared_ptr<const terrain::HeightField> terrain() {
        return std::string(GetParam()) == "puget" ? puget() : ridged();
    }
};
INSTANTIATE_TEST_SUITE_P(on_the_gpu, Errors, testing::Values("puget", "ridged"),
                         [](const auto& chosen) { return std::string(chosen.param); });

TEST_P(Errors, and_reliefs_of_every_tile_are_the_cpus_to_the_bit) {
    const auto terrain = Errors::terrain();
    Pool pool(*terrain);
    pool.streamer.load(pool.tiles);
    const std::vector<float> reliefs = triangle_reliefs(*terrain);
    std::vector<std::pair<TileId, ChildSlots>> asked;
    for (const TileId& tile : pool.tiles) {
        const auto children = pool.errors.children(pool.catalogue, pool.streamer, tile);
        ASSERT_EQ(children.has_value(), tile.level > 0);
        if (children) asked.emplace_back(tile, *children);
    }
    pool.errors.compute(pool.streamer);
    EXPECT_EQ(pool.errors.computed_count(), pool.tiles.size() - 1) << "each once, but the root";
    const std::vector<ErrorShare> shares = pool.shares();
    int rough = 0;
    for (const auto& [tile, children] : asked) {
        ErrorShare greatest;
        for (const int slot : children.slots) {
            if (slot == ChildSlots::kNone) continue;
            greatest.error = std::max(greatest.error, shares[std::size_t(slot)].error);
            greatest.relief = std::max(greatest.relief, shares[std::size_t(slot)].relief);
        }
        const std::string where =
            fmt::format("level {}, row {}, column {}", tile.level, tile.row, tile.column);
        EXPECT_EQ(greatest.error, pool.catalogue.summary(tile).midpoint_error) << where;
        EXPECT_EQ(greatest.relief, reliefs[pool.catalogue.index(tile)]) << where;
        rough += greatest.error > 1;
    }
    EXPECT_GT(rough, 20) << "too easy to judge by";
    EXPECT_TRUE(pool.device.take_errors().empty());
}

TEST_P(Errors, that_are_known_are_not_computed_again_and_a_slots_next_tile_is) {
    const auto terrain = Errors::terrain();
    Pool pool(*terrain);
    const TileId parent{1, 0, 0}, next{1, 1, 1};
    const auto load_children = [&](const TileId& tile) {
        std::vector<TileId> children;
        pool.catalogue.for_each_child(tile,
                                      [&](const TileId& child) { children.push_back(child); });
        pool.streamer.load(children);
    };
    const auto error = [&](const TileId& tile) {
        const auto children = pool.errors.children(pool.catalogue, pool.streamer, tile);
        pool.errors.compute(pool.streamer);
        float greatest = -1;
        for (const int slot : children.value().slots) {
            greatest = std::max(greatest, pool.shares()[std::size_t(slot)].error);
        }
        return greatest;
    };
    EXPECT_FALSE(pool.errors.children(pool.catalogue, pool.streamer, parent).has_value());
    load_children(parent);
    EXPECT_EQ(error(parent), pool.catalogue.summary(parent).midpoint_error);
    EXPECT_EQ(error(parent), pool.catalogue.summary(parent).midpoint_error);
    EXPECT_EQ(pool.errors.computed_count(), 4U);
    pool.streamer.forget();
    EXPECT_FALSE(pool.errors.children(pool.catalogue, pool.streamer, parent).has_value());
    load_children(next);  // into the same slots
    EXPECT_EQ(error(next), pool.catalogue.summary(next).midpoint_error);
    EXPECT_EQ(pool.errors.computed_count(), 8U);
    EXPECT_NE(pool.catalogue.summary(next).midpoint_error,
              pool.catalogue.summary(parent).midpoint_error);
}

TEST_P(Errors, from_resident_heights_decide_as_the_summaries_do) {
    const auto terrain = Errors::terrain();
    Pool pool(*terrain);
    // Some tiles lack a child, and are decided on by their summaries.
    std::vector<TileId> resident;
    for (const TileId& tile : pool.tiles) {
        if ((tile.row + 2 * tile.column) % 7 != 3) resident.push_back(tile);
    }
    pool.streamer.load(resident);
    gl::Buffer frozen(pool.device, "test: Frozen", sizeof(gl::Frozen));
    Camera camera;
    const TerrainInfo& info = terrain->info();
    camera.position = {0.5 * (info.extent_min() + info.extent_max()), info.max_height + 100};
    const gl::Frozen block = gl::make_frozen(camera, info);
    frozen.write(0, sizeof block, &block);
    frozen.bind_uniform(gl::kFrozenBinding);
    for (const SharedHeight shared : {SharedHeight::none, SharedHeight::triangle}) {
        const TileMetric metric(*terrain, pool.catalogue, {.shared = shared});
        std::vector<glm::vec4> summaries, from_heights;
        int replaced = 0;
        for (const TileId& tile : pool.tiles) {
            summaries.push_back(metric.packed(tile));
            from_heights.push_back(metric.packed(tile));
            const auto children = pool.errors.children(pool.catalogue, pool.streamer, tile);
            if (!children) continue;
            // No trace of the summary's own error.
            if (shared == SharedHeight::triangle) from_heights.back().y = -1;
            from_heights.back().z = children->packed()[0];
            from_heights.back().w = children->packed()[1];
            ++replaced;
        }
        pool.errors.compute(pool.streamer);
        EXPECT_GT(replaced, 10);
        for (const bool by_compute : {false, true}) {
            TileDecisions decisions;
            decisions.upload(pool.device, pool.shaders.get(), metric.options(), by_compute, true);
            int split = 0;
            for (const double scale : {10.0, 100.0, 1000.0}) {
                pool.errors.shares().bind(3);
                decisions.ask(scale, pool.tiles, summaries);
                const auto expected = decisions.answers().second;
                decisions.ask(scale, pool.tiles, from_heights);
                EXPECT_EQ(decisions.answers().second, expected);
                split += int(std::ranges::count(expected, 1));
            }
            EXPECT_GT(split, 30) << "too easy to judge by";
        }
    }
    EXPECT_TRUE(pool.device.take_errors().empty());
}

TEST(ChildSlots, survive_two_floats) {
    for (const ChildSlots& children :
         {ChildSlots{}, ChildSlots{{0, 0, 0, 0}}, ChildSlots{{2047, 0, 4095, 4095}}}) {
        const auto [first, second] = children.packed();
        EXPECT_NE(second, 0) << "0 says that there are none";
        EXPECT_EQ(int(first), children.slots[0] * 4096 + children.slots[1]);
        EXPECT_EQ(int(second) - 1, children.slots[2] * 4096 + children.slots[3]);
    }
}

}  // namespace
}  // namespace lodbench::tile_quadtree
