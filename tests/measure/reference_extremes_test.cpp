// The reference itself at the extremes at which methods are judged by it: against long double over
// heights that no terrain has, and to the bit wherever the world is moved or scaled exactly.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <string>

#include "measure/reference_terrain.h"
#include "reference_oracle.h"

namespace lodbench::measure {
namespace {

using namespace test;

struct Relief {
    const char* name;
    std::function<double(int, int)> height;
};

double noise(int row, int column) {
    return double(base::mix64(std::uint64_t(row) * 1009 + std::uint64_t(column)) >> 11U) * 0x1p-53;
}

std::vector<Relief> reliefs() {
    return {{"flat at zero", [](int, int) { return 0.0; }},
            {"flat at 1e6 m", [](int, int) { return 1e6; }},
            {"a range of 1e-4 m", [](int r, int c) { return 1e-4 * noise(r, c); }},
            {"a range of 1e5 m", [](int r, int c) { return 1e5 * noise(r, c); }},
            {"a needle", [](int r, int c) { return r == 8 && c == 8 ? 1e4 : 0.0; }},
            {"a pit", [](int r, int c) { return r == 8 && c == 8 ? -1e4 : 0.0; }},
            {"a checkerboard", [](int r, int c) { return (r + c) % 2 == 0 ? 0.0 : 1e4; }},
            {"negative only", [](int r, int c) { return -9000 - 500 * noise(r, c); }},
            {"terraces", [](int r, int c) { return 50 * std::floor(10 * noise(r / 3, c / 4)); }}};
}

constexpr int kSize = 17;

Ground ground_of(const Relief& relief) {
    return make_ground(kSize, kSize, relief.height, {10, 10});
}

struct Ray {
    glm::dvec3 from, direction;
};

/// From above the ground to a place of it; coordinates are whole multiples of 2^-10 m.
Ray ray_over(const Ground& ground, base::SplitMix64& random) {
    const auto rounded = [](const glm::dvec3& p) { return glm::round(p * 1024.0) / 1024.0; };
    const auto [low, high] = std::ranges::minmax(ground.heights);
    const double above = double(high) + 1 + 100 * uniform(random, 0, 1);
    const glm::dvec3 from = rounded(
        ground.point(uniform(random, -2, kSize + 1), uniform(random, -2, kSize + 1), above));
    const glm::dvec3 to = rounded(ground.point(uniform(random, 0.1, kSize - 1.1),
                                               uniform(random, 0.1, kSize - 1.1), double(low)));
    return {from, to - from};
}

/// Metres in height by which a meeting misses both triangulations, in long double: 0 where it lies
/// between them.
Real miss(const Ground& ground, const Ray& ray, double t) {
    const Real u = (Real(ray.from.x) + Real(t) * Real(ray.direction.x) - ground.info.origin.x) / 10;
    const Real v = kSize - 1 -
                   (Real(ray.from.y) + Real(t) * Real(ray.direction.y) - ground.info.origin.y) / 10;
    const Real z = Real(ray.from.z) + Real(t) * Real(ray.direction.z);
    const int column = std::clamp(int(std::floor(u)), 0, kSize - 2);
    const int row = std::clamp(int(std::floor(v)), 0, kSize - 2);
    const Real a = u - column;
    const Real b = v - row;
    const Real nw = ground.at(row, column), ne = ground.at(row, column + 1),
               sw = ground.at(row + 1, column), se = ground.at(row + 1, column + 1);
    const Real falling =
        a > b ? nw + a * (ne - nw) + b * (se - ne) : nw + b * (sw - nw) + a * (se - sw);
    const Real rising = a + b < 1 ? nw + a * (ne - nw) + b * (sw - nw)
                                  : se + (1 - a) * (sw - se) + (1 - b) * (ne - se);
    const Real low = std::min(falling, rising);
    const Real high = std::max(falling, rising);
    return std::max({Real(0), low - z, z - high});
}

TEST(ReferenceAtTheExtremes, meets_the_ground_where_long_double_has_it) {
    base::SplitMix64 random(31);
    for (const Relief& relief : reliefs()) {
        const Ground ground = ground_of(relief);
        const ReferenceTerrain terrain = ground.terrain();
        const auto [low, high] = std::ranges::minmax(ground.heights);
        // The parameter of a meeting is a double: 2^-53 of the ray's rise, a few operations, and
        // across a cell the ground rises by all of its relief.
        const double reach = std::max(std::abs(double(low)), std::abs(double(high))) +
                             double(high) - double(low) + 300;
        const double allowed = 0x1p-45 * reach * (1 + (double(high) - double(low)) / 10);
        int met = 0;
        for (int i = 0; i < 2000; ++i) {
            const Ray ray = ray_over(ground, random);
            const ReferenceHit hit = terrain.cast(ray.from, ray.direction, 0);
            const OracleHit expected =
                solve(ground, oracle_ray(ground, ray.from, ray.direction, 0));
            SCOPED_TRACE(testing::Message() << relief.name << ", ray " << i);
            ASSERT_EQ(std::isfinite(hit.possible), std::isfinite(double(expected.possible)));
            ASSERT_EQ(std::isfinite(hit.certain), std::isfinite(double(expected.certain)));
            if (!std::isfinite(hit.certain)) continue;
            ++met;
            ASSERT_LE(double(miss(ground, ray, hit.possible)), allowed);
            ASSERT_LE(double(miss(ground, ray, hit.certain)), allowed);
        }
        EXPECT_GT(met, 1000) << relief.name;
    }
}

void expect_near(double a, double b, double allowed) {
    if (std::isinf(a) || std::isinf(b)) {
        EXPECT_EQ(a, b);
    } else {
        EXPECT_NEAR(a, b, allowed);
    }
}

/// Meetings in a copy of the world, moved east and south by `origin` and then times `scale`,
/// against those in the world as it is.
void compare_meetings(const Relief& relief, double origin, double scale) {
    SCOPED_TRACE(testing::Message() << relief.name << " at " << origin << " m times " << scale);
    const Ground ground = ground_of(relief);
    Ground changed = ground;
    changed.info.spacing *= scale;
    changed.info.origin = {origin, -origin};
    for (float& height : changed.heights) height = float(double(height) * scale);
    const ReferenceTerrain terrain = ground.terrain();
    const ReferenceTerrain changed_terrain = changed.terrain();
    const auto [low, high] = std::ranges::minmax(ground.heights);
    const double slope = 1 + (double(high) - double(low)) / 10;
    base::SplitMix64 random(32);
    for (int i = 0; i < 200; ++i) {
        const Ray ray = ray_over(ground, random);
        const ReferenceHit hit = terrain.cast(ray.from, ray.direction, 0);
        const ReferenceHit again = changed_terrain.cast(
            ray.from * scale + glm::dvec3(origin, -origin, 0), ray.direction * scale, 0);
        // A place so far out is known to 2^-53 of the distance, a few times over, which a cliff
        // stretches. Without a shift every bit is the same.
        const double metres = 0x1p-49 * origin * slope;
        const double allowed = metres / glm::length(ray.direction);
        expect_near(hit.possible, again.possible, allowed);
        expect_near(hit.certain, again.certain, allowed);
        if (testing::Test::HasFailure()) return;
    }
}

TEST(ReferenceAtTheExtremes, a_world_far_from_the_origin_is_met_at_the_same_places) {
    for (const Relief& relief : reliefs()) {
        for (const double origin : {1e4, 1e6, 6.4e6, 1e7, 1e9}) compare_meetings(relief, origin, 1);
    }
}

TEST(ReferenceAtTheExtremes, a_world_times_a_power_of_two_is_met_at_the_same_places_to_the_bit) {
    for (const Relief& relief : reliefs()) {
        for (const int exponent : {-20, -1, 10, 20}) {
            compare_meetings(relief, 0, std::ldexp(1.0, exponent));
        }
    }
}

}  // namespace
}  // namespace lodbench::measure
