// The GPU decides as the CPU does, tile by tile.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "gl/frame_blocks.h"
#include "support/context_for_test.h"
#include "support/fake_terrain.h"
#include "support/room_shaders.h"
#include "terrain/height_field.h"
#include "tile_quadtree/tile_decisions.h"
#include "tile_quadtree/visible_tiles.h"

namespace lodbench::tile_quadtree {
namespace {

std::shared_ptr<const terrain::HeightField> puget() {
    terrain::TerrainSource source;
    source.file = LODBENCH_SOURCE_DIR "/scenarios/terrain/puget_sound_1025_160m.png";
    return terrain::load_terrain(source);
}
std::shared_ptr<const terrain::HeightField> ridged() {
    terrain::TerrainSource source;
    source.synthetic = "ridged";
    source.rows = 700;
    source.columns = 513;
    source.origin_x = 4.5e6;
    source.origin_y = -2e6;
    return terrain::load_terrain(source);
}

/// Cameras in, over, beside and far from the terrain; the tolerance is such that the tiles' reaches
/// end among them.
Camera random_camera(const TerrainInfo& info, std::mt19937& random) {
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    const double height = info.max_height - info.min_height;
    Camera camera;
    camera.viewport = {1280, 720};
    camera.vertical_fov = between(0.3, 1.6);
    camera.position = {info.origin + size * glm::dvec2(between(-0.5, 1.5), between(-0.5, 1.5)),
                       info.min_height + height * between(-0.5, 1.5)};
    if (random() % 4 == 0) camera.position.z += between(0, size.x);
    return camera;
}

struct Metric {
    const char* name;
    MetricOptions options;
};
constexpr Metric kMetrics[] = {{"none", {}},
                               {"triangle", {.shared = SharedHeight::triangle}},
                               {"range", {.shared = SharedHeight::range}},
                               {"fu", fu_metric(SharedHeight::none)}};

/// As TileDecisions takes them.
std::vector<glm::vec4> packed(const TileMetric& metric, const std::vector<TileId>& tiles) {
    std::vector<glm::vec4> summaries;
    for (const TileId& tile : tiles) summaries.push_back(metric.packed(tile));
    return summaries;
}
std::vector<TileId> all_tiles(const TileCatalogue& catalogue) {
    std::vector<TileId> tiles;
    for_each_tile(catalogue.pyramid(), [&](const TileId& tile) { tiles.push_back(tile); });
    return tiles;
}

class Decisions : public testing::TestWithParam<std::tuple<const char*, Metric, const char*>> {};

TEST_P(Decisions, of_the_gpu_are_the_cpus_but_within_rounding_of_the_threshold) {
    const auto& [name, chosen, evaluate] = GetParam();
    constexpr int kCameras = 200;
    const auto terrain = std::string(name) == "puget" ? puget() : ridged();
    const platform::Context context("");
    gl::Device device;
    const test::RoomShaders shaders("tile_quadtree");
    const TileCatalogue catalogue(*terrain);
    const TileMetric metric(*terrain, catalogue, chosen.options);
    const std::vector<TileId> tiles = all_tiles(catalogue);
    gl::Buffer frozen(device, "test: Frozen", sizeof(gl::Frozen));
    TileDecisions decisions;
    decisions.upload(device, shaders.get(), chosen.options, std::string(evaluate) == "compute",
                     false);
    std::mt19937 random(7);
    std::size_t split = 0, kept = 0, differing = 0;
    for (int i = 0; i < kCameras; ++i) {
        const Camera camera = random_camera(terrain->info(), random);
        const double tau = std::pow(10, std::uniform_real_distribution(-1.0, 2.5)(random));
        const double scale = camera.lambda() / tau;
        const gl::Frozen block = gl::make_frozen(camera, terrain->info());
        frozen.write(0, sizeof block, &block);
        frozen.bind_uniform(gl::kFrozenBinding);
        decisions.ask(scale, tiles, packed(metric, tiles));
        const auto [asked, splits] = decisions.answers();
        ASSERT_EQ(asked, tiles);
        ASSERT_EQ(splits.size(), tiles.size());
        for (std::size_t t = 0; t < tiles.size(); ++t) {
            const bool by_cpu = metric.splits(tiles[t], camera.position, scale);
            ++(by_cpu ? split : kept);
            if (by_cpu == (splits[t] != 0)) continue;
            ++differing;
            const Judgement judgement = metric.judge(tiles[t], camera.position, scale);
            // The GPU subtracts floats of the size of the tile's farthest coordinate, a few
            // roundings of 2^-24 each, and so does the reach of its factors. Heights have an ulp of
            // their own.
            const common::Box box = catalogue.box(tiles[t]);
            const double size = judgement.reach + glm::length(box.low - camera.position) +
                                glm::length(box.high - camera.position) +
                                double(glm::length(metric.packed(tiles[t])));
            EXPECT_LE(std::abs(judgement.reach - judgement.distance), 8 * 0x1p-24 * size)
                << "level " << tiles[t].level << ", row " << tiles[t].row << ", column "
                << tiles[t].column << ", camera " << i;
            fmt::print(
                "  camera {}, tile (level {}, row {}, column {}): reach {:.9g} m, distance {:.9g} "
                "m; "
                "the CPU {} it, the GPU does otherwise\n",
                i, tiles[t].level, tiles[t].row, tiles[t].column, judgement.reach,
                judgement.distance, by_cpu ? "splits" : "keeps");
        }
    }
    fmt::print("  {} {}: {} decisions to split, {} to keep, {} differ\n", name, evaluate, split,
               kept, differing);
    EXPECT_GT(split, 3000U) << "too easy to judge by";
    EXPECT_GT(kept, 3000U) << "too easy to judge by";
    EXPECT_LT(differing, 10U);
    EXPECT_TRUE(device.take_errors().empty());
}

std::string name_of(
    const testing::TestParamInfo<std::tuple<const char*, Metric, const char*>>& chosen) {
    return fmt::format("{}_{}_{}", std::get<0>(chosen.param), std::get<1>(chosen.param).name,
                       std::get<2>(chosen.param));
}

INSTANTIATE_TEST_SUITE_P(all, Decisions,
                         testing::Combine(testing::Values("puget", "ridged"),
                                          testing::ValuesIn(kMetrics),
                                          testing::Values("fragment", "compute")),
                         name_of);

TEST(TileTexture, of_more_tiles_than_a_row_of_texels_has_gives_each_its_own_decision) {
    const test::FakeTerrain terrain(4097, 8193, [](const TileId& tile) {
        return tile.column % 2 == 0 ? TileSummary{0, 10, 10} : TileSummary{0, 0, 0};
    });
    const platform::Context context("");
    gl::Device device;
    const test::RoomShaders shaders("tile_quadtree");
    const TileCatalogue catalogue(terrain);
    const std::vector<TileId> tiles = all_tiles(catalogue);
    ASSERT_GT(tiles.size(), 2U * TileDecisions::kRow) << "three rows";
    gl::Buffer frozen(device, "test: Frozen", sizeof(gl::Frozen));
    Camera camera;
    camera.position = {1000, 1000, 500};
    const gl::Frozen block = gl::make_frozen(camera, terrain.info());
    frozen.write(0, sizeof block, &block);
    frozen.bind_uniform(gl::kFrozenBinding);
    const TileMetric metric(terrain, catalogue, {});
    for (const bool by_compute : {false, true}) {
        TileDecisions decisions;
        decisions.upload(device, shaders.get(), metric.options(), by_compute, false);
        const std::uint64_t before = device.uploaded_bytes();
        decisions.ask(1e9, tiles, packed(metric, tiles));
        EXPECT_EQ(device.uploaded_bytes() - before, 2 * sizeof(glm::vec4) * tiles.size())
            << "what is used, not whole rows";
        EXPECT_TRUE(decisions.pending());
        const auto [asked, splits] = decisions.answers();
        EXPECT_FALSE(decisions.pending());
        ASSERT_EQ(splits.size(), tiles.size());
        std::size_t wrong = 0;
        for (std::size_t t = 0; t < tiles.size(); ++t) {
            wrong += (splits[t] != 0) != (tiles[t].level > 0 && tiles[t].column % 2 == 0);
        }
        EXPECT_EQ(wrong, 0U);
        decisions.ask(1, {}, {});
        EXPECT_FALSE(decisions.pending());
        EXPECT_TRUE(decisions.answers().second.empty());
    }
}

}  // namespace
}  // namespace lodbench::tile_quadtree
