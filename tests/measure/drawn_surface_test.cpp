// The drawn surface's height: known answers, and every search against asking all triangles one by
// one.

#include <gtest/gtest.h>

#include <bit>
#include <thread>

#include "api/error.h"
#include "drawn_surface_mesh.h"
#include "measure/plan_triangle.h"

namespace lodbench::measure {
namespace {

TEST(PlanTriangle, two_with_an_edge_in_common_leave_no_point_of_it) {
    Random random(1);
    for (int trial = 0; trial < 20000; ++trial) {
        const auto point = [&](double scale) {
            return glm::vec3(random.between(-scale, scale), random.between(-scale, scale), 0);
        };
        const double scale = std::pow(10, random.between(-2, 6));
        const glm::vec3 a = point(scale);
        const glm::vec3 b = point(scale);
        const glm::dvec2 along = glm::dvec2(b) - glm::dvec2(a);
        const glm::dvec2 across(-along.y, along.x);
        const auto corner = [&](double side) {
            return glm::vec3(glm::dvec2(a) + along * random.between(-1, 2) +
                                 side * across * random.between(0.1, 2),
                             0);
        };
        const Corners left = ordered({a, b, corner(1)});
        const Corners right = ordered({b, corner(-1), a});
        glm::dvec2 on = glm::dvec2(a) + along * random.between(0.001, 0.999);
        for (int step = 0; step < 3; ++step) {
            EXPECT_TRUE(PlanTriangle(left.data()).covers(on) ||
                        PlanTriangle(right.data()).covers(on))
                << trial;
            // A few of the last places to one side or the other.
            on += 0x1p-52 * scale * glm::dvec2(random.between(-2, 2), random.between(-2, 2));
        }
    }
}

TEST(DrawnSurface, a_plane_is_exact_anywhere) {
    const TerrainInfo info = terrain(21, 21, 1, {1e7, 1e7});
    const Height plane = [](double x, double y) { return 2 * (x - 1e7) - 0.5 * (y - 1e7) + 3; };
    Mesh mesh;
    mesh.eye = {1e7 + 8, 1e7 + 4, 16};  // all that follows is exact in float32
    Random random(2);
    mesh.quadtree(random, info.origin, 20, info.origin + 4.0, plane, 2);
    const DrawnSurface surface = mesh.drawn(info);
    EXPECT_EQ(surface.triangle_count(), mesh.vertices.size() / 3);
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec2 position = random.inside(info);
        const std::optional<double> height = surface.height(position);
        ASSERT_TRUE(height);
        // A few roundings of coordinates of at most 20 m with slope 2.
        EXPECT_NEAR(*height, plane(position.x, position.y), 16 * 40 * 0x1p-53);
    }
}

TEST(DrawnSurface, a_vertex_has_its_own_height_to_the_bit) {
    const TerrainInfo info = terrain(65, 65);
    Random random(3);
    for (int trial = 0; trial < 2000; ++trial) {
        Mesh mesh = soup(random, info, 1);
        mesh.eye = glm::dvec3(0);
        const DrawnSurface surface = mesh.drawn(info);
        for (const glm::vec3& vertex : mesh.vertices) {
            if (surface.triangle_count() == 0) continue;  // outside, seen from this eye
            EXPECT_EQ(surface.height(glm::dvec2(vertex)), double(vertex.z));
        }
    }
}

TEST(DrawnSurface, the_highest_wins) {
    const TerrainInfo info = terrain(11, 11);
    Mesh mesh;
    mesh.flat({0, 0}, {10, 10}, 1);
    mesh.flat({2, 2}, {6, 6}, 4);
    mesh.flat({4, 4}, {8, 8}, 3);
    const DrawnSurface surface = mesh.drawn(info);
    EXPECT_EQ(surface.height({1, 1}), 1);
    EXPECT_EQ(surface.height({5, 5}), 4);
    EXPECT_EQ(surface.height({6, 6}), 4);  // its edge is its own
    EXPECT_EQ(surface.height({6, 3}), 4);  // also where what is lower covers it with its inside
    EXPECT_EQ(surface.height({7, 7}), 3);
    const std::vector<float> found = displacements(surface, info, 0.5F);
    EXPECT_EQ(found[std::size_t(5) * 11 + 5], 3.5F);
    EXPECT_EQ(found[std::size_t(7) * 11 + 6], 3.5F);
}

/// The greatest rounding among the triangles at a point, by asking each.
DrawnSurface::Rounding rounding_at(const Mesh& mesh, const TerrainInfo& info,
                                   const glm::dvec2& position) {
    const glm::dvec2 eye(mesh.eye);
    const glm::dvec2 low = glm::abs(info.extent_min() - eye);
    const glm::dvec2 high = glm::abs(info.extent_max() - eye);
    const double reach = std::max({low.x, low.y, high.x, high.y});
    DrawnSurface::Rounding greatest;
    for (std::size_t i = 0; i < mesh.vertices.size(); i += 3) {
        const Corners corners =
            ordered({mesh.vertices[i], mesh.vertices[i + 1], mesh.vertices[i + 2]});
        double in_plan = 0, upright = 0;
        for (const glm::vec3& corner : corners) {
            in_plan = std::max({in_plan, double(std::abs(corner.x)), double(std::abs(corner.y))});
            upright = std::max(upright, double(std::abs(corner.z)));
        }
        const double plan = DrawnSurface::kRoundingUnits * kUnit * std::min(in_plan, reach);
        if (!PlanTriangle(corners.data()).covers(position - eye) &&
            nearest_on_outline(corners.data(), position - eye).distance > plan) {
            continue;
        }
        greatest.plan = std::max(greatest.plan, plan);
        greatest.height = std::max(greatest.height, DrawnSurface::kRoundingUnits * kUnit * upright);
    }
    return greatest;
}

TEST(DrawnSurface, one_look_finds_the_height_and_the_greatest_rounding_there) {
    const TerrainInfo info = terrain(65, 65, 3);
    Random random(8);
    int beside = 0, uncovered = 0;
    for (int trial = 0; trial < 30; ++trial) {
        const Mesh mesh = soup(random, info, 20);
        const DrawnSurface surface = mesh.drawn(info);
        const auto ask = [&](const glm::dvec2& place) {
            const glm::dvec2 point = glm::clamp(place, info.extent_min(), info.extent_max());
            const DrawnSurface::Look look = surface.look(point);
            const DrawnSurface::Rounding expected = rounding_at(mesh, info, point);
            ASSERT_EQ(look.height, surface.height(point)) << point.x << ", " << point.y;
            ASSERT_EQ(look.rounding.plan, expected.plan) << point.x << ", " << point.y;
            ASSERT_EQ(look.rounding.height, expected.height) << point.x << ", " << point.y;
            ASSERT_EQ(look.height.has_value(), expected.plan > 0);
            uncovered += look.height ? 0 : 1;
        };
        for (int i = 0; i < 200; ++i) ask(random.inside(info));
        // On sides, and about a rounding beside them.
        for (std::size_t i = 0; i + 1 < mesh.vertices.size(); ++i) {
            const glm::dvec3 side =
                glm::mix(glm::dvec3(mesh.vertices[i]), glm::dvec3(mesh.vertices[i + 1]),
                         random.between(0, 1));
            const double step = 200 * 4 * kUnit;
            for (int k = 0; k < 5; ++k, ++beside) {
                ask(glm::dvec2(mesh.eye + side) +
                    glm::dvec2(random.between(-step, step), random.between(-step, step)));
            }
        }
    }
    EXPECT_GT(beside, 5000);
    EXPECT_GT(uncovered, 20);
}

TEST(DrawnSurface, a_hole_of_one_cell_is_uncovered_inside_and_only_there) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            const glm::dvec2 low(column * 4, row * 4);
            if (row != 1 || column != 2) mesh.rectangle(low, low + 4.0, hills);
        }
    }
    const DrawnSurface surface = mesh.drawn(info);
    EXPECT_FALSE(surface.height({10.5, 6.5}));
    EXPECT_TRUE(surface.height({8, 6.5}));
    const std::vector<float> found = displacements(surface, info);
    for (int row = 0; row < 17; ++row) {
        for (int column = 0; column < 17; ++column) {
            const glm::dvec2 position = info.position(row, column);
            const bool hole = position.x > 8 && position.x < 12 && position.y > 4 && position.y < 8;
            EXPECT_EQ(std::isnan(found[std::size_t(row) * 17 + std::size_t(column)]), hole);
        }
    }
}

TEST(DrawnSurface, borders_that_round_inward_cover_the_samples_on_them) {
    const TerrainInfo info = terrain(33, 33, 0.7);
    for (const double away : {1e6, -1e6}) {
        Mesh mesh;
        mesh.eye = {away + 0.3, away / 3, 100};
        mesh.grid({0, 0}, info.extent_max().x, 32, [](double x, double y) { return x / 4 + y; });
        const DrawnSurface surface = mesh.drawn(info);
        int strictly_uncovered = 0;
        const std::vector<float> found = displacements(surface, info);
        for (int row = 0; row < 33; ++row) {
            for (int column = 0; column < 33; ++column) {
                const glm::dvec2 position = info.position(row, column);
                if (Oracle{mesh}.height(position).highest == -kInfinity) ++strictly_uncovered;
                // Each vertex is off by half a unit of float32 at most, 2^-25 of 2^20, the slope is
                // 1.25 in all; z, at most 128 from the eye, rounds by less than a thousandth of it.
                EXPECT_NEAR(found[std::size_t(row) * 33 + std::size_t(column)],
                            position.x / 4 + position.y, 2 * 1.25 * 0x1p-5)
                    << row << ' ' << column;
            }
        }
        EXPECT_GT(strictly_uncovered, 0);  // else nothing was tried
    }
}

TEST(DrawnSurface, covers_no_farther_than_its_rounding) {
    const TerrainInfo info = terrain(3, 3, 16);
    Mesh mesh;
    mesh.flat({0, 0}, {16, 32}, 2);
    const DrawnSurface surface = mesh.drawn(info);
    const double reach = DrawnSurface::kRoundingUnits * kUnit * 32;
    EXPECT_EQ(surface.height({16 + 0.99 * reach, 7}), 2);
    EXPECT_EQ(surface.height({16 + 1.01 * reach, 7}), std::nullopt);
}

TEST(DrawnSurface, the_nearest_point_gives_the_height_beside_a_triangle_and_the_highest_wins) {
    const TerrainInfo info = terrain(3, 3, 16);
    Mesh mesh;
    mesh.rectangle({0, 0}, {16, 32}, [](double, double y) { return y; });
    const double beside = 16 + 0.5 * DrawnSurface::kRoundingUnits * kUnit * 32;
    EXPECT_EQ(mesh.drawn(info).height({beside, 24}), 24);
    mesh.flat({0, 24}, {16, 26}, 25.5);  // as near
    EXPECT_EQ(mesh.drawn(info).height({beside, 24}), 25.5);
    mesh.flat({0, 0}, {32, 32}, -3);  // covers strictly: neighbours are not asked
    EXPECT_EQ(mesh.drawn(info).height({beside, 24}), -3);
}

TEST(DrawnSurface, displacements_are_height_minus_the_sample_to_the_bit) {
    Random random(4);
    const std::array<std::array<int, 2>, 4> sizes{{{2, 2}, {37, 131}, {300, 257}, {129, 128}}};
    for (const auto& [rows, columns] : sizes) {
        const double spacing = random.between(0.3, 3);
        const TerrainInfo info =
            terrain(rows, columns, spacing, {random.between(-1e6, 1e6), random.between(-1e6, 1e6)});
        const glm::dvec2 size = info.extent_max() - info.extent_min();
        std::vector<Mesh> meshes;
        meshes.push_back(soup(random, info, 60));
        Mesh tree;
        tree.eye = {random.inside(info), 30};
        tree.quadtree(random, info.origin, std::max(size.x, size.y), glm::dvec2(tree.eye), hills,
                      1);
        meshes.push_back(tree);
        std::vector<float> heights(std::size_t(rows) * std::size_t(columns));
        for (float& height : heights) height = float(random.between(-10, 10));
        std::vector<float> found(heights.size());
        for (const Mesh& mesh : meshes) {
            const DrawnSurface surface = mesh.drawn(info);
            surface.displacements(heights, found);
            for (int row = 0; row < rows; ++row) {
                for (int column = 0; column < columns; ++column) {
                    const std::size_t i =
                        std::size_t(row) * std::size_t(columns) + std::size_t(column);
                    const auto height = surface.height(info.position(row, column));
                    if (height) {
                        EXPECT_EQ(found[i], float(*height - double(heights[i])));
                    } else {
                        EXPECT_TRUE(std::isnan(found[i]));
                    }
                }
            }
        }
    }
}

TEST(DrawnSurface, height_is_what_asking_every_triangle_gives) {
    Random random(5);
    const TerrainInfo info = terrain(65, 65, 1, {1e5, -2e5});
    int covered = 0;
    for (int count : {1, 2, 5, 40, 400}) {
        for (int trial = 0; trial < 5; ++trial) {
            const Mesh mesh = soup(random, info, count);
            const DrawnSurface surface = mesh.drawn(info);
            for (int i = 0; i < 300; ++i) {
                const glm::dvec2 position = random.inside(info);
                const Oracle::Answer expected = Oracle{mesh}.height(position);
                if (expected.least_margin < 1e-5) continue;
                const std::optional<double> height = surface.height(position);
                ASSERT_EQ(height.has_value(), expected.highest != -kInfinity);
                if (!height) continue;
                EXPECT_NEAR(*height, double(expected.highest), 1e-11);
                ++covered;
            }
        }
    }
    EXPECT_GT(covered, 1000);
}

TEST(DrawnSurface, a_sliver_covers_only_as_rounding_does) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;
    const double thin = 4 * kUnit * 16;  // half of the rounding
    mesh.triangle({8, 0, 1}, {8, 16, 1}, {8 + thin, 8, 1});
    const DrawnSurface alone = mesh.drawn(info);
    EXPECT_EQ(alone.triangle_count(), 1U);
    EXPECT_EQ(alone.skirt_triangle_count() + alone.wall_triangle_count(), 0U);
    EXPECT_EQ(alone.height({8 + thin / 2, 8}), 1);
    EXPECT_EQ(displacements(alone, info)[std::size_t(8) * 17 + 8], 1.0F);
    mesh.flat({0, 0}, {16, 16}, 0);
    EXPECT_EQ(mesh.drawn(info).height({8 + thin / 2, 8}), 0);
}

TEST(DrawnSurface, triangles_without_area_or_with_nan_are_dropped) {
    const TerrainInfo info = terrain(9, 9);
    Mesh mesh;
    mesh.flat({0, 0}, {8, 8}, 1);
    const auto expected = displacements(mesh.drawn(info), info);
    for (const double bad : {std::nan(""), kInfinity, -kInfinity}) {
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 corner(4, 4, 4);
            corner[axis] = bad;
            mesh.triangle({1, 1, 9}, {7, 1, 9}, corner);
        }
    }
    mesh.triangle({1, 1, 9}, {7, 1, 9}, {1, 1, 9});
    mesh.triangle({1, 1, 9}, {2, 2, 9}, {3, 3, 9});
    mesh.triangle({3, 3, 1}, {3, 3, 2}, {3, 3, 4});
    const DrawnSurface surface = mesh.drawn(info);
    EXPECT_EQ(surface.triangle_count(), 2U);
    EXPECT_EQ(surface.skirt_triangle_count() + surface.wall_triangle_count(), 0U);
    EXPECT_EQ(displacements(surface, info), expected);
}

TEST(DrawnSurface, nothing_drawn_covers_nothing) {
    const TerrainInfo info = terrain(200, 130);
    Mesh outside;
    outside.flat({-50, -50}, {-1, 300}, 5);
    outside.quad({-5, 0, 0}, {-5, 9, 0}, {-5, 9, 9}, {-5, 0, 9});
    for (const Mesh& mesh : {Mesh(), outside}) {
        const DrawnSurface surface = mesh.drawn(info);
        EXPECT_EQ(surface.triangle_count(), 0U);
        EXPECT_EQ(surface.wall_triangle_count(), 0U);
        EXPECT_EQ(surface.height({0, 0}), std::nullopt);
        EXPECT_FALSE(surface.passes_below({1, 1, 1}, {0, 0, -1}, 0, kInfinity));
        EXPECT_FALSE(surface.meets_skirt({1, 1, 1}, {0, 0, -1}, 0, kInfinity));
        for (const float value : displacements(surface, info)) EXPECT_TRUE(std::isnan(value));
    }
}

TEST(DrawnSurface, one_huge_triangle_covers_all) {
    const TerrainInfo info = terrain(200, 130, 3, {1e6, 1e6});
    Mesh mesh;
    mesh.eye = {info.origin + 100.0, 50};
    for (const double size : {1e4, 1e12, 1e30}) {
        mesh.vertices.clear();
        mesh.triangle({-size, -size, 7}, {size, -size, 7}, {0, 2 * size, 7});
        if (size < 1e6) {
            for (glm::vec3& vertex : mesh.vertices) vertex += glm::vec3(1e6, 1e6, 0);
        }
        const DrawnSurface surface = mesh.drawn(info);
        EXPECT_EQ(surface.triangle_count(), 1U);
        for (const float value : displacements(surface, info, 3)) ASSERT_EQ(value, 4.0F);
        EXPECT_TRUE(surface.passes_below({info.origin, 6.9}, {1, 1, 0}, 0, 1));
    }
}

TEST(DrawnSurface, a_vertex_that_flew_away_does_not_cover_what_is_beside_its_triangle) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;
    mesh.triangle({0, 0, 0}, {0, 8, 0}, {1e30, 4, 0});
    const DrawnSurface surface = mesh.drawn(info);
    EXPECT_EQ(surface.height({8, 4}), 0);
    EXPECT_EQ(surface.height({8, 12}), std::nullopt);
}

TEST(DrawnSurface, spans_of_another_size_are_refused) {
    const TerrainInfo info = terrain(4, 5);
    const DrawnSurface surface = Mesh().drawn(info);
    std::vector<float> right(20);
    std::vector<float> wrong(19);
    EXPECT_THROW(surface.displacements(wrong, right), ContractError);
    EXPECT_THROW(surface.displacements(right, wrong), ContractError);
}

TEST(DrawnSurface, repeated_runs_and_many_threads_agree_to_the_bit) {
    Random random(8);
    const TerrainInfo info = terrain(257, 300, 1.5, {12345.6, -9876.5});
    Mesh mesh = soup(random, info, 500);
    mesh.quadtree(random, info.origin, 450, random.inside(info), hills, 2);
    const DrawnSurface first = mesh.drawn(info);
    const DrawnSurface second = mesh.drawn(info);
    const std::vector<float> expected = displacements(first, info);
    const auto same = [](float a, float b) {
        return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
    };
    std::array<char, 4> agree{};
    {
        std::vector<std::jthread> threads;
        for (std::size_t i = 0; i < agree.size(); ++i) {
            threads.emplace_back([&, i] {
                const DrawnSurface& surface = i % 2 == 0 ? first : second;
                const std::vector<float> found = displacements(surface, info);
                agree[i] = std::ranges::equal(found, expected, same) ? 1 : 0;
            });
        }
    }
    EXPECT_EQ(agree, (std::array<char, 4>{1, 1, 1, 1}));
}

}  // namespace
}  // namespace lodbench::measure
