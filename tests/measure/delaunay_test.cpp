// The triangulation that grows by samples: it stays one, every circle stays empty.

#include "measure/delaunay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "api/error.h"
#include "base/hash.h"

namespace lodbench::measure {
namespace {

std::int64_t twice_area(const Delaunay& delaunay, const Delaunay::Triangle& triangle) {
    const auto& v = delaunay.vertices();
    const auto &a = v[std::size_t(triangle.vertices[0])], &b = v[std::size_t(triangle.vertices[1])],
               &c = v[std::size_t(triangle.vertices[2])];
    return std::int64_t(b.x - a.x) * (c.y - a.y) - std::int64_t(b.y - a.y) * (c.x - a.x);
}

/// Whether a point lies strictly within a triangle's circle, by long double.
bool inside_circle(const Delaunay& delaunay, const Delaunay::Triangle& triangle,
                   const Delaunay::Vertex& p) {
    const auto& v = delaunay.vertices();
    const auto &a = v[std::size_t(triangle.vertices[0])], &b = v[std::size_t(triangle.vertices[1])],
               &c = v[std::size_t(triangle.vertices[2])];
    const long double d = 2.0L * twice_area(delaunay, triangle);
    const auto square = [&](const Delaunay::Vertex& q) {
        return (long double)(q.x - a.x) * (q.x - a.x) + (long double)(q.y - a.y) * (q.y - a.y);
    };
    const long double x = ((c.y - a.y) * square(b) - (b.y - a.y) * square(c)) / d + a.x;
    const long double y = ((b.x - a.x) * square(c) - (c.x - a.x) * square(b)) / d + a.y;
    const long double radius = (a.x - x) * (a.x - x) + (a.y - y) * (a.y - y);
    const long double distance = (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y);
    return distance < radius * (1 - 1e-12L);
}

void expect_a_delaunay_triangulation(const Delaunay& delaunay, int width, int height) {
    std::int64_t area = 0;
    std::map<std::pair<int, int>, int> owners;  // directed edge to triangle
    const auto& triangles = delaunay.triangles();
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const std::int64_t own = twice_area(delaunay, triangles[t]);
        EXPECT_GT(own, 0) << "counter-clockwise, with an area";
        area += own;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto edge =
                std::pair(triangles[t].vertices[(i + 1) % 3], triangles[t].vertices[(i + 2) % 3]);
            EXPECT_TRUE(owners.emplace(edge, int(t)).second) << "an edge has two sides";
        }
    }
    EXPECT_EQ(area, 2 * std::int64_t(width) * height) << "nothing overlaps, nothing is missing";
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto across = owners.find(
                std::pair(triangles[t].vertices[(i + 2) % 3], triangles[t].vertices[(i + 1) % 3]));
            EXPECT_EQ(triangles[t].neighbours[i], across == owners.end() ? -1 : across->second);
            if (across == owners.end()) continue;
            for (const std::int32_t vertex : triangles[std::size_t(across->second)].vertices) {
                EXPECT_FALSE(inside_circle(delaunay, triangles[t],
                                           delaunay.vertices()[std::size_t(vertex)]));
            }
        }
    }
}

std::int32_t triangle_of(const Delaunay& delaunay, const Delaunay::Vertex& point) {
    for (std::size_t t = 0; t < delaunay.triangles().size(); ++t) {
        if (delaunay.contains(std::int32_t(t), point)) return std::int32_t(t);
    }
    return -1;
}

TEST(Delaunay, stays_a_triangulation_with_empty_circles_whatever_the_order) {
    for (const auto& [width, height] : {std::pair{1, 1}, {7, 5}, {40, 3}, {30, 30}}) {
        for (std::uint64_t seed = 1; seed <= 8; ++seed) {
            base::SplitMix64 random(seed);
            Delaunay delaunay(width, height);
            std::set<std::pair<int, int>> used = {{0, 0}, {width, 0}, {width, height}, {0, height}};
            std::vector<std::int32_t> changed;
            for (int i = 0; i < 120; ++i) {
                const Delaunay::Vertex point{std::int32_t(random.below(std::uint64_t(width) + 1)),
                                             std::int32_t(random.below(std::uint64_t(height) + 1))};
                if (!used.insert({point.x, point.y}).second) continue;
                const auto before = delaunay.triangles();
                changed.clear();
                delaunay.insert(triangle_of(delaunay, point), point, changed);
                for (std::size_t t = 0; t < delaunay.triangles().size(); ++t) {
                    const bool same =
                        t < before.size() && before[t].vertices == delaunay.triangles()[t].vertices;
                    if (!same) {
                        EXPECT_NE(std::ranges::find(changed, std::int32_t(t)), changed.end());
                    }
                }
            }
            expect_a_delaunay_triangulation(delaunay, width, height);
            EXPECT_EQ(delaunay.vertices().size(), used.size());
        }
    }
}

TEST(Delaunay, every_sample_of_a_small_grid_gives_two_triangles_a_cell) {
    Delaunay delaunay(6, 4);
    std::vector<std::int32_t> changed;
    for (int y = 0; y <= 4; ++y) {
        for (int x = 0; x <= 6; ++x) {
            if ((x == 0 || x == 6) && (y == 0 || y == 4)) continue;
            delaunay.insert(triangle_of(delaunay, {x, y}), {x, y}, changed);
        }
    }
    EXPECT_EQ(delaunay.triangles().size(), 2U * 6 * 4);
    expect_a_delaunay_triangulation(delaunay, 6, 4);
}

TEST(Delaunay, predicates_are_exact_at_the_largest_size) {
    constexpr int kLargest = 1 << 15;
    Delaunay delaunay(kLargest, kLargest);
    std::vector<std::int32_t> changed;
    // Cocircular with the four corners, and a hair inside and outside of that.
    for (const Delaunay::Vertex point : {Delaunay::Vertex{kLargest / 2, 0},
                                         {kLargest / 2, 1},
                                         {kLargest - 1, kLargest / 2},
                                         {1, 1},
                                         {kLargest - 1, kLargest - 1},
                                         {kLargest / 2, kLargest / 2},
                                         {12345, 23456}}) {
        delaunay.insert(triangle_of(delaunay, point), point, changed);
    }
    expect_a_delaunay_triangulation(delaunay, kLargest, kLargest);
    EXPECT_THROW(Delaunay(kLargest + 1, 4), ContractError);
}

TEST(Delaunay, refuses_a_point_outside_the_triangle_or_on_a_corner) {
    Delaunay delaunay(4, 4);
    std::vector<std::int32_t> changed;
    EXPECT_THROW(delaunay.insert(0, {1, 3}, changed), ContractError);
    EXPECT_THROW(delaunay.insert(0, {4, 4}, changed), ContractError);
    EXPECT_EQ(delaunay.vertices().size(), 4U);
}

}  // namespace
}  // namespace lodbench::measure
