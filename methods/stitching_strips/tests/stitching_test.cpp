// Triangles between two sides: whole, those of Algorithm 1 where that is valid, and fat.

#include "stitching_strips/stitching.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "stitching_strips/tess_coordinates.h"

namespace lodbench::stitching_strips {
namespace {

using Side = std::vector<double>;
/// Of vertices: left ones are 0, 1 ..., right ones -1, -2 ...
using Triangle = std::array<int, 3>;
using Triangles = std::multiset<Triangle>;

int left(std::size_t i) {
    return int(i);
}
int right(std::size_t i) {
    return -1 - int(i);
}
Triangle sorted(Triangle triangle) {
    std::ranges::sort(triangle);
    return triangle;
}

Triangles merged(const Side& l, const Side& r) {
    Triangles triangles;
    stitch(l, r, {0, l.size() - 1, 0, r.size() - 1}, [&](std::size_t i, std::size_t j, int side) {
        triangles.insert(sorted({left(i), right(j), side == 0 ? left(i + 1) : right(j + 1)}));
    });
    return triangles;
}

/// Algorithm 1 as it is printed: over each segment the vertex of the other side that is nearest to
/// the perpendicular bisector; of equally near ones the first.
Triangles printed(const Side& l, const Side& r) {
    Triangles triangles;
    const auto nearest = [](const Side& side, double middle) {
        std::size_t found = 0;
        for (std::size_t j = 1; j < side.size(); ++j) {
            if (std::abs(side[j] - middle) < std::abs(side[found] - middle)) found = j;
        }
        return found;
    };
    for (std::size_t i = 0; i + 1 < l.size(); ++i) {
        const std::size_t apex = nearest(r, (l[i] + l[i + 1]) / 2);
        triangles.insert(sorted({left(i), left(i + 1), right(apex)}));
    }
    for (std::size_t j = 0; j + 1 < r.size(); ++j) {
        const std::size_t apex = nearest(l, (r[j] + r[j + 1]) / 2);
        triangles.insert(sorted({right(j), right(j + 1), left(apex)}));
    }
    return triangles;
}

/// Each edge but the strip's own border is used twice.
bool whole(const Triangles& triangles, const Side& l, const Side& r) {
    std::map<std::pair<int, int>, int> uses;
    for (const Triangle& t : triangles) {
        for (const auto& [a, b] :
             {std::pair(t[0], t[1]), std::pair(t[1], t[2]), std::pair(t[0], t[2])})
            ++uses[{a, b}];
    }
    const auto border = [&](int a, int b) {
        const bool one_side = (a >= 0) == (b >= 0);
        const bool first = a == right(0) && b == left(0);
        const bool last = a == right(r.size() - 1) && b == left(l.size() - 1);
        return one_side || first || last;
    };
    return triangles.size() == l.size() + r.size() - 2 &&
           std::ranges::all_of(uses, [&](const auto& use) {
               return use.second == (border(use.first.first, use.first.second) ? 1 : 2);
           });
}

bool middles_tie(const Side& l, const Side& r) {
    std::set<double> middles;
    for (std::size_t i = 0; i + 1 < l.size(); ++i) middles.insert(l[i] + l[i + 1]);
    for (std::size_t j = 0; j + 1 < r.size(); ++j) {
        if (middles.contains(r[j] + r[j + 1])) return true;
    }
    return false;
}

Side random_side(std::mt19937& random) {
    std::set<double> places = {0, 1 << 20};
    const auto count = std::uniform_int_distribution<std::size_t>(2, 65)(random);
    while (places.size() < count) {
        places.insert(std::uniform_int_distribution<int>(1, (1 << 20) - 1)(random));
    }
    return {places.begin(), places.end()};
}
Side tessellated(float factor) {
    const std::vector<float> places = tess_coordinates(factor);
    return {places.begin(), places.end()};
}

TEST(Stitching, is_algorithm_1_where_that_is_valid_and_whole_where_it_is_not) {
    std::mt19937 random(7);
    int ties = 0, broken = 0;
    const auto check = [&](const Side& l, const Side& r) {
        const Triangles ours = merged(l, r), theirs = printed(l, r);
        ASSERT_TRUE(whole(ours, l, r));
        const bool tie = middles_tie(l, r);
        // Where no two middles are equal.
        ASSERT_EQ(whole(theirs, l, r), !tie);
        if (!tie) {
            ASSERT_EQ(ours, theirs);
        }
        ties += tie ? 1 : 0;
        broken += whole(theirs, l, r) ? 0 : 1;
    };
    for (int i = 0; i < 3000; ++i) check(random_side(random), random_side(random));
    EXPECT_LT(ties, 30) << "of random vertices";
    ties = broken = 0;
    for (const float l : {2.0F, 4.0F, 6.5F, 10.0F, 33.0F, 62.0F, 64.0F}) {
        for (const float r : {2.0F, 4.0F, 6.5F, 10.0F, 33.0F, 62.0F, 64.0F}) {
            check(tessellated(l), tessellated(r));
        }
    }
    EXPECT_GE(broken, 7) << "equal factors always tie";
    EXPECT_LT(broken, 49);
}

TEST(Stitching, of_stretches_is_that_of_the_strip) {
    std::mt19937 random(8);
    for (int i = 0; i < 200; ++i) {
        const Side l = random_side(random), r = random_side(random);
        std::vector<double> cuts = {0};
        while (cuts.back() < (1 << 20)) {
            cuts.push_back(cuts.back() + std::uniform_int_distribution<int>(1, 1 << 18)(random));
        }
        Triangles pieces;
        for (std::size_t cut = 0; cut + 1 < cuts.size(); ++cut) {
            const Stretch stretch = stretch_between(l, r, cuts[cut], cuts[cut + 1]);
            stitch(l, r, stretch, [&](std::size_t a, std::size_t b, int side) {
                pieces.insert(sorted({left(a), right(b), side == 0 ? left(a + 1) : right(b + 1)}));
            });
        }
        ASSERT_EQ(pieces, merged(l, r));
    }
}

/// Figure 8b: one of the left, one of the right; what is left over to the last vertex.
Triangles sequential(const Side& l, const Side& r) {
    Triangles triangles;
    std::size_t i = 0, j = 0;
    while (i + 1 < l.size() || j + 1 < r.size()) {
        const bool from_left = j + 1 == r.size() || (i + 1 < l.size() && i <= j);
        triangles.insert(sorted({left(i), right(j), from_left ? left(i + 1) : right(j + 1)}));
        ++(from_left ? i : j);
    }
    return triangles;
}

/// Degrees, in a strip of this width.
std::vector<double> least_angles(const Triangles& triangles, const Side& l, const Side& r,
                                 double width) {
    std::vector<double> angles;
    for (const Triangle& triangle : triangles) {
        std::array<glm::dvec2, 3> at;
        for (std::size_t i = 0; i < 3; ++i) {
            const int vertex = triangle[i];
            at[i] = vertex >= 0 ? glm::dvec2(0, l[std::size_t(vertex)])
                                : glm::dvec2(width, r[std::size_t(-1 - vertex)]);
        }
        double least = 180;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2 a = at[(i + 1) % 3] - at[i], b = at[(i + 2) % 3] - at[i];
            if (glm::length(a) == 0 || glm::length(b) == 0) continue;
            const double cosine =
                std::clamp(glm::dot(a, b) / glm::length(a) / glm::length(b), -1.0, 1.0);
            least = std::min(least, std::acos(cosine) * 180 / std::acos(-1));
        }
        angles.push_back(least);
    }
    std::ranges::sort(angles);
    return angles;
}

TEST(Stitching, makes_fatter_triangles_than_the_sequential_one) {
    // Blocks of 64 cells, strips of one.
    for (const auto& [one, other] : {std::pair(64.0F, 7.3F), std::pair(20.5F, 45.25F)}) {
        Side l = tessellated(one), r = tessellated(other);
        for (Side* side : {&l, &r}) {
            for (double& place : *side) place *= 64;
        }
        ASSERT_TRUE(whole(sequential(l, r), l, r));
        const auto ours = least_angles(merged(l, r), l, r, 1);
        const auto theirs = least_angles(sequential(l, r), l, r, 1);
        EXPECT_GT(ours[ours.size() / 2], 8);
        EXPECT_LT(theirs[theirs.size() / 2], ours[ours.size() / 2] / 2);
    }
}

}  // namespace
}  // namespace lodbench::stitching_strips
