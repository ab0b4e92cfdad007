// clipmap as it is drawn: the paper's triangles, no cracks, textures that equal the entire update,
// the same out of core, and never waiting for a tile.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <ostream>
#include <random>
#include <string>
#include <thread>

#include "measure/drawn_surface.h"
#include "run/frame_measurer.h"
#include "run/mesh_export.h"
#include "support/fake_terrain.h"
#include "support/loose_method.h"
#include "support/mesh_tools.h"
#include "support/method_fixture.h"
#include "terrain/tile_store.h"
#include "terrain/tile_store_writer.h"

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

/// Over a share of the terrain, `above` metres over its highest sample.
Camera camera_over(const TerrainInfo& info, glm::dvec2 share, double above, double heading,
                   double pitch) {
    Camera camera = camera_at({info.origin + share * (info.extent_max() - info.extent_min()),
                               double(info.max_height) + above},
                              heading, pitch);
    camera.viewport = {320, 240};
    return camera;
}

measure::CapturedSurface settled_surface(Flight& flight, const Camera& camera) {
    flight.select(camera);
    flight.stage().settle();
    return flight.stage().capture();
}

TEST(ClipmapTriangles, are_the_papers_without_culling_and_fewer_with_it) {
    struct Case {
        int samples;
        std::uint64_t levels, triangles;
    };
    // The fewest samples that take so many levels.
    for (const Case& known : {Case{127, 1, 129'032}, Case{254, 3, 322'580}, Case{4034, 7, 709'676},
                              Case{64514, 11, 1'096'772}}) {
        const int samples = known.samples;
        const auto terrain = std::make_shared<FakeTerrain>(samples, samples);
        for (const bool culling : {false, true}) {
            Flight flight(terrain, "clipmap", "clipmap",
                          {{"filter", "none"}, {"culling", culling ? "true" : "false"}});
            Camera camera = camera_at({5.0 * samples, 5.0 * samples, 100}, 30, -5);
            flight.select(camera);
            flight.stage().settle();
            EXPECT_EQ(flight.counter("levels_active"), double(known.levels));
            const std::uint64_t drawn = flight.stage().count_primitives();
            if (culling) {
                EXPECT_LT(drawn, known.triangles / 2);
                EXPECT_GT(drawn, known.triangles / 20);
            } else {
                EXPECT_EQ(drawn, known.triangles);
            }
        }
    }
}

TEST(ClipmapTriangles, have_no_area_where_a_closed_border_leaves_out_every_second_vertex) {
    const auto terrain = ridged(254, 254);
    for (const char* borders : {"closed", "open"}) {
        Flight flight(terrain, "clipmap", "clipmap",
                      {{"n", "63"}, {"culling", "false"}, {"borders", borders}});
        const auto surface =
            settled_surface(flight, camera_over(terrain->info(), {0.5, 0.5}, -1e4, 0, 0));
        const int levels = int(flight.counter("levels_active"));
        EXPECT_EQ(levels, 5);
        int without_area = 0;
        for (std::size_t i = 0; i < surface.vertices.size(); i += 3) {
            const glm::vec3 &a = surface.vertices[i], &b = surface.vertices[i + 1],
                            &c = surface.vertices[i + 2];
            without_area += a == b || b == c || c == a;
        }
        EXPECT_EQ(without_area, std::string(borders) == "closed" ? (levels - 1) * 2 * 62 : 0);
    }
}

TEST(ClipmapTriangles, culling_leaves_out_nothing_that_reaches_a_pixel) {
    const auto terrain = ridged(700, 513);
    std::mt19937 random(3);
    const auto pick = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (const char* n : {"15", "63"}) {
        std::vector<std::vector<float>> depths[2];
        for (const int culling : {0, 1}) {
            random.seed(3);
            Flight flight(terrain, "clipmap", "clipmap",
                          {{"n", n}, {"culling", culling == 0 ? "false" : "true"}});
            for (int i = 0; i < 20; ++i) {
                const Camera camera =
                    camera_over(terrain->info(), {pick(-0.3, 1.3), pick(-0.3, 1.3)},
                                pick(-300, 800), pick(0, 360), pick(-90, 30));
                flight.select(camera);
                flight.stage().settle();
                flight.stage().draw_picture();
                depths[culling].push_back(flight.stage().read_depth());
            }
        }
        for (std::size_t i = 0; i < depths[0].size(); ++i) {
            EXPECT_TRUE(depths[0][i] == depths[1][i]) << "n " << n << ", camera " << i;
        }
    }
}

TEST(ClipmapLevels, of_an_extent_below_two_and_a_half_heights_are_not_drawn) {
    const auto terrain = flat(1025, 1025, 50);
    Flight flight(terrain, "clipmap", "clipmap", {{"n", "15"}});
    const auto finest_at = [&](const glm::dvec3& eye) {
        flight.select(camera_at(eye, 0, -30));
        flight.stage().settle();
        return flight.counter("finest_level");
    };
    // A square of level l is 140 m times 2^l wide; the ground lies at 50 m.
    EXPECT_EQ(finest_at({5000, 5000, 50 + 55}), 0);
    EXPECT_EQ(finest_at({5000, 5000, 50 + 57}), 1);
    EXPECT_EQ(finest_at({5000, 5000, 50 + 111}), 1);
    EXPECT_EQ(finest_at({5000, 5000, 50 + 113}), 2);
    EXPECT_EQ(finest_at({5000, 5000, -500}), 0) << "under the ground";
    EXPECT_EQ(finest_at({-113, 5000, 60}), 2) << "outside, by the way to the border";
    EXPECT_EQ(finest_at({5000, 5000, 1e7}), flight.counter("levels") - 1) << "never none";
}

/// Error and crack pixels of one frame.
results::FrameRecord measured(Flight& flight, const Camera& camera,
                              const std::shared_ptr<const terrain::HeightField>& terrain) {
    run::Stage& stage = flight.stage();
    stage.resize(camera.viewport);
    stage.select(camera, {});
    stage.settle();
    run::FrameMeasurer measurer(stage, std::nullopt, terrain);
    results::FrameRecord record;
    record.triangles = stage.count_primitives();
    measurer.take(0, record, nullptr);
    measurer.measure(record);
    return record;
}

TEST(ClipmapBorders, closed_leave_no_crack_pixel_with_and_without_blending_open_ones_do) {
    const auto terrain = ridged(1025, 1025);
    std::uint64_t open_cracks = 0;
    for (const char* filter : {"tent", "none"}) {
        for (const char* blend : {"true", "false"}) {
            for (const char* borders : {"closed", "open"}) {
                Flight flight(
                    terrain, "clipmap", "clipmap",
                    {{"n", "31"}, {"filter", filter}, {"blend", blend}, {"borders", borders}});
                for (const double heading : {20.0, 200.0}) {
                    const results::FrameRecord record = measured(
                        flight, camera_over(terrain->info(), {0.47, 0.53}, 30, heading, -10),
                        terrain);
                    EXPECT_EQ(record.uncovered_samples, 0U);
                    EXPECT_EQ(record.skirt_pixels.value(), 0U);
                    if (std::string(borders) == "closed") {
                        EXPECT_EQ(record.crack_pixels.value(), 0U)
                            << filter << ", blend " << blend << ", heading " << heading;
                    } else {
                        open_cracks += record.crack_pixels.value();
                    }
                    EXPECT_GT(record.screen_max_px, 0.5) << "too good to judge by";
                }
            }
        }
    }
    EXPECT_GT(open_cracks, 0U);
}

class ClipmapMesh : public MeshTest {};

TEST_F(ClipmapMesh, is_watertight_and_covers_the_terrain_from_wherever_it_is_seen) {
    if (!has_numpy()) GTEST_SKIP() << "no numpy";
    struct Place {
        glm::dvec2 share;
        double above;
    };
    constexpr Place kPlaces[] = {
        {{0.5, 0.5}, 30}, {{0, 0}, 30}, {{1, 0.3}, -200}, {{-0.2, 0.7}, 30}, {{0.31, 0.77}, 2000}};
    for (const auto& [rows, columns] : {std::pair(129, 129), {100, 37}, {5, 7}, {2, 2}}) {
        const auto terrain = ridged(rows, columns);
        for (const char* blend : {"true", "false"}) {
            Flight flight(terrain, "clipmap", "clipmap",
                          {{"n", "15"}, {"blend", blend}, {"culling", "false"}});
            for (const Place& place : kPlaces) {
                const Camera camera =
                    camera_over(terrain->info(), place.share, place.above, 40, -20);
                run::MeshContext context;
                context.method = "clipmap";
                context.terrain = terrain->info();
                context.camera = camera;
                context.clipped = false;
                write_bytes(file("m.ply"),
                            run::ply(run::weld(settled_surface(flight, camera)), context));
                const Outcome outcome =
                    check_mesh(file("m.ply") + " --watertight --covers-terrain");
                EXPECT_EQ(outcome.status, 0)
                    << rows << "x" << columns << ", share " << place.share.x << ", "
                    << place.share.y << ": " << outcome.output;
            }
        }
    }
}

/// What the method's height texture holds: found by its name in the context that is current.
std::vector<glm::vec2> texture_of(const Flight&) {
    for (GLuint name = 1; name < 1000; ++name) {
        std::array<char, 64> label{};
        if (glIsTexture(name) == GL_FALSE) continue;
        glGetObjectLabel(GL_TEXTURE, name, GLsizei(label.size()), nullptr, label.data());
        if (std::string(label.data()) != "clipmap: heights") continue;
        GLint width = 0, height = 0, layers = 0;
        glGetTextureLevelParameteriv(name, 0, GL_TEXTURE_WIDTH, &width);
        glGetTextureLevelParameteriv(name, 0, GL_TEXTURE_HEIGHT, &height);
        glGetTextureLevelParameteriv(name, 0, GL_TEXTURE_DEPTH, &layers);
        std::vector<glm::vec2> texels(std::size_t(width * height * layers));
        glGetTextureImage(name, 0, GL_RG, GL_FLOAT, GLsizei(texels.size() * sizeof(glm::vec2)),
                          texels.data());
        return texels;
    }
    ADD_FAILURE() << "no texture is called 'clipmap: heights'";
    return {};
}

struct Walk {
    const char* name;
    double longest_step;  ///< metres
    int jumps_of_100;
};

void PrintTo(const Walk& walk, std::ostream* stream) {
    *stream << walk.name;
}

class ClipmapWalk : public ::testing::TestWithParam<Walk> {};
INSTANTIATE_TEST_SUITE_P(all, ClipmapWalk,
                         ::testing::Values(Walk{"slow", 4, 0}, Walk{"fast", 120, 0},
                                           Walk{"jumping", 40, 8}),
                         [](const auto& chosen) { return std::string(chosen.param.name); });

TEST_P(ClipmapWalk, leaves_textures_and_surface_of_the_entire_update_to_the_bit) {
    constexpr int kSteps = 1000, kLooked = 250;
    const Walk walk = GetParam();
    const auto terrain = ridged(513, 400);
    const TerrainInfo& info = terrain->info();
    for (const char* filter : {"tent", "none"}) {
        const Settings settings = {{"n", "31"}, {"filter", filter}, {"culling", "false"}};
        std::mt19937 random(17);
        const auto pick = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        struct Seen {
            Camera camera;
            std::vector<glm::vec2> texels;
            std::vector<glm::vec3> vertices;
        };
        std::vector<Seen> seen;
        {
            Flight flight(terrain, "clipmap", "clipmap", settings);
            // Low, so that every level is active; to and fro across all borders.
            glm::dvec2 place(2000, 100);
            for (int step = 1; step <= kSteps; ++step) {
                if (pick(0, 100) < walk.jumps_of_100) {
                    place = {pick(-500, 4500), pick(-500, 5600)};
                } else {
                    place += glm::dvec2(pick(-1, 1), pick(-1, 1.02)) * walk.longest_step;
                }
                const Camera camera = camera_at({place, double(info.min_height)}, 3.6 * step, -10);
                flight.select(camera);
                flight.stage().settle();
                ASSERT_EQ(flight.counter("levels_missing"), 0);
                if (step % kLooked != 0) continue;
                seen.push_back({camera, texture_of(flight), flight.stage().capture().vertices});
            }
        }
        ASSERT_EQ(seen.size(), std::size_t(kSteps / kLooked));
        int compared = 0;
        for (const Seen& walked : seen) {
            Flight fresh(terrain, "clipmap", "clipmap", settings);
            const auto surface = settled_surface(fresh, walked.camera);
            // Far outside fine levels are not active, and hold what was there when they were.
            if (fresh.counter("finest_level") == 0) {
                ++compared;
                EXPECT_TRUE(texture_of(fresh) == walked.texels) << filter;
            }
            EXPECT_TRUE(surface.vertices == walked.vertices) << filter;
            EXPECT_GT(surface.vertices.size(), 100U);
        }
        EXPECT_GT(compared, 0);
    }
}

TEST_F(ClipmapMesh, out_of_core_is_in_core_to_the_bit) {
    const auto field = ridged(700, 1100);
    terrain::write_store(*field, std::nullopt, file("t.tiles"));
    for (const char* filter : {"tent", "none"}) {
        const Settings settings = {{"n", "63"}, {"filter", filter}, {"culling", "false"}};
        std::vector<std::vector<glm::vec3>> vertices[2];
        std::vector<std::vector<glm::vec2>> texels[2];
        for (const int stored : {0, 1}) {
            const std::shared_ptr<const Terrain> terrain =
                stored == 0 ? std::shared_ptr<const Terrain>(field)
                            : std::make_shared<terrain::StoredTerrain>(file("t.tiles"));
            Flight flight(terrain, "clipmap", "clipmap", settings);
            for (int i = 0; i < 12; ++i) {
                const Camera camera = camera_over(field->info(), {0.09 * i, 1 - 0.08 * i},
                                                  i % 3 == 2 ? 900 : 20, 40 * i, -15);
                vertices[stored].push_back(settled_surface(flight, camera).vertices);
                texels[stored].push_back(texture_of(flight));
            }
        }
        EXPECT_GT(vertices[0].front().size(), 1000U);
        EXPECT_TRUE(vertices[0] == vertices[1]) << filter;
        EXPECT_TRUE(texels[0] == texels[1]) << filter;
    }
}

/// Greatest and mean change of the surface at the samples, metres, where the viewer passes the
/// place at which rings move on.
std::pair<double, double> change_at_a_ring_move(const Settings& settings) {
    const auto terrain = ridged(1025, 1025);
    Flight flight(terrain, "clipmap", "clipmap", settings);
    std::vector<float> before(terrain->samples().size()), after(before.size());
    double greatest = 0, sum = 0;
    std::size_t moves = 0;
    // The square of level l moves on where the viewer's column is a multiple of 2^(l + 1).
    for (const double column : {512.0, 514.0, 516.0}) {
        for (const bool beyond : {false, true}) {
            const Camera camera = camera_at(
                {10 * (column + (beyond ? 1e-6 : -1e-6)), 5120.3, terrain->info().min_height}, 0,
                -10);
            auto& into = beyond ? after : before;
            measure::DrawnSurface(settled_surface(flight, camera), terrain->info())
                .displacements(terrain->samples(), into);
        }
        for (std::size_t i = 0; i < before.size(); ++i) {
            const double change = std::abs(double(after[i]) - double(before[i]));
            greatest = std::max(greatest, change);
            sum += change;
        }
        ++moves;
    }
    return {greatest, sum / double(moves * before.size())};
}

TEST(ClipmapBlending, makes_the_surface_go_on_where_rings_move) {
    const auto with = change_at_a_ring_move({{"n", "63"}, {"culling", "false"}});
    const auto without =
        change_at_a_ring_move({{"n", "63"}, {"culling", "false"}, {"blend", "false"}});
    EXPECT_GT(without.first, 10) << "too easy to judge by";
    // Only the last line of cells is cut otherwise, where six sevenths of the height are the
    // coarser level's: see the README.
    EXPECT_LT(with.first, without.first / 6);
    EXPECT_LT(with.second, without.second / 20);
}

TEST(ClipmapWhileTilesAreMissing, a_slow_disk_never_stalls_a_frame_and_coarse_levels_are_drawn) {
    FakeTerrain terrain(4097, 4097);
    std::atomic<bool> slow = false;
    terrain.before_read = [&](const TileId&) {
        if (slow) std::this_thread::sleep_for(600ms);
    };
    LooseMethod loose(terrain, "clipmap", "clipmap", {{"filter", "none"}, {"loader_threads", "1"}});
    slow = true;
    const Camera camera = camera_at({20000, 20000, 100}, 30, -10);
    double longest = 0;
    for (int frame = 0; frame < 5; ++frame) longest = std::max(longest, loose.select(camera));
    EXPECT_LT(longest, 0.4) << "a tile takes 0.6 s";
    EXPECT_GT(loose.counter("levels_missing"), 0);
    EXPECT_GE(loose.counter("levels_active"), 1);
    EXPECT_GT(loose.counter("pieces_drawn"), 0);
    EXPECT_GT(loose.counter("tiles_missing"), 50);
    slow = false;
    for (int frame = 0; frame < 4000 && loose.counter("levels_missing") > 0; ++frame) {
        loose.select(camera);
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_EQ(loose.counter("levels_missing"), 0);
    EXPECT_EQ(loose.counter("tiles_missing"), 0);
    slow = true;  // released while tiles are being read
    loose.select(camera_at({2000, 2000, 100}, 30, -10));
}

TEST(ClipmapWhileTilesAreMissing,
     a_tile_that_cannot_be_read_ends_the_frame_with_the_terrains_words) {
    FakeTerrain terrain(1025, 1025);
    terrain.before_read = [](const TileId& tile) {
        if (tile.level == 0) {
            throw EnvironmentError("moon.tiles: tile (level 0, row 3, column 4): checksum");
        }
    };
    const auto expect_words = [](const auto& call) {
        try {
            call();
            FAIL() << "no error";
        } catch (const EnvironmentError& error) {
            EXPECT_NE(std::string(error.what()).find("moon.tiles: tile (level 0"),
                      std::string::npos);
        }
    };
    const Camera camera = camera_at({5000, 5000, 100}, 30, -10);
    {
        LooseMethod loose(terrain, "clipmap", "clipmap", {{"filter", "none"}});
        expect_words([&] {
            for (int frame = 0; frame < 2000; ++frame) {
                loose.select(camera);
                std::this_thread::sleep_for(1ms);
            }
        });
    }
    LooseMethod loose(terrain, "clipmap", "clipmap", {{"filter", "none"}});
    loose.select(camera);
    expect_words([&] { loose.method().settle(); });
}

TEST(ClipmapBudget, limits_the_texels_of_a_frame_and_completes_the_levels_in_turn) {
    FakeTerrain terrain(4097, 4097);
    LooseMethod loose(terrain, "clipmap", "clipmap",
                      {{"filter", "none"}, {"texels_per_frame", "20000"}});
    const Camera camera = camera_at({20000, 20000, 100}, 30, -10);
    const double window = 255 * 255;
    double active = 0, frames = 0;
    for (; frames < 4000 && (frames == 0 || loose.counter("levels_missing") > 0); ++frames) {
        loose.select(camera);
        const double coarsest = loose.counter("texels_written_level_6");
        EXPECT_EQ(coarsest, frames == 0 ? window : 0);
        EXPECT_LE(loose.counter("texels_written") - coarsest, 20000);
        EXPECT_GE(loose.counter("levels_active"), active);
        active = loose.counter("levels_active");
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_EQ(active, 7);
    EXPECT_GE(frames, 6 * window / 20000);
}

TEST(ClipmapStreaming, reads_what_comes_in_and_writes_an_l_a_level) {
    FakeTerrain terrain(4097, 4097);
    LooseMethod loose(terrain, "clipmap", "clipmap",
                      {{"filter", "none"}, {"n", "127"}, {"prefetch", "100"}});
    const auto camera = [](int frame) {
        return camera_at({10000 + 5.0 * frame, 20000, 100}, 90, -10);
    };
    for (int frame = 0; frame < 2000; ++frame) {
        loose.select(camera(0));
        if (loose.counter("levels_missing") == 0) break;
        std::this_thread::sleep_for(1ms);
    }
    ASSERT_EQ(loose.counter("levels_missing"), 0);
    const std::size_t at_rest = terrain.read_so_far().size();
    double finest_texels = 0, missing = 0;
    // 2000 m eastward: 200 columns of the finest level, 25 of the one three above it.
    for (int frame = 1; frame <= 400; ++frame) {
        loose.select(camera(frame));
        finest_texels += loose.counter("texels_written_level_0");
        missing += loose.counter("levels_missing");
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_EQ(finest_texels, 200 * 127);
    EXPECT_EQ(missing, 0) << "what comes in was read ahead";
    // Of the finest level four columns of two or three tiles, of each coarser one half as many.
    EXPECT_LT(terrain.read_so_far().size() - at_rest, 40U);
}

TEST(ClipmapStreaming, frames_that_settle_do_not_depend_on_what_was_drawn_before) {
    const auto terrain = ridged(513, 513);
    const Camera wanted = camera_over(terrain->info(), {0.3, 0.4}, 20, 40, -12);
    const auto fresh = [&] {
        Flight flight(terrain, "clipmap", "clipmap", {{"n", "31"}});
        return settled_surface(flight, wanted).vertices;
    }();
    Flight used(terrain, "clipmap", "clipmap", {{"n", "31"}});
    for (int i = 0; i < 12; ++i) {
        used.select(camera_over(terrain->info(), {0.08 * i, 0.5}, 20, 30.0 * i, -12));
        used.stage().draw_picture();
        if (i > 5) used.stage().settle();
    }
    EXPECT_GT(fresh.size(), 1000U);
    EXPECT_TRUE(fresh == settled_surface(used, wanted).vertices);
}

}  // namespace
}  // namespace lodbench::test
