// What pgm really sends to the rasteriser, against its mapping and its pyramid in double.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>

#include "persistent_grid/mapping.h"
#include "persistent_grid/pyramid.h"
#include "support/method_fixture.h"

namespace lodbench::test {
namespace {

using persistent_grid::GridSize;
using persistent_grid::Level;
using persistent_grid::Mapping;

constexpr GridSize kGrid{40, 30};
constexpr double kMargin = 0.05;
const std::vector<std::pair<std::string, std::string>> kSettings = {{"grid", "30"},
                                                                    {"aspect", "1.3333"}};

struct NamedCamera {
    const char* name;
    Camera camera;
};

std::vector<NamedCamera> cameras(const TerrainInfo& info) {
    const glm::dvec2 centre = (info.extent_min() + info.extent_max()) / 2.0;
    const glm::dvec2 outside = info.extent_min() - glm::dvec2(3000, 2000);
    return {{"level", camera_at({centre, 400}, 30, 0)},
            {"downward", camera_at({centre, 400}, 100, -25)},
            {"steeply downward", camera_at({centre, 900}, 200, -70)},
            {"straight down", camera_at({centre, 700}, 0, -90)},
            {"straight down, turned", camera_at({centre, 700}, 77, -90)},
            {"upward", camera_at({centre, 300}, 250, 40)},
            {"straight up", camera_at({centre, 300}, 0, 90)},
            {"rolled by 45 degrees", camera_at({centre, 400}, 10, -10, 45)},
            {"rolled by 90 degrees", camera_at({centre, 400}, 10, -40, 90)},
            {"upside down", camera_at({centre, 400}, 310, -5, 180)},
            {"rolled, all rays downward", camera_at({centre, 900}, 10, -80, 30)},
            {"on the plane", camera_at({centre, 0}, 45, 0)},
            {"on the plane, downward", camera_at({centre, 0}, 45, -60)},
            {"under the plane", camera_at({centre, -250}, 45, 5)},
            {"under the plane, straight down", camera_at({centre, -250}, 0, -90)},
            {"outside, towards the terrain", camera_at({outside, 500}, 45, -5)},
            {"outside, away from it", camera_at({outside, 500}, 225, -5)},
            {"far outside", camera_at({outside - glm::dvec2(4e5, 4e5), 9000}, 45, -2)},
            {"narrow", camera_at({centre, 400}, 30, -3, 0, 5)},
            {"wide", camera_at({centre, 400}, 30, -3, 0, 120)}};
}

/// The grid's vertices by (row, column), from the triangles: cells come in bands of eight columns,
/// each cell as (far left, near left, near right), (far left, near right, far right).
std::vector<glm::vec3> grid_vertices(const measure::CapturedSurface& surface) {
    std::vector<glm::vec3> vertices(std::size_t(kGrid.columns * kGrid.rows));
    std::size_t next = 0;
    for (int band = 0; band < kGrid.columns - 1; band += 8) {
        for (int row = 0; row < kGrid.rows - 1; ++row) {
            for (int column = band; column < std::min(band + 8, kGrid.columns - 1);
                 ++column, next += 6) {
                const std::size_t far_left = std::size_t(row * kGrid.columns + column);
                const std::size_t near_left = far_left + std::size_t(kGrid.columns);
                vertices[far_left] = surface.vertices[next];
                vertices[near_left] = surface.vertices[next + 1];
                vertices[near_left + 1] = surface.vertices[next + 2];
                vertices[far_left + 1] = surface.vertices[next + 5];
            }
        }
    }
    return vertices;
}

class PgmSurface : public ::testing::Test {
protected:
    std::shared_ptr<const terrain::HeightField> terrain_ = hills(201, 166);
    Flight flight_{terrain_, "persistent_grid", "pgm", kSettings};
};

TEST_F(PgmSurface, is_finite_and_has_the_same_number_of_triangles_for_every_camera) {
    for (const auto& [name, camera] : cameras(terrain_->info())) {
        const auto surface = flight_.surface(camera);
        EXPECT_EQ(surface.triangle_count(), std::size_t(2 * (kGrid.columns - 1) * (kGrid.rows - 1)))
            << name;
        EXPECT_EQ(flight_.stage().count_primitives(), surface.triangle_count()) << name;
        for (const glm::vec3& vertex : surface.vertices) {
            ASSERT_TRUE(std::isfinite(vertex.x) && std::isfinite(vertex.y) &&
                        std::isfinite(vertex.z))
                << name;
            const float height = float(vertex.z + surface.origin.z);
            ASSERT_GE(height, terrain_->info().min_height - 0.01F) << name;
            ASSERT_LE(height, terrain_->info().max_height + 0.01F) << name;
        }
    }
}

void expect_mapped(Flight& flight, const TerrainInfo& info, const GridSize& grid) {
    for (const auto& [name, camera] : cameras(info)) {
        const Mapping mapping = persistent_grid::make_mapping(camera, info, 0, {kMargin}, grid);
        const auto vertices = grid_vertices(flight.surface(camera));
        for (int row = 0; row < kGrid.rows; ++row) {
            for (int column = 0; column < kGrid.columns; ++column) {
                const glm::dvec3 ray =
                    mapping.ray(double(column) / (kGrid.columns - 1), grid.way_down(row));
                const glm::dvec2 expected = persistent_grid::ground_point(mapping, ray);
                const glm::dvec2 found(vertices[std::size_t(row * kGrid.columns + column)]);
                // A ray's components carry a few roundings of the sum they come from; the slope
                // divides. Where its parts have one sign (the restricted camera) the slope does not
                // cancel.
                const double sum = glm::length(mapping.first) + glm::length(mapping.across) +
                                   glm::length(mapping.down);
                const double relative = mapping.restricted ? 1e-6 : 3e-7 * sum / -ray.z;
                const double distance = glm::length(expected);
                const double sideways = 3e-7 * sum * distance / glm::length(glm::dvec2(ray));
                ASSERT_LE(glm::length(found - expected), distance * relative + sideways)
                    << name << ", vertex " << row << ", " << column;
            }
        }
    }
}

TEST_F(PgmSurface, lies_where_the_mapping_in_double_puts_it) {
    expect_mapped(flight_, terrain_->info(), kGrid);
}

TEST(PgmRows, denser_at_the_horizon_lie_where_the_mapping_in_double_puts_them) {
    const auto terrain = hills(201, 166);
    auto settings = kSettings;
    settings.emplace_back("rows", "horizon");
    Flight flight(terrain, "persistent_grid", "pgm", settings);
    expect_mapped(flight, terrain->info(), {kGrid.columns, kGrid.rows, true});
}

/// Bilinear height of a level at a place in samples, as the README defines it.
double level_height(const Level& level, int l, const glm::dvec2& place) {
    const glm::dvec2 texel = (place + 0.5) / double(1 << l) - 0.5;
    const glm::dvec2 corner = glm::floor(texel), t = texel - corner;
    const auto at = [&](double column, double row) {
        return double(level.at(int(std::clamp(row, 0.0, level.rows - 1.0)),
                               int(std::clamp(column, 0.0, level.columns - 1.0))));
    };
    return glm::mix(glm::mix(at(corner.x, corner.y), at(corner.x + 1, corner.y), t.x),
                    glm::mix(at(corner.x, corner.y + 1), at(corner.x + 1, corner.y + 1), t.x), t.y);
}

/// The texel nearest to a place in samples.
double nearest_height(const Level& level, int l, const glm::dvec2& place) {
    const glm::dvec2 texel = glm::floor((place + 0.5) / double(1 << l));
    return level.at(int(std::clamp(texel.y, 0.0, level.rows - 1.0)),
                    int(std::clamp(texel.x, 0.0, level.columns - 1.0)));
}

/// A setting of level, spacing, interpolation and finest_only.
struct Sampling {
    const char* level;
    const char* spacing;
    const char* interpolation;
    bool finest_only = false;
};
void PrintTo(const Sampling& sampling, std::ostream* stream) {
    *stream << sampling.level << ", " << sampling.spacing << ", " << sampling.interpolation
            << (sampling.finest_only ? ", finest only" : "");
}

class PgmHeights : public ::testing::TestWithParam<Sampling> {
protected:
    static constexpr int kWindow = 64;

    [[nodiscard]] std::vector<std::pair<std::string, std::string>> settings() const {
        auto settings = kSettings;
        settings.emplace_back("level", GetParam().level);
        settings.emplace_back("spacing", GetParam().spacing);
        settings.emplace_back("interpolation", GetParam().interpolation);
        settings.emplace_back("finest_only", GetParam().finest_only ? "true" : "false");
        settings.emplace_back("window", std::to_string(kWindow));
        return settings;
    }
    /// Level and weight of the parent as one number, 2.25: a quarter of level 3 in level 2. And how
    /// far float rounding may move it.
    struct Detail {
        double level = 0, tolerance = 0;
    };
    [[nodiscard]] Detail detail(const Mapping& mapping, int column, int row, double q) const {
        if (GetParam().finest_only) return {0, 0};
        const double h = mapping.eye_height;
        double ratio = 0, relative = 1e-5;
        if (GetParam().level == std::string("distance")) {
            ratio = 2 * q / (kWindow / 2 * 10.0);  // the shorter side of a sample; begins at a half
        } else if (GetParam().spacing == std::string("formula")) {
            ratio = persistent_grid::spacing_by_formula(mapping, q) / 12.5;  // the longer side
            // Where the next ray barely meets the plane, the rounding of q is magnified.
            relative +=
                1e-6 * (h + q) /
                std::max(1e-6, h * std::cos(mapping.ray_angle) - q * std::sin(mapping.ray_angle));
        } else {
            const double r = persistent_grid::farthest_neighbour(mapping, kGrid, column, row);
            ratio = r / 12.5;
            // A difference of two places: rounding of their distances, in parts of it. The slope of
            // a ray that was not restricted may have cancelled.
            relative += (mapping.restricted ? 3e-6 : 1e-4) * (h + q + r) / r;
        }
        if (ratio <= 1) return {0, relative};
        ratio = std::min(ratio, 1e9);
        const double level = std::floor(std::log2(ratio));
        return {level + ratio / std::exp2(level) - 1, 2 * relative};
    }
};

TEST_P(PgmHeights, are_those_of_section_3_4) {
    const auto terrain = hills(201, 166);
    const TerrainInfo& info = terrain->info();
    Level finest{info.columns, info.rows, {terrain->samples().begin(), terrain->samples().end()}};
    const auto levels = persistent_grid::make_pyramid(finest);
    const bool parent = GetParam().interpolation == std::string("parent");
    const bool nearest = GetParam().interpolation == std::string("nearest");
    Flight flight(terrain, "persistent_grid", "pgm", settings());
    std::map<int, int> levels_seen;
    int compared = 0, passed_over = 0;
    for (const auto& [name, camera] : cameras(info)) {
        const Mapping mapping = persistent_grid::make_mapping(camera, info, 0, {kMargin}, kGrid);
        const auto surface = flight.surface(camera);
        const auto vertices = grid_vertices(surface);
        for (int row = 0; row < kGrid.rows; ++row) {
            for (int column = 0; column < kGrid.columns; ++column) {
                const glm::vec3 vertex = vertices[std::size_t(row * kGrid.columns + column)];
                const glm::dvec3 world = surface.origin + glm::dvec3(vertex);
                const double q = glm::length(glm::dvec2(vertex));
                if (q > mapping.far_distance * 0.999) continue;
                const int last = int(levels.size()) - 1;
                const Detail wanted = detail(mapping, column, row, q);
                const double exact = std::min(wanted.level, double(last));
                const int l = int(exact);
                const glm::dvec2 place((world.x - info.origin.x) / info.spacing.x,
                                       info.rows - 1 - (world.y - info.origin.y) / info.spacing.y);
                // Where a level or a texel changes without blending, either of the two is right.
                const double edge = exact - l;
                const glm::dvec2 within = glm::fract((place + 0.5) / std::exp2(l));
                const glm::dvec2 to_edge = glm::min(within, 1.0 - within);
                const bool undecided = (!parent && std::min(edge, 1 - edge) < wanted.tolerance &&
                                        exact < last && exact > 0) ||
                                       (nearest && std::min(to_edge.x, to_edge.y) < 1e-3);
                passed_over += undecided ? 1 : 0;
                if (undecided) continue;
                const auto height = nearest ? nearest_height : level_height;
                double expected = height(levels[std::size_t(l)], l, place);
                if (parent && l < last) {
                    expected =
                        glm::mix(expected, height(levels[std::size_t(l + 1)], l + 1, place), edge);
                }
                ++levels_seen[l];
                ++compared;
                // Float weights and heights of 160 m: 1e-5 m each; levels differ by at most 120 m.
                ASSERT_NEAR(world.z, expected, 2e-3 + (parent ? 120 * wanted.tolerance : 0))
                    << name << ", level " << exact << ", row " << row << ", column " << column;
            }
        }
    }
    EXPECT_LT(passed_over, compared / 5);
    EXPECT_GE(levels_seen.size(), GetParam().finest_only ? 1U : 6U);
}

INSTANTIATE_TEST_SUITE_P(of, PgmHeights,
                         testing::Values(Sampling{"spacing", "neighbour", "parent"},
                                         Sampling{"spacing", "neighbour", "bilinear"},
                                         Sampling{"spacing", "neighbour", "nearest"},
                                         Sampling{"spacing", "formula", "parent"},
                                         Sampling{"spacing", "formula", "bilinear"},
                                         Sampling{"distance", "neighbour", "parent"},
                                         Sampling{"distance", "neighbour", "nearest"},
                                         Sampling{"spacing", "neighbour", "bilinear", true}));

// As bits: an edge inside the grid is used by two triangles, one on its border by one.
TEST_F(PgmSurface, neighbouring_triangles_share_their_vertices_to_the_bit) {
    using Bits = std::array<std::uint32_t, 3>;
    const auto bits = [](const glm::vec3& v) {
        return Bits{std::bit_cast<std::uint32_t>(v.x), std::bit_cast<std::uint32_t>(v.y),
                    std::bit_cast<std::uint32_t>(v.z)};
    };
    for (const auto& [name, camera] : cameras(terrain_->info())) {
        const auto surface = flight_.surface(camera);
        std::map<std::pair<Bits, Bits>, int> edges;
        for (std::size_t i = 0; i < surface.vertices.size(); i += 3) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Bits a = bits(surface.vertices[i + k]),
                           b = bits(surface.vertices[i + (k + 1) % 3]);
                ASSERT_NE(a, b) << name;
                ++edges[std::minmax(a, b)];
            }
        }
        int once = 0;
        for (const auto& [edge, count] : edges) {
            ASSERT_LE(count, 2) << name;
            once += count == 1;
        }
        EXPECT_EQ(once, 2 * (kGrid.columns - 1) + 2 * (kGrid.rows - 1)) << name;
    }
}

TEST_F(PgmSurface, no_triangle_folds_over_in_plan) {
    for (const auto& [name, camera] : cameras(terrain_->info())) {
        const auto surface = flight_.surface(camera);
        for (std::size_t i = 0; i < surface.vertices.size(); i += 3) {
            const glm::dvec2 a(surface.vertices[i]), b(surface.vertices[i + 1]),
                c(surface.vertices[i + 2]);
            const glm::dvec2 u = b - a, v = c - a;
            // All the same way round, up to the rounding of thin triangles.
            ASSERT_GT(u.x * v.y - u.y * v.x, -1e-5 * glm::length(u) * glm::length(v))
                << name << ", triangle " << i / 3;
        }
    }
}

/// Settings of kSettings and more.
std::vector<std::pair<std::string, std::string>> with(
    const std::vector<std::pair<std::string, std::string>>& more) {
    auto settings = kSettings;
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
}

/// From each camera, in one flight, with nothing missing.
std::vector<measure::CapturedSurface> settled_surfaces(
    const std::shared_ptr<const Terrain>& terrain,
    const std::vector<std::pair<std::string, std::string>>& settings,
    const std::vector<NamedCamera>& cameras) {
    Flight flight(terrain, "persistent_grid", "pgm", settings);
    std::vector<measure::CapturedSurface> surfaces;
    for (const auto& [name, camera] : cameras) {
        flight.select(camera);
        flight.stage().settle();
        surfaces.push_back(flight.stage().capture());
    }
    return surfaces;
}

bool equal_bits(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

// Windows as large as the terrain hold all of it.
TEST(PgmOutOfCore, is_what_it_is_in_core_to_the_bit_where_the_windows_hold_the_levels) {
    const auto terrain = hills(201, 166);
    const auto all = cameras(terrain->info());
    for (const std::string level : {"spacing", "distance"}) {
        const auto whole = settled_surfaces(
            terrain, with({{"storage", "whole"}, {"level", level}, {"window", "256"}}), all);
        const auto windows = settled_surfaces(
            terrain,
            with({{"storage", "windows"}, {"level", level}, {"window", "256"}, {"cache", "false"}}),
            all);
        for (std::size_t i = 0; i < all.size(); ++i) {
            EXPECT_TRUE(equal_bits(windows[i].vertices, whole[i].vertices))
                << all[i].name << ", " << level;
        }
    }
}

// Small ones hold a part: where that is what a vertex needs, it is the same vertex. Elsewhere its
// height comes from a coarser level.
TEST(PgmOutOfCore, a_vertex_whose_texels_the_windows_hold_is_that_in_core_to_the_bit) {
    constexpr int kWindow = 64;
    const auto terrain = hills(500, 700);
    const TerrainInfo& info = terrain->info();
    const auto all_cameras = cameras(info);
    const auto whole = settled_surfaces(terrain, with({{"storage", "whole"}}), all_cameras);
    const auto windows = settled_surfaces(
        terrain, with({{"storage", "windows"}, {"window", "64"}, {"cache", "false"}}), all_cameras);
    int the_same = 0, coarser = 0;
    const int last = persistent_grid::level_count(info) - 1;
    for (std::size_t frame = 0; frame < all_cameras.size(); ++frame) {
        const auto& [name, camera] = all_cameras[frame];
        const Mapping mapping = persistent_grid::make_mapping(camera, info, 0, {kMargin}, kGrid);
        const auto expected = grid_vertices(whole[frame]);
        const auto found = grid_vertices(windows[frame]);
        const auto place_of = [&](const glm::dvec2& world) {
            const glm::dvec2 samples = (world - info.origin) / info.spacing;
            return glm::dvec2(samples.x, info.rows - 1 - samples.y);
        };
        // Whether the middle of a window holds the four texels around a place, by a texel to spare.
        const auto held = [&](int level, const glm::dvec2& place) {
            const glm::dvec2 size(persistent_grid::level_size(info, level));
            const glm::dvec2 texel = (place + 0.5) / std::exp2(level) - 0.5;
            const glm::dvec2 eye =
                (place_of(glm::dvec2(camera.position)) + 0.5) / std::exp2(level) - 0.5;
            const glm::dvec2 low = glm::clamp(eye - kWindow / 2.0 + 2.0, glm::dvec2(0),
                                              glm::max(size - double(kWindow), 0.0));
            const glm::dvec2 read = glm::clamp(texel, glm::dvec2(0), size - 1.0);
            return glm::all(glm::greaterThanEqual(read, low)) &&
                   glm::all(glm::lessThanEqual(read + 1.0, low + (kWindow - 3.0)));
        };
        for (int row = 0; row < kGrid.rows; ++row) {
            for (int column = 0; column < kGrid.columns; ++column) {
                const auto i = std::size_t(row * kGrid.columns + column);
                ASSERT_EQ(found[i].x, expected[i].x) << name;
                ASSERT_EQ(found[i].y, expected[i].y) << name;
                const double r = persistent_grid::farthest_neighbour(mapping, kGrid, column, row);
                const double texels = std::max(r / 12.5, 1.0) * 0.999;
                const int level = std::min(last, int(std::max(0.0, std::floor(std::log2(texels)))));
                const glm::dvec2 place =
                    place_of(glm::dvec2(camera.position) + glm::dvec2(expected[i]));
                // The level, the next (where rounding may put r) and its parent.
                bool all = true;
                for (int l = level; l <= std::min(level + 2, last); ++l) all &= held(l, place);
                if (all) {
                    ASSERT_EQ(found[i].z, expected[i].z) << name << ": " << row << ", " << column;
                    ++the_same;
                } else {
                    coarser += found[i].z != expected[i].z ? 1 : 0;
                }
            }
        }
    }
    EXPECT_GT(the_same, 5000);
    EXPECT_GT(coarser, 50);
}

TEST(PgmOutOfCore, what_is_drawn_depends_on_the_camera_alone_once_it_has_settled) {
    const auto terrain = hills(500, 700);
    const auto settings = with({{"storage", "windows"}, {"window", "64"}, {"cache", "false"}});
    const auto all = cameras(terrain->info());
    const auto flown = settled_surfaces(terrain, settings, all);
    auto entire = settings;
    entire.emplace_back("update", "entire");
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto fresh = settled_surfaces(terrain, entire, {all[i]});
        EXPECT_TRUE(equal_bits(flown[i].vertices, fresh[0].vertices)) << all[i].name;
    }
}

// In its first frames, before anything has been read: the levels that are in memory.
TEST(PgmOutOfCore, before_anything_is_read_the_coarse_levels_are_drawn) {
    const auto terrain = hills(500, 700);
    Flight flight(terrain, "persistent_grid", "pgm",
                  with({{"storage", "windows"}, {"window", "64"}, {"cache", "false"}}));
    flight.stage().pause_background();
    const auto surface = flight.surface(cameras(terrain->info()).front().camera);
    EXPECT_EQ(flight.counter("windows_behind"), 4) << "500 x 700 to 63 x 88 texels";
    for (const glm::vec3& vertex : surface.vertices) {
        const double height = double(vertex.z) + surface.origin.z;
        ASSERT_GE(height, terrain->info().min_height);
        ASSERT_LE(height, terrain->info().max_height);
    }
    flight.stage().resume_background();
    flight.stage().settle();
    EXPECT_EQ(flight.counter("windows_behind"), 0);
}

TEST(PgmSurfaceOverAPlane, straight_down_it_is_the_uniform_grid) {
    const auto terrain = flat(101, 101, 50);
    Flight flight(terrain, "persistent_grid", "pgm", kSettings);
    const Camera camera = camera_at({500, 500, 300}, 0, -90);
    const auto vertices = grid_vertices(flight.surface(camera));
    // Half extents on the plane 300 m below: 60 degrees and 4:3 across; 90 degrees, extended, down.
    const double half_width = 300 * std::tan(30 * kDegree) * 4 / 3 * (1 + kMargin);
    const double half_height = 300 * (1 + kMargin);
    for (int row = 0; row < kGrid.rows; ++row) {
        for (int column = 0; column < kGrid.columns; ++column) {
            const glm::dvec3 vertex(vertices[std::size_t(row * kGrid.columns + column)]);
            // Coordinates of about 300 in float.
            EXPECT_NEAR(vertex.x, half_width * (2.0 * column / (kGrid.columns - 1) - 1), 2e-4);
            EXPECT_NEAR(vertex.y, half_height * (1 - 2.0 * row / (kGrid.rows - 1)), 2e-4);
            EXPECT_EQ(vertex.z, -250);
        }
    }
}

TEST(PgmSurfaceOverAPlane, minimum_near_puts_the_plane_on_the_ground) {
    const auto terrain = flat(101, 101, 1500);
    Flight flight(terrain, "persistent_grid", "pgm", {{"base", "minimum-near"}});
    flight.select(camera_at({500, 500, 1600}, 0, -30));
    EXPECT_EQ(flight.counter("base_height_m"), 1500);
    EXPECT_EQ(flight.counter("eye_height_above_base_m"), 100);
}

}  // namespace
}  // namespace lodbench::test
