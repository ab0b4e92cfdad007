// The drawn surface: known answers, and every search against asking all triangles one by one.
#include "measure/drawn_surface.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "api/error.h"
#include "base/hash.h"
#include "measure/plan_triangle.h"

namespace lodbench::measure {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnit = 0x1p-24;

TerrainInfo terrain(int rows, int columns, double spacing = 1, glm::dvec2 origin = glm::dvec2(0)) {
    TerrainInfo info;
    info.rows = rows;
    info.columns = columns;
    info.spacing = glm::dvec2(spacing);
    info.origin = origin;
    return info;
}

class Random {
public:
    explicit Random(std::uint64_t seed) : numbers_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * double(numbers_.next() >> 11U) * 0x1p-53;
    }
    glm::dvec2 inside(const TerrainInfo& info) {
        const glm::dvec2 low = info.extent_min();
        const glm::dvec2 high = info.extent_max();
        return {between(low.x, high.x), between(low.y, high.y)};
    }
    std::uint64_t below(std::uint64_t bound) { return numbers_.below(bound); }

private:
    base::SplitMix64 numbers_;
};

using Height = std::function<double(double, double)>;

/// Collects triangles in world coordinates, as a capture from `eye` gives them.
struct Mesh {
    glm::dvec3 eye{0.0};
    std::vector<glm::vec3> vertices;

    void triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        for (const glm::dvec3& corner : {a, b, c}) vertices.emplace_back(corner - eye);
    }
    void quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
        triangle(a, b, c);
        triangle(a, c, d);
    }
    void rectangle(glm::dvec2 low, glm::dvec2 high, const Height& z) {
        const auto at = [&z](double x, double y) { return glm::dvec3(x, y, z(x, y)); };
        quad(at(low.x, low.y), at(high.x, low.y), at(high.x, high.y), at(low.x, high.y));
    }
    void flat(glm::dvec2 low, glm::dvec2 high, double z) {
        rectangle(low, high, [z](double, double) { return z; });
    }
    /// A square of cells^2 rectangles.
    void grid(glm::dvec2 low, double side, int cells, const Height& z) {
        const auto at = [&](int i) { return i * side / cells; };
        for (int row = 0; row < cells; ++row) {
            for (int column = 0; column < cells; ++column) {
                rectangle(low + glm::dvec2(at(column), at(row)),
                          low + glm::dvec2(at(column + 1), at(row + 1)), z);
            }
        }
    }
    /// A quadtree of squares, divided at random but more so near its centre; T-junctions and all.
    void quadtree(Random& random, glm::dvec2 low, double side, glm::dvec2 centre, const Height& z,
                  double least) {
        const double distance = glm::distance(low + side / 2, centre);
        if (side > least && side > distance * random.between(0.1, 0.6)) {
            const double half = side / 2;
            for (const glm::dvec2 corner : {glm::dvec2(0, 0), {half, 0}, {0, half}, {half, half}}) {
                quadtree(random, low + corner, half, centre, z, least);
            }
        } else {
            rectangle(low, low + side, z);
        }
    }
    [[nodiscard]] DrawnSurface drawn(const TerrainInfo& info) const {
        return {CapturedSurface{eye, vertices}, info};
    }
};

double hills(double x, double y) {
    return 5 * std::sin(x / 7) * std::cos(y / 5) + x / 10;
}

std::vector<float> displacements(const DrawnSurface& surface, const TerrainInfo& info,
                                 float height = 0) {
    const std::size_t count = std::size_t(info.rows) * std::size_t(info.columns);
    std::vector<float> result(count, -1.0F);
    surface.displacements(std::vector<float>(count, height), result);
    return result;
}

/// Asks every triangle, in extended precision and by another route than the code under test:
/// barycentric coordinates for points, half-planes for rays.
struct Oracle {
    using Real = long double;
    const Mesh& mesh;

    struct Answer {
        Real highest = -kInfinity;
        Real least_margin =
            kInfinity;  ///< of any barycentric coordinate: near 0 is for no one to say
    };

    [[nodiscard]] Answer height(const glm::dvec2& position) const {
        Answer answer;
        const Real x = Real(position.x) - Real(mesh.eye.x);
        const Real y = Real(position.y) - Real(mesh.eye.y);
        for (std::size_t i = 0; i < mesh.vertices.size(); i += 3) {
            const glm::vec3& a = mesh.vertices[i];
            const glm::vec3& b = mesh.vertices[i + 1];
            const glm::vec3& c = mesh.vertices[i + 2];
            const auto cross = [](Real ux, Real uy, Real vx, Real vy) { return ux * vy - uy * vx; };
            const Real area =
                cross(Real(b.x) - a.x, Real(b.y) - a.y, Real(c.x) - a.x, Real(c.y) - a.y);
            const Real u = cross(b.x - x, b.y - y, c.x - x, c.y - y) / area;
            const Real v = cross(c.x - x, c.y - y, a.x - x, a.y - y) / area;
            const Real w = 1 - u - v;
            const Real least = std::min({u, v, w});
            answer.least_margin = std::min(answer.least_margin, std::abs(least));
            if (least >= 0) {
                answer.highest =
                    std::max(answer.highest, u * a.z + v * b.z + w * c.z + Real(mesh.eye.z));
            }
        }
        return answer;
    }

    /// The greatest height of any triangle over the ray; not positive: the ray is nowhere below.
    [[nodiscard]] Real depth_below(const TerrainInfo& info, const glm::dvec3& origin,
                                   const glm::dvec3& direction, double from, double to) const {
        Real deepest = -kInfinity;
        const glm::dvec3 o = origin - mesh.eye;
        for (std::size_t i = 0; i < mesh.vertices.size(); i += 3) {
            Real begin = from;
            Real end = to;
            // Keeps the t with value + t * slope >= 0.
            const auto keep = [&](Real value, Real slope) {
                if (slope > 0) begin = std::max(begin, -value / slope);
                if (slope < 0) end = std::min(end, -value / slope);
                if (slope == 0 && value < 0) end = -kInfinity;
            };
            for (int axis = 0; axis < 2; ++axis) {
                keep(Real(origin[axis]) - info.extent_min()[axis], direction[axis]);
                keep(Real(info.extent_max()[axis]) - origin[axis], -Real(direction[axis]));
            }
            const std::array<glm::dvec3, 3> corner{mesh.vertices[i], mesh.vertices[i + 1],
                                                   mesh.vertices[i + 2]};
            const glm::dvec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
            const Real turn = normal.z < 0 ? -1 : 1;
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::dvec3& a = corner[k];
                const glm::dvec3& b = corner[(k + 1) % 3];
                keep(turn * ((Real(b.x) - a.x) * (Real(o.y) - a.y) -
                             (Real(b.y) - a.y) * (Real(o.x) - a.x)),
                     turn * ((Real(b.x) - a.x) * direction.y - (Real(b.y) - a.y) * direction.x));
            }
            if (begin > end) continue;
            for (const Real t : {begin, end}) {
                const Real x = o.x + t * direction.x - corner[0].x;
                const Real y = o.y + t * direction.y - corner[0].y;
                const Real plane = corner[0].z - (normal.x * x + normal.y * y) / normal.z;
                deepest = std::max(deepest, plane - (o.z + t * direction.z));
            }
        }
        return deepest;
    }
};

/// Overlapping triangles of all sizes, none of them steep.
Mesh soup(Random& random, const TerrainInfo& info, int count) {
    Mesh mesh;
    mesh.eye = {info.extent_min() + 3.25, 2.5};
    const double side = info.extent_max().x - info.extent_min().x;
    while (count > 0) {
        const double size = side * std::pow(2, random.between(-6, 1));
        std::array<glm::dvec3, 3> corners{};
        const glm::dvec2 middle = random.inside(info);
        for (glm::dvec3& corner : corners) {
            corner = {middle.x + random.between(-size, size),
                      middle.y + random.between(-size, size), random.between(-1, 1)};
        }
        const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (glm::length(glm::dvec2(normal)) > 8 * std::abs(normal.z)) continue;
        mesh.triangle(corners[0], corners[1], corners[2]);
        --count;
    }
    return mesh;
}

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

TEST(DrawnSurface, passes_below_is_what_asking_every_triangle_gives) {
    Random random(6);
    const TerrainInfo info = terrain(65, 65, 1, {1e5, -2e5});
    int below = 0;
    int above = 0;
    for (int trial = 0; trial < 30; ++trial) {
        Mesh mesh = soup(random, info, 1 + int(random.below(40)));
        if (trial % 2 == 0) {
            mesh.vertices.clear();
            mesh.quadtree(random, info.origin, 64, random.inside(info), hills, 1);
        }
        const DrawnSurface surface = mesh.drawn(info);
        for (int i = 0; i < 400; ++i) {
            const glm::dvec3 origin(random.inside(info) + random.between(-30, 30),
                                    random.between(-2, 12));
            glm::dvec3 direction(random.between(-1, 1), random.between(-1, 1),
                                 random.between(-0.3, 0.3));
            const std::uint64_t special = random.below(8);
            if (special < 3) direction[int(special)] = 0;
            if (special == 3) direction.x = direction.y = 0;
            const double from = random.between(0, 20);
            const double to =
                special == 4 && direction.z < 0 ? kInfinity : from + random.between(0, 60);
            const long double depth =
                Oracle{mesh}.depth_below(info, origin, direction, from, std::min(to, 1e6));
            if (std::abs(depth) < 1e-7L) continue;
            EXPECT_EQ(surface.passes_below(origin, direction, from, to), depth > 0)
                << "depth " << double(depth);
            ++(depth > 0 ? below : above);
        }
    }
    EXPECT_GT(below, 1000);
    EXPECT_GT(above, 1000);
}

TEST(DrawnSurface, a_ray_on_the_surface_is_not_below_it) {
    const TerrainInfo info = terrain(9, 9);
    Mesh mesh;
    mesh.rectangle({0, 0}, {8, 8}, [](double x, double) { return x; });
    const DrawnSurface surface = mesh.drawn(info);
    const double least = std::numeric_limits<double>::denorm_min();
    EXPECT_FALSE(surface.passes_below({0, 3, 0}, {1, 0, 1}, 0, 8));
    EXPECT_TRUE(surface.passes_below({0, 3, 0}, {1, 0, 0.999}, 0, 8));
    // Vertical: strict as well, from either side, finite or not.
    EXPECT_FALSE(surface.passes_below({4, 3, 10}, {0, 0, -1}, 0, 6));
    EXPECT_TRUE(surface.passes_below({4, 3, 10}, {0, 0, -1}, 0, 6.001));
    EXPECT_TRUE(surface.passes_below({4, 3, 10}, {0, 0, -1}, 0, kInfinity));
    EXPECT_TRUE(surface.passes_below({4, 3, 10}, {-least, 0, -1}, 0, kInfinity));
    EXPECT_FALSE(surface.passes_below({4, 3, 4}, {0, 0, 1}, 0, kInfinity));
    EXPECT_TRUE(surface.passes_below({4, 3, 3}, {0, 0, 1}, 0, kInfinity));
    EXPECT_FALSE(surface.passes_below({4, 3, 3}, {0, 0, 1}, 1, kInfinity));
    EXPECT_FALSE(surface.passes_below({9, 3, 3}, {0, 0, -1}, 0, kInfinity));
}

TEST(DrawnSurface, what_is_outside_the_extent_does_not_count_for_rays) {
    const TerrainInfo info = terrain(9, 9);
    Mesh mesh;
    mesh.flat({-100, -100}, {200, 200}, 5);
    const DrawnSurface surface = mesh.drawn(info);
    EXPECT_EQ(surface.height({8, 8}), 5);
    EXPECT_FALSE(surface.passes_below({-50, 4, 4}, {1, 0, 0}, 0, 49.9));
    EXPECT_TRUE(surface.passes_below({-50, 4, 4}, {1, 0, 0}, 0, 50.1));
    EXPECT_FALSE(surface.passes_below({-50, 4, 4}, {1, 0, 0}, 58.1, kInfinity));
    EXPECT_FALSE(surface.passes_below({-50, 9, 4}, {1, 0, 0}, 0, kInfinity));
    EXPECT_TRUE(surface.passes_below({-50, 8, 4}, {1, 0, 0}, 0, kInfinity));  // along the border
}

/// Skirts around each of four tiles of 8 m, `depth` deep, leaning outward by `lean`.
Mesh skirted(double depth, double lean, const glm::dvec3& eye) {
    Mesh mesh;
    mesh.eye = eye;
    for (const glm::dvec2 low : {glm::dvec2(0, 0), {8, 0}, {0, 8}, {8, 8}}) {
        mesh.grid(low, 8, 4, hills);
        const glm::dvec2 middle = low + 4.0;
        const std::array<glm::dvec2, 5> ring{low, low + glm::dvec2(8, 0), low + 8.0,
                                             low + glm::dvec2(0, 8), low};
        for (std::size_t side = 0; side < 4; ++side) {
            for (int i = 0; i < 4; ++i) {
                const auto top = [&](int step) {
                    const glm::dvec2 at = glm::mix(ring[side], ring[side + 1], step / 4.0);
                    return glm::dvec3(at, hills(at.x, at.y));
                };
                const auto bottom = [&](int step) {
                    const glm::dvec3 at = top(step);
                    const glm::dvec2 outward = glm::sign(glm::dvec2(at) - middle) *
                                               glm::step(3.9, glm::abs(glm::dvec2(at) - middle));
                    return at + glm::dvec3(lean * outward, -depth);
                };
                mesh.quad(top(i), top(i + 1), bottom(i + 1), bottom(i));
            }
        }
    }
    return mesh;
}

TEST(DrawnSurface, skirts_are_counted_and_are_no_part_of_it) {
    const TerrainInfo info = terrain(17, 17);
    for (const glm::dvec3& eye : {glm::dvec3(3.3, 4.7, 20), glm::dvec3(-3e4, 2e4, 5e3)}) {
        Mesh bare = skirted(3, 0, eye);
        const std::size_t skirts = 128;  // 4 tiles, 4 sides, 4 quads
        const DrawnSurface with = bare.drawn(info);
        EXPECT_EQ(with.skirt_triangle_count(), skirts);
        EXPECT_EQ(with.wall_triangle_count(), 0U);
        EXPECT_EQ(with.triangle_count(), 4U * 16U * 2U);
        // A hundredth of the depth outward, beyond rounding: at inner borders below the neighbour,
        // at the extent's border outside.
        const DrawnSurface leaning = skirted(3, 0.03, eye).drawn(info);
        EXPECT_EQ(leaning.skirt_triangle_count(), skirts);
        EXPECT_EQ(leaning.triangle_count(), with.triangle_count());
        Mesh tiles;
        tiles.eye = eye;
        for (const glm::dvec2 low : {glm::dvec2(0, 0), {8, 0}, {0, 8}, {8, 8}}) {
            tiles.grid(low, 8, 4, hills);
        }
        const DrawnSurface without = tiles.drawn(info);
        EXPECT_EQ(without.skirt_triangle_count(), 0U);
        const std::vector<float> expected = displacements(without, info);
        EXPECT_EQ(displacements(with, info), expected);
        EXPECT_EQ(displacements(leaning, info), expected);
    }
}

TEST(DrawnSurface, a_ray_meets_a_skirt_where_it_stands) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;
    mesh.flat({0, 0}, {16, 16}, 10);
    const glm::dvec3 eye(4, 8, 6);
    EXPECT_EQ(mesh.drawn(info).meets_skirt(eye, {1, 0, 0}, 0, 100), std::nullopt);
    mesh.quad({8, 0, 10}, {8, 16, 10}, {8, 16, 2}, {8, 0, 2});
    mesh.quad({12, 0, 10}, {12, 16, 10}, {12, 16, 2}, {12, 0, 2});
    const DrawnSurface surface = mesh.drawn(info);
    ASSERT_EQ(surface.skirt_triangle_count(), 4U);
    EXPECT_EQ(surface.meets_skirt(eye, {1, 0, 0}, 0, 100), 4);
    EXPECT_EQ(surface.meets_skirt(eye, {2, 0, 0}, 0, kInfinity), 2);
    EXPECT_EQ(surface.meets_skirt(eye, {1, 0, 0}, 4.5, 100), 8);
    EXPECT_EQ(surface.meets_skirt(eye, {1, 0, 0}, 0, 3.9), std::nullopt);
    EXPECT_EQ(surface.meets_skirt(eye, {-1, 0, 0}, 0, 100), std::nullopt);
    EXPECT_EQ(surface.meets_skirt(eye, {1, 0, -2}, 0, 100), std::nullopt);  // below
    EXPECT_EQ(surface.meets_skirt(eye, {0, 0, 1}, 0, kInfinity), std::nullopt);
    EXPECT_EQ(surface.meets_skirt({8, 8, 6}, {0, 0, 1}, 0, kInfinity), std::nullopt);  // edge-on
}

TEST(DrawnSurface, no_ray_slips_between_the_triangles_of_a_skirt) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;
    mesh.eye = {0.1, 0.2, 0.3};
    mesh.flat({0, 0}, {16, 16}, 10);
    const glm::dvec3 top(8.1, 16, 10);
    const glm::dvec3 bottom(8.1, 0, 2);
    mesh.quad(bottom, {8.1, 16, 2}, top, {8.1, 0, 10});
    const DrawnSurface surface = mesh.drawn(info);
    ASSERT_EQ(surface.skirt_triangle_count(), 2U);
    Random random(7);
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 eye(random.between(0, 7), random.between(1, 15), random.between(2, 10));
        const glm::dvec3 target =
            glm::mix(bottom, top, random.between(0.01, 0.99));  // the diagonal
        const auto met = surface.meets_skirt(eye, target - eye, 0, 2);
        ASSERT_TRUE(met);
        EXPECT_NEAR(*met, 1, 1e-6);  // float32 corners, metres away
    }
}

TEST(DrawnSurface, a_filler_at_a_t_junction_is_a_skirt) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;
    mesh.flat({0, 0}, {8, 16}, 0);
    for (const double middle : {1.0, -1.0}) {  // the fine side rises above the coarse one, or sags
        Mesh closed = mesh;
        const glm::dvec3 junction(8, 8, middle);
        closed.triangle({8, 0, 0}, {16, 0, 0}, junction);
        closed.triangle({16, 0, 0}, {16, 16, 0}, junction);
        closed.triangle({16, 16, 0}, {8, 16, 0}, junction);
        closed.triangle({8, 0, 0}, junction, {8, 16, 0});
        const DrawnSurface surface = closed.drawn(info);
        EXPECT_EQ(surface.skirt_triangle_count(), 1U);
        EXPECT_EQ(surface.height({8, 8}), std::max(middle, 0.0));
        EXPECT_TRUE(surface.meets_skirt({4, 7, middle / 2}, {1, 0, 0}, 0, 10));
    }
}

TEST(DrawnSurface, the_riser_of_a_step_is_part_of_it) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;  // what a full grid draws of a cliff of 1000 m
    mesh.grid({0, 0}, 16, 16, [](double x, double) { return x < 7.5 ? 0 : 1000; });
    const DrawnSurface surface = mesh.drawn(info);
    EXPECT_EQ(surface.skirt_triangle_count(), 0U);
    EXPECT_EQ(surface.wall_triangle_count(), 0U);
    EXPECT_EQ(surface.triangle_count(), 512U);
    EXPECT_NEAR(*surface.height({7.25, 3.5}), 250, 1e-9);
    EXPECT_TRUE(surface.passes_below({7.5, 0, 499}, {0, 1, 0}, 0, 16));
    EXPECT_FALSE(surface.passes_below({7.5, 0, 501}, {0, 1, 0}, 0, 16));
}

TEST(DrawnSurface, spikes_and_pits_of_one_sample_are_part_of_it) {
    const TerrainInfo info = terrain(17, 17);
    for (const double z : {500.0, -500.0}) {
        Mesh mesh;
        mesh.grid({0, 0}, 16, 16, [z](double x, double y) { return x == 5 && y == 9 ? z : 0; });
        const DrawnSurface surface = mesh.drawn(info);
        EXPECT_EQ(surface.triangle_count(), 512U);
        EXPECT_EQ(surface.height({5, 9}), z);
        EXPECT_NEAR(*surface.height({5.5, 9}), z / 2, 1e-9);
    }
}

TEST(DrawnSurface, a_skirt_that_hangs_from_a_riser_is_a_skirt) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;
    mesh.grid({0, 0}, 16, 16, [](double x, double) { return x < 7.5 ? 0 : 1000; });
    mesh.quad({7, 16, 0}, {8, 16, 1000}, {8, 16, 990}, {7, 16, -10});
    EXPECT_EQ(mesh.drawn(info).skirt_triangle_count(), 2U);
}

TEST(DrawnSurface, a_wall_that_stands_above_is_in_neither) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;
    mesh.flat({0, 0}, {16, 16}, 0);
    mesh.quad({8, 0, 5}, {8, 16, 5}, {8, 16, 0}, {8, 0, 0});
    const DrawnSurface surface = mesh.drawn(info);
    EXPECT_EQ(surface.wall_triangle_count(), 2U);
    EXPECT_EQ(surface.skirt_triangle_count(), 0U);
    EXPECT_EQ(surface.triangle_count(), 2U);
    EXPECT_EQ(surface.height({8, 8}), 0);
    EXPECT_FALSE(surface.passes_below({0, 8, 1}, {1, 0, 0}, 0, 16));
    EXPECT_FALSE(surface.meets_skirt({0, 8, 1}, {1, 0, 0}, 0, 16));
}

TEST(DrawnSurface, a_vertical_triangle_over_nothing_is_a_wall) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;
    mesh.quad({8, 0, 5}, {8, 16, 5}, {8, 16, 0}, {8, 0, 0});
    const DrawnSurface surface = mesh.drawn(info);
    EXPECT_EQ(surface.wall_triangle_count(), 2U);
    EXPECT_EQ(surface.height({8, 8}), std::nullopt);
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
