// Rays that meet the true surface: against every triangle solved one by one, and closed forms.

#include "measure/reference_terrain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "reference_oracle.h"

namespace lodbench::measure {
namespace {

using namespace test;

enum class Aim { kDown, kLevel, kUpward, kAlongRow, kAlongColumn, kDiagonal, kThroughSamples };

struct Ray {
    glm::dvec3 origin, direction;
    double from = 0;
};

Ray random_ray(const Ground& ground, Aim aim, base::SplitMix64& random) {
    const int last_row = ground.info.rows - 1;
    const int last_column = ground.info.columns - 1;
    const auto [low, high] = std::ranges::minmax(ground.heights);
    const double relief = double(high) - double(low);
    const auto inside = [&](double z) {
        return ground.point(uniform(random, 0, last_column), uniform(random, 0, last_row), z);
    };
    const auto around = [&](double z) {
        return ground.point(uniform(random, -0.5, 1.5) * last_column,
                            uniform(random, -0.5, 1.5) * last_row, z);
    };
    const int row = int(random.below(std::uint64_t(last_row) + 1));
    const int column = int(random.below(std::uint64_t(last_column) + 1));
    glm::dvec3 from;
    glm::dvec3 to;
    switch (aim) {
        case Aim::kDown:
            from = around(high + uniform(random, 0, 3) * relief);
            to = inside(uniform(random, low, high));
            break;
        case Aim::kLevel:
            from = around(uniform(random, low, high));
            to = inside(uniform(random, low, high));
            break;
        case Aim::kUpward:
            from = around(low - uniform(random, 0, 3) * relief);
            to = inside(uniform(random, low, high));
            break;
        case Aim::kAlongRow:
            from = ground.point(uniform(random, -1, last_column + 1), row,
                                uniform(random, low, high + relief));
            to = ground.point(uniform(random, 0, last_column), row, uniform(random, low, high));
            break;
        case Aim::kAlongColumn:
            from = ground.point(column, uniform(random, -1, last_row + 1),
                                uniform(random, low, high + relief));
            to = ground.point(column, uniform(random, 0, last_row), uniform(random, low, high));
            break;
        case Aim::kDiagonal: {
            const double length = uniform(random, 1, 5);
            const double side = random.below(2) == 0 ? 1 : -1;
            from = ground.point(column - length, row - side * length,
                                uniform(random, low, high + relief));
            to = ground.point(column, row, uniform(random, low, high));
            break;
        }
        case Aim::kThroughSamples:
            from = around(uniform(random, low, high + relief));
            to = ground.point(column, row, uniform(random, low, high));
            break;
    }
    const double length = std::exp(uniform(random, -3, 3));
    return {from, (to - from) * length,
            random.below(2) == 0 ? 0 : uniform(random, 0, 1.2) / length};
}

// Both sides round positions near 1e7 m to 2e-9 m, which a grazing ray stretches; in the grids near
// the origin the agreement is a thousand times better.
TEST(ReferenceTerrain, cast_agrees_with_every_triangle_solved) {
    base::SplitMix64 random(11);
    std::array<int, 4> count{};
    int differ = 0;
    for (const Ground& ground : grounds()) {
        const ReferenceTerrain terrain = ground.terrain();
        const bool far = glm::length(ground.info.origin) > 0;
        for (const Aim aim : {Aim::kDown, Aim::kLevel, Aim::kUpward, Aim::kAlongRow,
                              Aim::kAlongColumn, Aim::kDiagonal, Aim::kThroughSamples}) {
            for (int i = 0; i < 500; ++i) {
                const Ray ray = random_ray(ground, aim, random);
                const OracleHit expected =
                    solve(ground, oracle_ray(ground, ray.origin, ray.direction, ray.from));
                const ReferenceHit hit = terrain.cast(ray.origin, ray.direction, ray.from);
                SCOPED_TRACE(testing::Message() << ground.info.rows << " x " << ground.info.columns
                                                << " aim " << int(aim) << " ray " << i);
                ++count[std::size_t(expected.side)];
                ASSERT_LE(hit.possible, hit.certain);
                ASSERT_GE(hit.possible, ray.from);
                const double tolerance = (far ? 1e-6 : 1e-9) / glm::length(ray.direction);
                if (expected.possible == Real(kInfinity)) {
                    ASSERT_EQ(hit.possible, kInfinity);
                } else {
                    ASSERT_NEAR(hit.possible, double(expected.possible), tolerance);
                }
                if (expected.certain == Real(kInfinity)) {
                    ASSERT_EQ(hit.certain, kInfinity);
                } else {
                    ASSERT_NEAR(hit.certain, double(expected.certain), tolerance);
                }
                if (hit.possible < hit.certain) ++differ;
            }
        }
    }
    // The rays that the name promises were there.
    EXPECT_GT(count[std::size_t(Side::kAbove)], 3000);
    EXPECT_GT(count[std::size_t(Side::kBetween)], 300);
    EXPECT_GT(count[std::size_t(Side::kBelow)], 3000);
    EXPECT_GT(count[std::size_t(Side::kOutside)], 300);
    EXPECT_GT(differ, 5000);
}

// Nothing leaks between cells: whatever way a ray takes to a point under the ground, over samples,
// along edges or along diagonals, it has met the ground by there.
TEST(ReferenceTerrain, no_ray_from_above_reaches_a_point_under_the_ground) {
    base::SplitMix64 random(12);
    for (const Ground& ground : grounds()) {
        const ReferenceTerrain terrain = ground.terrain();
        const double relief = *std::ranges::max_element(ground.heights);
        for (int i = 0; i < 3000; ++i) {
            const double halves_east =
                double(random.below(std::uint64_t(2 * ground.info.columns - 1))) / 2;
            const double halves_south =
                double(random.below(std::uint64_t(2 * ground.info.rows - 1))) / 2;
            const glm::dvec2 place = ground.place(halves_east, halves_south);
            const glm::dvec3 target(place, terrain.interval(place).low - 1e-6 * relief);
            // From inside the extent: from outside it may come in under the ground.
            glm::dvec3 from(ground.place(double(random.below(std::uint64_t(ground.info.columns))),
                                         double(random.below(std::uint64_t(ground.info.rows)))),
                            relief + double(random.below(3)));
            if (random.below(4) == 0) from = {place.x, from.y, from.z};
            if (random.below(4) == 0) from = {from.x, place.y, from.z};
            ASSERT_LE(terrain.cast(from, target - from, 0).certain, 1) << i;
        }
    }
}

TEST(ReferenceTerrain, plane_is_met_at_the_analytic_place) {
    const Ground ground = make_ground(33, 40, [](int, int) { return 12.5; }, {30, 7}, {1e7, 2e6});
    const ReferenceTerrain terrain = ground.terrain();
    base::SplitMix64 random(13);
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 from = ground.point(uniform(random, -50, 90), uniform(random, -50, 90),
                                             12.5 + uniform(random, 0.1, 1000));
        const glm::dvec3 target =
            ground.point(uniform(random, 0.01, 38.99), uniform(random, 0.01, 31.99), 12.5);
        const glm::dvec3 direction = 0.37 * (target - from);
        const double expected = (12.5 - from.z) / direction.z;
        const ReferenceHit hit = terrain.cast(from, direction, 0);
        ASSERT_NEAR(hit.possible, expected, 1e-12 * expected);
        ASSERT_NEAR(hit.certain, expected, 1e-12 * expected);
    }
}

TEST(ReferenceTerrain, ramp_is_met_at_the_analytic_place_from_both_sides) {
    // Heights are multiples of 1/8 and exact: z = x/4 - y/8 + 3 with spacings 2 and 4.
    const Ground ground = make_ground(
        20, 31, [](int row, int column) { return 0.5 * column - 0.5 * (19 - row) + 3; }, {2, 4});
    const ReferenceTerrain terrain = ground.terrain();
    const auto above = [](const glm::dvec3& p) { return p.z - (p.x / 4 - p.y / 8 + 3); };
    base::SplitMix64 random(14);
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 target =
            ground.point(uniform(random, 0.01, 29.99), uniform(random, 0.01, 18.99), 0);
        const glm::dvec3 on(target.x, target.y, -above(target));
        // Inside the extent, so that a start under the plane is one under the ground.
        glm::dvec3 from = ground.point(uniform(random, 0, 30), uniform(random, 0, 19), 0);
        from.z = -above(from) + (i % 2 == 0 ? 1 : -1) * uniform(random, 1, 50);
        const double expected = above(from) / (above(from) - above(from + (on - from)));
        const ReferenceHit hit = terrain.cast(from, on - from, 0);
        ASSERT_NEAR(hit.possible, expected, 1e-12);
        ASSERT_NEAR(hit.certain, expected, 1e-12);
    }
}

// The raised sample's cells: along the diagonal towards it the one triangulation rises from the far
// corner, the other from the middle. Across it both give a ridge or a lone peak.
TEST(ReferenceTerrain, one_raised_sample_is_met_as_its_two_triangulations_say) {
    const Ground ground =
        make_ground(9, 9, [](int row, int column) { return row == 4 && column == 4 ? 8 : 0; });
    const ReferenceTerrain terrain = ground.terrain();
    for (const auto& [east, south] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const ReferenceHit hit =
            terrain.cast(ground.point(4 - 10 * east, 4 - 10 * south, 4), {east, -south, 0}, 0);
        EXPECT_DOUBLE_EQ(hit.possible, 9.5)
            << "along a line of samples the diagonals do not matter";
        EXPECT_DOUBLE_EQ(hit.certain, 9.5);
    }
    for (const auto& [east, south] : {std::pair{1, 1}, {-1, 1}, {1, -1}, {-1, -1}}) {
        const ReferenceHit hit =
            terrain.cast(ground.point(4 - 10 * east, 4 - 10 * south, 4), {east, -south, 0}, 0);
        EXPECT_DOUBLE_EQ(hit.possible, 9.5);
        EXPECT_DOUBLE_EQ(hit.certain, 9.75);
    }
    // Level with the peak: touched, and just over it: missed.
    for (const glm::dvec3 direction : {glm::dvec3(1, 0, 0), {0, 1, 0}, {1, 1, 0}, {1, -1, 0}}) {
        const glm::dvec3 peak = ground.point(4, 4, 8);
        EXPECT_EQ(terrain.cast(peak - 16.0 * direction, direction, 0).certain, 16);
        EXPECT_EQ(
            terrain.cast(peak - 16.0 * direction + glm::dvec3(0, 0, 1e-9), direction, 0).possible,
            kInfinity);
    }
    EXPECT_EQ(terrain.cast(ground.point(4, 4, 10), {0, 0, -2}, 0).possible, 1);
}

TEST(ReferenceTerrain, sphere_cap_is_met_within_its_chord_error) {
    constexpr double kRadius = 500;
    const Ground ground = make_ground(65, 65,
                                      [](int row, int column) {
                                          const double x = 10.0 * (column - 32);
                                          const double y = 10.0 * (row - 32);
                                          return std::sqrt(kRadius * kRadius - x * x - y * y);
                                      },
                                      {10, 10});
    const ReferenceTerrain terrain = ground.terrain();
    const glm::dvec3 centre(ground.place(32, 32), 0);
    // A cell's diagonal is a chord of 10 sqrt(2) m; the far corners slope by 65 degrees at most.
    const double sagitta = kRadius - std::sqrt(kRadius * kRadius - 50 / 0.18);
    base::SplitMix64 random(15);
    for (int i = 0; i < 2000; ++i) {
        const double angle = uniform(random, 0, 2 * std::numbers::pi);
        const glm::dvec3 from =
            centre + glm::dvec3(400 * std::cos(angle), 400 * std::sin(angle), 600);
        const glm::dvec3 target = ground.point(uniform(random, 16, 48), uniform(random, 16, 48), 0);
        const glm::dvec3 direction = target - from;
        const ReferenceHit hit = terrain.cast(from, direction, 0);
        ASSERT_LE(hit.possible, hit.certain);
        // Inside the sphere by no more than the chord, plus the samples' rounding to float.
        for (const double t : {hit.possible, hit.certain}) {
            const double distance = glm::length(from + t * direction - centre);
            ASSERT_LE(distance, kRadius + 1e-4);
            ASSERT_GE(distance, kRadius - sagitta - 1e-4);
        }
    }
}

TEST(ReferenceTerrain, step_is_met_on_its_one_steep_column_of_cells) {
    const Ground ground = make_ground(7, 12, [](int, int column) { return column >= 5 ? 100 : 0; });
    const ReferenceTerrain terrain = ground.terrain();
    for (const double row : {0.0, 0.3, 2.0, 3.5, 6.0}) {
        const ReferenceHit hit = terrain.cast(ground.point(-2, row, 25), {1, 0, 0}, 0);
        EXPECT_DOUBLE_EQ(hit.possible, 6.25);
        EXPECT_DOUBLE_EQ(hit.certain, 6.25);
        const ReferenceHit back = terrain.cast(ground.point(11, row, 25), {-1, 0, 0}, 0);
        EXPECT_DOUBLE_EQ(back.certain, 6.75) << "met from below where it enters under the plateau";
    }
}

TEST(ReferenceTerrain, from_below_the_envelopes_change_their_roles) {
    const Ground ground =
        make_ground(9, 9, [](int row, int column) { return row == 4 && column == 4 ? 8 : 0; });
    const ReferenceTerrain terrain = ground.terrain();
    // Inside the peak and out along the diagonal, where low is left before high.
    const ReferenceHit hit = terrain.cast(ground.point(4, 4, 4), {1, 1, 0}, 0);
    EXPECT_DOUBLE_EQ(hit.possible, 0.25);
    EXPECT_DOUBLE_EQ(hit.certain, 0.5);
    const ReferenceHit up = terrain.cast(ground.point(3.5, 3.5, -1), {0, 0, 1}, 0);
    EXPECT_DOUBLE_EQ(up.possible, 1);
    EXPECT_DOUBLE_EQ(up.certain, 5);
}

TEST(ReferenceTerrain, there_are_neither_walls_nor_a_bottom) {
    const Ground ground = make_ground(9, 9, [](int, int) { return 100; });
    const ReferenceTerrain terrain = ground.terrain();
    EXPECT_EQ(terrain.cast({-5, 4, 50}, {1, 0, 0}, 0).possible, kInfinity);
    EXPECT_EQ(terrain.cast({4, 4, 50}, {0, 0, -1}, 0).possible, kInfinity);
    const ReferenceHit entering = terrain.cast({-10, 4, 50}, {1, 0.0, 4}, 0);
    EXPECT_EQ(entering.possible, 12.5) << "from below, 2.5 m after it entered at the side";
    EXPECT_EQ(entering.certain, 12.5);
}

TEST(ReferenceTerrain, a_start_between_the_envelopes_is_a_possible_meeting) {
    const Ground ground = make_ground(2, 2, [](int row, int column) { return row == column; });
    const ReferenceTerrain terrain = ground.terrain();
    // In the middle: 1 along the diagonal nw-se, 0 along the other.
    const ReferenceHit down = terrain.cast(ground.point(0.5, 0.5, 0.5), {0, 0, -1}, 0);
    EXPECT_EQ(down.possible, 0);
    EXPECT_EQ(down.certain, 0.5);
    const ReferenceHit up = terrain.cast(ground.point(0.5, 0.5, 0.5), {0, 0, 1}, 0);
    EXPECT_EQ(up.possible, 0);
    EXPECT_EQ(up.certain, kInfinity);
    const ReferenceHit level = terrain.cast(ground.point(0.5, 0.5, 0.5), {1, -1, 0}, 0);
    EXPECT_EQ(level.possible, 0);
    EXPECT_EQ(level.certain, 0.25) << "x + y - 1 = 1/2";
    const ReferenceHit later = terrain.cast(ground.point(0.5, 0.5, 2), {0, 0, -1}, 1.5);
    EXPECT_EQ(later.possible, 1.5);
    EXPECT_EQ(later.certain, 2);
}

TEST(ReferenceTerrain, vertical_rays_measure_the_interval) {
    base::SplitMix64 random(16);
    for (const Ground& ground : grounds()) {
        const ReferenceTerrain terrain = ground.terrain();
        for (int i = 0; i < 200; ++i) {
            const glm::dvec2 place = ground.place(uniform(random, 0, ground.info.columns - 1),
                                                  uniform(random, 0, ground.info.rows - 1));
            const HeightInterval truth = terrain.interval(place);
            const ReferenceHit down = terrain.cast({place, 1000}, {0, 0, -1}, 0);
            ASSERT_NEAR(1000 - down.possible, truth.high, 1e-12 * 1000);
            ASSERT_NEAR(1000 - down.certain, truth.low, 1e-12 * 1000);
            const ReferenceHit up = terrain.cast({place, -1000}, {0, 0, 2}, 0);
            ASSERT_NEAR(-1000 + 2 * up.possible, truth.low, 1e-12 * 1000);
            ASSERT_NEAR(-1000 + 2 * up.certain, truth.high, 1e-12 * 1000);
            ASSERT_EQ(terrain.cast({place, 1000}, {0, 0, 1}, 0).possible, kInfinity);
        }
        for (int row = 0; row < ground.info.rows; ++row) {
            for (int column = 0; column < ground.info.columns; ++column) {
                const glm::dvec3 sample = terrain.sample(row, column);
                const ReferenceHit hit =
                    terrain.cast(sample + glm::dvec3(0, 0, 512), {0, 0, -1}, 0);
                // Positions near 1e7 m are off by up to 2e-9 m, 1e-8 of the narrowest cell.
                ASSERT_NEAR(hit.possible, 512, 1e-6) << row << " " << column;
                ASSERT_NEAR(hit.certain, 512, 1e-6) << row << " " << column;
            }
        }
    }
}

// Spacings that round: the border is not the origin plus a representable number of cells.
TEST(ReferenceTerrain, heights_within_a_radius_are_bounded_and_on_a_ramp_as_its_slope_says) {
    base::SplitMix64 random(5);
    TerrainInfo info;
    info.rows = 9;
    info.columns = 12;
    info.spacing = {2, 3};
    std::vector<float> rough, ramp;
    for (int row = 0; row < info.rows; ++row) {
        for (int column = 0; column < info.columns; ++column) {
            rough.push_back(float(uniform(random, -500, 500)));
            ramp.push_back(float(8 * column));  // 4 m a metre eastward
        }
    }
    const ReferenceTerrain terrain(rough, info);
    for (int round = 0; round < 2000; ++round) {
        const glm::dvec2 centre(uniform(random, -1, 23), uniform(random, -1, 25));
        const double radius = std::exp2(uniform(random, -12, 4));
        const HeightInterval bounds = terrain.interval_within(centre, radius);
        for (int i = 0; i < 20; ++i) {
            const double angle = uniform(random, 0, 2 * std::numbers::pi);
            const double distance = uniform(random, 0, radius);
            const HeightInterval there =
                terrain.interval(centre + distance * glm::dvec2(std::cos(angle), std::sin(angle)));
            EXPECT_LE(bounds.low, there.low + 1e-9);
            EXPECT_GE(bounds.high, there.high - 1e-9);
        }
    }
    const HeightInterval bounds = ReferenceTerrain(ramp, info).interval_within({11, 10}, 0.25);
    EXPECT_NEAR(bounds.low, 44 - 1, 1e-9);
    EXPECT_NEAR(bounds.high, 44 + 1, 1e-9);
}

TEST(ReferenceTerrain, the_border_is_part_of_the_ground_and_nothing_beyond_it) {
    for (int i = 0; i < 100; ++i) {
        const glm::dvec2 spacing(0.1 + 0.01 * i, 0.3 + 0.07 * i);
        const Ground ground =
            make_ground(8, 12, [](int, int) { return 0; }, spacing, {1e7 + 0.1 * i, -1e7});
        const ReferenceTerrain terrain = ground.terrain();
        const glm::dvec2 low = ground.info.extent_min();
        const glm::dvec2 high = ground.info.extent_max();
        for (const glm::dvec2 corner : {low, high, glm::dvec2(low.x, high.y), {high.x, low.y}}) {
            ASSERT_EQ(terrain.cast({corner, 4}, {0, 0, -1}, 0).certain, 4) << i;
            const glm::dvec2 inward = (low + high) * 0.5 - corner;
            ASSERT_EQ(terrain.cast({corner, 1}, {inward.x, 0, -1}, 0).certain, 1)
                << i << ": along the border";
            ASSERT_EQ(terrain.cast({corner, 1}, {0, inward.y, -1}, 0).certain, 1) << i;
            ASSERT_EQ(terrain.cast({corner - inward * 1.5, 4}, {inward, -4}, 0).possible, kInfinity)
                << i << ": ends half a side outside";
        }
        const glm::dvec2 outside = low - 1e-6;
        ASSERT_EQ(terrain.cast({outside.x, low.y, 2}, {0, 0, -1}, 0).possible, kInfinity);
        ASSERT_EQ(terrain.cast({outside.x, low.y, 2}, {0, 1, -1}, 0).possible, kInfinity);
        ASSERT_EQ(terrain.cast({high.x, outside.y, 2}, {-1, 0, -1}, 0).possible, kInfinity);
    }
}

TEST(ReferenceTerrain, hits_scale_with_the_direction_and_start_at_from) {
    const Ground ground = make_ground(9, 9, [](int, int column) { return column == 4 ? 2 : 0; });
    const ReferenceTerrain terrain = ground.terrain();
    const glm::dvec3 eye = ground.point(-4, 3.3, 1);
    for (const double length : {1e-200, 1e-9, 1.0, 1e9, 1e200}) {
        const glm::dvec3 direction(length, 0, 0);
        EXPECT_DOUBLE_EQ(terrain.cast(eye, direction, 0).certain * length, 7.5);
        const double from = 8 / length;
        EXPECT_DOUBLE_EQ(terrain.cast(eye, direction, from).certain * length, 8.5)
            << "it starts inside the ridge and leaves it";
        EXPECT_EQ(terrain.cast(eye, direction, 9 / length).certain, kInfinity);
    }
}

TEST(ReferenceTerrain, rays_without_a_sensible_way_end_without_a_hit) {
    const Ground ground = random_ground(33, 17, 5);
    const ReferenceTerrain terrain = ground.terrain();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(terrain.cast({nan, 0, 9}, {1, 1, -1}, 0).possible, kInfinity);
    EXPECT_EQ(terrain.cast({3, 3, 9}, {nan, 1, -1}, 0).possible, kInfinity);
    EXPECT_EQ(terrain.cast({3, 3, nan}, {1, 1, -1}, 0).possible, kInfinity);
    EXPECT_EQ(terrain.cast({3, 3, 9}, {1, 1, nan}, 0).possible, kInfinity);
    EXPECT_EQ(terrain.cast({3, 3, 9}, {1, 1, -1}, kInfinity).possible, kInfinity);
    EXPECT_EQ(terrain.cast({1e300, 3, 9}, {-1, 0, 0}, 0).possible, kInfinity);
    const double low = terrain.interval({3.2, 3.7}).low;
    const double denormal = std::numeric_limits<double>::denorm_min();
    EXPECT_DOUBLE_EQ(terrain.cast({3.2, 3.7, 9}, {denormal, -denormal, -1}, 0).certain, 9 - low);
    EXPECT_DOUBLE_EQ(terrain.cast({3.2, 3.7, 9}, {1e-260, -1e-30, -1}, 0).certain, 9 - low);
}

}  // namespace
}  // namespace lodbench::measure
