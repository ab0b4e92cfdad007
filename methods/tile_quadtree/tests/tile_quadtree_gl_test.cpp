// dltq, sltq-gpu, sltq-cpu and fu as they are drawn: alike where they should be, without cracks,
// and never waiting for a tile.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <set>
#include <thread>

#include "run/frame_measurer.h"
#include "run/mesh_export.h"
#include "support/fake_terrain.h"
#include "support/loose_method.h"
#include "support/mesh_tools.h"
#include "support/method_fixture.h"

namespace lodbench::test {
namespace {

using namespace std::chrono_literals;
using Settings = std::vector<std::pair<std::string, std::string>>;

std::shared_ptr<const terrain::HeightField> ridged(int rows, int columns) {
    terrain::TerrainSource source;
    source.synthetic = "ridged";
    source.rows = rows;
    source.columns = columns;
    source.spacing_x = source.spacing_y = 10;
    return terrain::load_terrain(source);
}

/// From a corner towards the middle, so that tiles grow coarser northward and eastward with
/// headings up to 90 degrees, southward and westward with those of 180 to 270.
Camera low_camera(const TerrainInfo& info, double heading = 40) {
    const double share = heading < 180 ? 0.2 : 0.8;
    Camera camera = camera_at(
        {info.origin + share * (info.extent_max() - info.extent_min()), info.max_height + 50},
        heading, -12);
    camera.viewport = {320, 240};
    return camera;
}

constexpr const char* kMethods[] = {"dltq", "sltq-gpu", "sltq-cpu", "fu"};

class TileMethods : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(all, TileMethods, testing::ValuesIn(kMethods), [](const auto& chosen) {
    std::string name = chosen.param;
    std::ranges::replace(name, '-', '_');
    return name;
});

/// Error and crack pixels of one frame.
results::FrameRecord measured(Flight& flight, const Camera& camera,
                              const std::shared_ptr<const terrain::HeightField>& terrain) {
    run::Stage& stage = flight.stage();
    stage.resize(camera.viewport);
    stage.select(camera, {});
    stage.settle();
    run::FrameMeasurer measurer(stage, 4.0, terrain);
    results::FrameRecord record;
    record.triangles = stage.count_primitives();
    measurer.take(0, record, nullptr);
    measurer.measure(record);
    return record;
}

TEST_P(TileMethods, snapping_leaves_no_crack_pixel_skirts_hide_them_and_none_leaves_some) {
    const std::string method = GetParam();
    const auto terrain = ridged(1025, 1025);
    std::uint64_t cracks[3] = {}, skirts[3] = {};
    const char* kinds[3] = {"snap", "skirt", "none"};
    for (int kind = 0; kind < 3; ++kind) {
        Settings settings = {{"tau", "6"}, {"cracks", kinds[kind]}};
        Flight flight(terrain, "tile_quadtree", method, settings);
        for (const double heading : {50.0, 220.0}) {
            const results::FrameRecord record =
                measured(flight, low_camera(terrain->info(), heading), terrain);
            cracks[kind] += record.crack_pixels.value();
            skirts[kind] += record.skirt_pixels.value();
            EXPECT_EQ(record.uncovered_samples, 0U);
            EXPECT_GT(record.screen_max_px, 0.5) << "too good to judge by";
        }
    }
    EXPECT_EQ(cracks[0], 0U);
    EXPECT_EQ(skirts[0], 0U);
    EXPECT_EQ(cracks[1], 0U);
    EXPECT_GT(skirts[1], 0U);
    EXPECT_GT(cracks[2], 0U);
}

TEST(TileMethodsThatShareAMetric, send_the_same_triangles_and_the_cpus_shows_the_same_picture) {
    const auto terrain = ridged(700, 1025);
    struct Drawn {
        std::vector<glm::vec3> vertices;
        std::vector<float> depth;
    };
    const auto drawn = [&](const char* method, const Settings& settings, double heading) {
        Flight flight(terrain, "tile_quadtree", method, settings);
        flight.select(low_camera(terrain->info(), heading));
        flight.stage().settle();
        flight.stage().draw_picture();
        return Drawn{flight.stage().capture().vertices, flight.stage().read_depth()};
    };
    for (const char* shared : {"none", "triangle", "range"}) {
        for (const double heading : {40.0, 200.0}) {
            Settings settings = {{"tau", "20"}, {"shared_height", shared}};
            const Drawn cpu = drawn("sltq-cpu", settings, heading);
            const Drawn one_tree = drawn("sltq-gpu", settings, heading);
            const Drawn two_layers = drawn("dltq", settings, heading);
            settings.emplace_back("evaluate", "compute");
            settings.emplace_back("prune", "true");
            settings.emplace_back("upper_levels", "2");
            if (std::string(shared) != "range") settings.emplace_back("errors", "gpu");
            const Drawn otherwise = drawn("dltq", settings, heading);
            EXPECT_GT(one_tree.vertices.size(), 1000U);
            EXPECT_TRUE(one_tree.vertices == two_layers.vertices);
            EXPECT_TRUE(one_tree.vertices == otherwise.vertices);
            // The CPU knows no region, so out of view it refines, and then leaves out, other tiles.
            std::size_t pixels = 0;
            for (std::size_t i = 0; i < cpu.depth.size(); ++i) {
                pixels += cpu.depth[i] != one_tree.depth[i];
            }
            EXPECT_EQ(pixels, 0U) << "heading " << heading << ", shared height " << shared;
        }
    }
}

TEST(SltqCpu, judges_all_tiles_in_view_and_by_its_shortcut_fewer_for_the_same_triangles) {
    const auto terrain = ridged(1025, 1025);
    std::vector<glm::vec3> vertices[2];
    double judged[2] = {}, tested[2] = {};
    for (const int shortcut : {0, 1}) {
        Flight flight(terrain, "tile_quadtree", "sltq-cpu",
                      {{"tau", "20"}, {"shortcut", shortcut == 0 ? "false" : "true"}});
        flight.select(low_camera(terrain->info()));
        flight.stage().settle();
        vertices[shortcut] = flight.stage().capture().vertices;
        judged[shortcut] = flight.counter("tiles_judged");
        tested[shortcut] = flight.counter("tiles_tested");
    }
    EXPECT_GT(vertices[0].size(), 1000U);
    EXPECT_TRUE(vertices[0] == vertices[1]);
    EXPECT_LT(judged[1], judged[0]);
    EXPECT_LT(judged[0], tested[0]) << "children of a visible tile may be out of view";
    EXPECT_GT(judged[0], 90) << "full resolution is judged wherever it is in view";
}

TEST(ErrorsOnTheGpu, are_used_where_children_are_resident_and_draw_the_same) {
    const auto terrain = ridged(1025, 1025);
    for (const char* method : {"dltq", "sltq-gpu"}) {
        std::vector<glm::vec3> vertices[2];
        for (const int gpu : {0, 1}) {
            Flight flight(terrain, "tile_quadtree", method,
                          {{"tau", "20"}, {"errors", gpu == 0 ? "summaries" : "gpu"}});
            flight.select(low_camera(terrain->info()));
            flight.stage().settle();
            vertices[gpu] = flight.stage().capture().vertices;
            EXPECT_EQ(flight.counter("errors_from_heights") > 0, gpu == 1);
            EXPECT_EQ(flight.counter("errors_computed_so_far") > 0, gpu == 1);
        }
        EXPECT_GT(vertices[0].size(), 1000U);
        EXPECT_TRUE(vertices[0] == vertices[1]) << method;
    }
}

TEST(ErrorsOnTheGpu, are_refused_with_a_height_range_which_resident_heights_do_not_give) {
    try {
        Flight flight(ridged(65, 65), "tile_quadtree", "dltq",
                      {{"shared_height", "range"}, {"errors", "gpu"}});
        FAIL() << "not refused";
    } catch (const std::exception& error) {
        EXPECT_NE(std::string(error.what()).find("choose shared_height = \"none\""),
                  std::string::npos)
            << error.what();
    }
}

TEST_P(TileMethods, frames_that_settle_do_not_depend_on_what_was_drawn_before) {
    const auto terrain = ridged(513, 513);
    const Settings settings = {{"tau", "10"}, {"pool_tiles", "40"}};
    const Camera wanted = low_camera(terrain->info());
    const auto fresh = [&] {
        Flight flight(terrain, "tile_quadtree", GetParam(), settings);
        flight.select(wanted);
        flight.stage().settle();
        return flight.stage().capture().vertices;
    }();
    Flight used(terrain, "tile_quadtree", GetParam(), settings);
    for (int i = 0; i < 12; ++i) {
        used.select(low_camera(terrain->info(), 30.0 * i));
        used.stage().draw_picture();
        if (i > 5) used.stage().settle();
    }
    used.select(wanted);
    used.stage().settle();
    EXPECT_TRUE(fresh == used.stage().capture().vertices);
}

class WhileTilesAreMissing : public MeshTest, public testing::WithParamInterface<const char*> {};

INSTANTIATE_TEST_SUITE_P(all, WhileTilesAreMissing, testing::Values("dltq", "sltq-cpu", "fu"),
                         [](const auto& chosen) {
                             std::string name = chosen.param;
                             std::ranges::replace(name, '-', '_');
                             return name;
                         });

TEST_P(WhileTilesAreMissing, what_stands_in_for_them_is_watertight_and_covers_the_terrain) {
    if (!has_numpy()) GTEST_SKIP() << "no numpy";
    const auto terrain = ridged(700, 513);
    Settings settings = {{"tau", "4"},
                         {"culling", "false"},
                         {"uploads_per_frame", "3"},
                         {"prefetch", "0"},
                         {"loader_threads", "1"}};
    Flight flight(terrain, "tile_quadtree", GetParam(), settings);
    int frames_with_gaps = 0, checked = 0;
    double most_drawn = 0;
    for (int frame = 0; frame < 60; ++frame) {
        // Half way the view turns round.
        const Camera camera = low_camera(terrain->info(), frame < 30 ? 40 : 220);
        flight.select(camera);
        std::this_thread::sleep_for(1ms);
        const bool gaps = flight.counter("ancestors_drawn") > 0;
        frames_with_gaps += gaps;
        most_drawn = std::max(most_drawn, flight.counter("tiles_drawn"));
        if (!gaps || checked > 12) continue;
        ++checked;
        run::MeshContext context;
        context.method = GetParam();
        context.terrain = terrain->info();
        context.camera = camera;
        context.clipped = false;
        write_bytes(file("m.ply"), run::ply(run::weld(flight.stage().capture()), context));
        const Outcome outcome = check_mesh(file("m.ply") + " --watertight --covers-terrain");
        EXPECT_EQ(outcome.status, 0) << "frame " << frame << ": " << outcome.output;
    }
    EXPECT_GT(frames_with_gaps, 3) << "too easy to judge by";
    EXPECT_GT(most_drawn, 15) << "too easy to judge by";
    EXPECT_EQ(flight.counter("tiles_missing"), 0) << "by then all have come";
    EXPECT_EQ(flight.counter("ancestors_drawn"), 0);
}

class Loose : public LooseMethod {
public:
    Loose(const Terrain& terrain, const std::string& method, const Settings& settings)
        : LooseMethod(terrain, "tile_quadtree", method, settings) {}
};

/// Rough everywhere, so that all in view is wanted at full resolution.
TileSummary rough(const TileId& tile) {
    return {-50, 50, tile.level == 0 ? 0.0F : 30.0F};
}

TEST_P(TileMethods, a_slow_disk_never_stalls_a_frame_and_ancestors_stand_in) {
    FakeTerrain terrain(2049, 2049, rough);
    std::atomic<bool> slow = false;
    terrain.before_read = [&](const TileId&) {
        if (slow) std::this_thread::sleep_for(600ms);
    };
    Loose loose(terrain, GetParam(), {{"loader_threads", "1"}});
    slow = true;
    const Camera camera = low_camera(terrain.info());
    double longest = 0;
    for (int frame = 0; frame < 5; ++frame) longest = std::max(longest, loose.select(camera));
    EXPECT_LT(longest, 0.4) << "a tile takes 0.6 s";
    EXPECT_GT(loose.counter("tiles_missing"), 10);
    EXPECT_GE(loose.counter("ancestors_drawn"), 1);
    EXPECT_GE(loose.counter("tiles_drawn"), 1);
    slow = false;
    for (int frame = 0; frame < 4000 && loose.counter("tiles_missing") > 0; ++frame) {
        loose.select(camera);
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_EQ(loose.counter("tiles_missing"), 0);
    EXPECT_EQ(loose.counter("ancestors_drawn"), 0);
    EXPECT_LE(loose.counter("tiles_resident"), 256);
    slow = true;  // released while tiles are being read
    loose.select(low_camera(terrain.info(), 220));
}

TEST_P(TileMethods, a_tile_that_cannot_be_read_ends_the_frame_with_the_terrains_words) {
    FakeTerrain terrain(1025, 1025, rough);
    terrain.before_read = [](const TileId& tile) {
        if (tile.level == 0) {
            throw EnvironmentError(
                fmt::format("moon.tiles: tile (level 0, row {}, column {}): "
                            "checksum 1, expected 2",
                            tile.row, tile.column));
        }
    };
    const Camera camera = low_camera(terrain.info());
    const auto expect_words = [](const auto& call) {
        try {
            call();
            FAIL() << "no error";
        } catch (const EnvironmentError& error) {
            EXPECT_NE(std::string(error.what()).find("moon.tiles: tile (level 0, row "),
                      std::string::npos);
        }
    };
    {
        Loose loose(terrain, GetParam(), {});
        expect_words([&] {
            for (int frame = 0; frame < 2000; ++frame) {
                loose.select(camera);
                std::this_thread::sleep_for(1ms);
            }
        });
    }
    Loose loose(terrain, GetParam(), {});
    loose.select(camera);
    expect_words([&] { loose.method().settle(); });
}

/// {level, row, column}
using Tile = std::array<int, 3>;

/// The tiles of a surface that is drawn from complete ones, found in what was sent to the
/// rasteriser: so many triangles a tile, whose corners stay where they are.
std::set<Tile> tiles_of(const measure::CapturedSurface& surface, const TerrainInfo& info) {
    constexpr std::size_t kTileVertices = std::size_t{6} * kTileCells * kTileCells;
    EXPECT_EQ(surface.vertices.size() % kTileVertices, 0U);
    std::set<Tile> tiles;
    for (std::size_t first = 0; first < surface.vertices.size(); first += kTileVertices) {
        glm::dvec2 low(1e9), high(-1e9);
        for (std::size_t i = first; i < first + kTileVertices; ++i) {
            const glm::dvec2 place = glm::dvec2(surface.world(i)) - info.origin;
            low = glm::min(low, place);
            high = glm::max(high, place);
        }
        const int cells = int(std::lround((high.x - low.x) / info.spacing.x));
        const int row = info.rows - 1 - int(std::lround(high.y / info.spacing.y));
        const int column = int(std::lround(low.x / info.spacing.x));
        EXPECT_EQ(row % cells, 0);
        EXPECT_EQ(column % cells, 0);
        const int level = std::countr_zero(unsigned(cells / kTileCells));
        EXPECT_TRUE(tiles.insert({level, row / cells, column / cells}).second);
    }
    return tiles;
}

/// What the cameras need, from what is drawn where nothing is missing: in lockstep, by a method of
/// its own.
std::set<Tile> tiles_needed(const std::string& method, const Settings& settings,
                            const std::vector<Camera>& cameras) {
    Flight flight(std::make_shared<FakeTerrain>(4097, 4097, rough), "tile_quadtree", method,
                  settings);
    std::set<Tile> needed;
    for (const Camera& camera : cameras) {
        flight.select(camera);
        flight.stage().settle();
        needed.merge(tiles_of(flight.stage().capture(), flight.stage().terrain().info()));
    }
    return needed;
}

/// Eastward, `step` metres a frame.
std::vector<Camera> eastward(int frames, double step) {
    std::vector<Camera> cameras;
    for (int frame = 0; frame < frames; ++frame) {
        cameras.push_back(camera_at({4000 + step * frame, 8000, 150}, 90, -12));
        cameras.back().viewport = {320, 240};
    }
    return cameras;
}

TEST_P(TileMethods, read_what_the_views_need_and_little_else) {
    // A tenth of the terrain is flown over, with time enough for every tile to come.
    FakeTerrain terrain(4097, 4097, rough);
    const Settings settings = {{"tau", "60"}};
    const std::vector<Camera> cameras = eastward(200, 60);
    const std::set<Tile> needed = tiles_needed(GetParam(), settings, cameras);
    Loose loose(terrain, GetParam(), settings);
    for (const Camera& camera : cameras) {
        loose.select(camera);
        std::this_thread::sleep_for(1ms);
    }
    const std::vector<TileId> read = terrain.read_so_far();
    fmt::print("  {}: {} tiles needed, by its own count {}, {} read, {} prefetched\n", GetParam(),
               needed.size(), loose.counter("tiles_needed_so_far"), read.size(),
               loose.counter("tiles_prefetched_so_far"));
    EXPECT_GT(needed.size(), 50U) << "too easy to judge by";
    EXPECT_LE(double(read.size()), 1.5 * double(needed.size()));
    EXPECT_NEAR(loose.counter("tiles_needed_so_far"), needed.size(), 0.1 * double(needed.size()));
    // Nothing behind the camera's start.
    for (const TileId& tile : read) {
        EXPECT_GT((tile.column + 1) * (kTileCells << tile.level) * 10, 3900);
    }
}

TEST_P(TileMethods, a_tight_pool_reads_no_tile_in_vain_while_the_camera_moves) {
    FakeTerrain terrain(4097, 4097, rough);
    // The leaves alone take nearly every slot.
    const Settings settings = {{"tau", "8"}, {"pool_tiles", "32"}, {"prefetch", "30"}};
    const std::vector<Camera> cameras = eastward(150, 40);
    const std::set<Tile> needed = tiles_needed(GetParam(), settings, cameras);
    Loose loose(terrain, GetParam(), settings);
    for (const Camera& camera : cameras) {
        loose.select(camera);
        std::this_thread::sleep_for(1ms);
    }
    // What is asked for of late may have no slot any more when it comes.
    EXPECT_LE(loose.counter("tiles_dropped_so_far"), 8);
    fmt::print("  {}: {} tiles needed, by its own count {}, {} read\n", GetParam(), needed.size(),
               loose.counter("tiles_needed_so_far"), terrain.tiles_served());
    EXPECT_LE(double(terrain.tiles_served()), 1.5 * double(needed.size()));
    EXPECT_NEAR(loose.counter("tiles_needed_so_far"), needed.size(), 0.1 * double(needed.size()));
}

TEST_P(TileMethods, the_smallest_pool_draws_from_a_corner_too) {
    FakeTerrain terrain(1025, 1025, rough);
    Loose loose(terrain, GetParam(), {{"tau", "0.1"}, {"pool_tiles", "2"}});
    Camera camera = low_camera(terrain.info(), 45);
    camera.position = {100, 100, 120};  // a corner, where one child of the root is in view
    for (int frame = 0; frame < 20; ++frame) loose.select(camera);
    EXPECT_GE(loose.counter("tiles_drawn"), 1);
    EXPECT_LE(loose.counter("tiles_resident"), 2);
}

TEST_P(TileMethods, a_pool_that_is_too_small_is_filled_with_the_most_urgent_tiles) {
    FakeTerrain terrain(4097, 4097, rough);
    Loose loose(terrain, GetParam(), {{"pool_tiles", "20"}, {"tau", "0.1"}});
    const Camera camera = low_camera(terrain.info());
    for (int frame = 0; frame < 100; ++frame) {
        loose.select(camera);
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_GT(loose.counter("splits_refused"), 0);
    EXPECT_LE(loose.counter("tiles_drawn"), 19);
    EXPECT_GE(loose.counter("tiles_drawn"), 16);
    EXPECT_LE(loose.counter("tiles_resident"), 20);
    EXPECT_EQ(loose.counter("tiles_missing"), 0) << "it does not read in circles";
    const std::uint64_t read = terrain.tiles_served();
    for (int frame = 0; frame < 20; ++frame) loose.select(camera);
    EXPECT_EQ(terrain.tiles_served(), read);
}

}  // namespace
}  // namespace lodbench::test
