// Speed against accuracy: which points no other beats, and how much of the plane they command.

#include "report/trade.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "api/error.h"
#include "base/hash.h"
#include "results/json.h"

namespace lodbench::report {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const double kNan = std::nan("");

using Points = std::vector<TradePoint>;

TEST(ParetoFront, of_nothing_is_nothing_and_of_one_point_that_point) {
    EXPECT_THAT(pareto_front(Points{}), IsEmpty());
    EXPECT_THAT(pareto_front(Points{{3, 4}}), ElementsAre(0));
}

TEST(ParetoFront, holds_what_no_other_beats_by_rising_cost) {
    EXPECT_THAT(pareto_front(Points{{5, 1}, {1, 5}, {3, 3}, {4, 4}, {2, 6}}), ElementsAre(1, 2, 0));
}

TEST(ParetoFront, a_tie_in_one_is_decided_by_the_other) {
    EXPECT_THAT(pareto_front(Points{{1, 5}, {1, 4}, {2, 4}, {2, 3}}), ElementsAre(1, 3));
}

TEST(ParetoFront, equal_points_are_all_on_it_or_none) {
    EXPECT_THAT(pareto_front(Points{{2, 2}, {1, 3}, {2, 2}, {2, 2}}), ElementsAre(1, 0, 2, 3));
    EXPECT_THAT(pareto_front(Points{{2, 2}, {2, 2}, {1, 1}}), ElementsAre(2));
}

TEST(ParetoFront, what_was_not_measured_is_never_on_it) {
    EXPECT_THAT(pareto_front(Points{{kNan, 1}, {1, kNan}, {0, kInfinity}, {kInfinity, 0}, {9, 9}}),
                ElementsAre(4));
    EXPECT_THAT(pareto_front(Points{{kInfinity, kInfinity}, {kNan, kNan}}), IsEmpty());
}

TEST(ParetoFront, of_many_points_is_what_the_definition_says) {
    base::SplitMix64 random(5);
    for (int round = 0; round < 200; ++round) {
        Points points;
        for (std::uint64_t i = 0, count = random.below(12); i < count; ++i) {
            const auto coordinate = [&] {
                const std::uint64_t value = random.below(9);
                return value == 8 ? kNan : value == 7 ? kInfinity : double(value);
            };
            const double cost = coordinate();
            points.push_back({cost, coordinate()});
        }
        std::vector<std::size_t> expected;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const TradePoint& p = points[i];
            if (!std::isfinite(p.cost) || !std::isfinite(p.error)) continue;
            bool beaten = false;
            for (const TradePoint& q : points) {
                if (!std::isfinite(q.cost) || !std::isfinite(q.error)) continue;
                beaten = beaten || (q.cost <= p.cost && q.error <= p.error &&
                                    (q.cost < p.cost || q.error < p.error));
            }
            if (!beaten) expected.push_back(i);
        }
        EXPECT_THAT(pareto_front(points), testing::UnorderedElementsAreArray(expected));
    }
}

TEST(ParetoFront, what_cannot_be_measured_decides_nothing) {
    EXPECT_THAT(pareto_front(Points{{10, 0.00009868}, {10, 0.00009983}}), ElementsAre(0, 1));
    EXPECT_THAT(pareto_front(Points{{10, 0.00009868}, {9, 0.00009983}}), ElementsAre(1))
        << "the faster of two that err alike";
    EXPECT_THAT(pareto_front(Points{{10, 1}, {11, 1, 2, 0.5}}), ElementsAre(0, 1))
        << "the interval of the second reaches from 9 to 11.5";
    EXPECT_THAT(pareto_front(Points{{10, 1}, {11, 1, 0.5, 2}}), ElementsAre(0));
    EXPECT_THAT(pareto_front(Points{{10, 2}, {11, 1, 2, 2}}), ElementsAre(1))
        << "nearer to the truth, and no slower as far as can be told";
    EXPECT_THAT(pareto_front(Points{{10, 1}, {11, 1, 1, 0}}), ElementsAre(0, 1))
        << "intervals that touch overlap";
}

TEST(ParetoFront, a_row_of_overlaps_does_not_lead_away_from_what_is_surely_faster) {
    const Points row = {{10, 3, 1, 1}, {11.5, 2, 1, 1}, {13, 1, 1, 1}};
    EXPECT_TRUE(beats(row[1], row[0]) && beats(row[2], row[1]) && !beats(row[2], row[0]));
    EXPECT_THAT(pareto_front(row), ElementsAre(0, 2));
}

/// Points on and off the resolution, with intervals, equal ones, and some that were not measured.
Points random_points(base::SplitMix64& random) {
    Points points;
    for (std::uint64_t i = 0, count = random.below(14); i < count; ++i) {
        const auto step = [&](std::uint64_t steps) { return double(random.below(steps)); };
        TradePoint point{10 + step(12) / 2, step(40) * kErrorResolution / 4, step(4) / 2,
                         step(4) / 2};
        if (random.below(12) == 0) point.error = kInfinity;
        points.push_back(point);
        if (random.below(4) == 0) points.push_back(point);
    }
    return points;
}

TEST(ParetoFront, of_points_with_intervals_beats_all_others_and_none_of_its_own) {
    base::SplitMix64 random(17);
    std::size_t decided = 0;
    for (int round = 0; round < 2000; ++round) {
        const Points points = random_points(random);
        const auto front = pareto_front(points);
        const auto on_front = [&](std::size_t i) { return std::ranges::count(front, i) == 1; };
        bool measured = false;
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_FALSE(beats(points[i], points[i]));
            const bool finite = std::isfinite(points[i].error);
            measured = measured || finite;
            const bool beaten = std::ranges::any_of(
                front, [&](std::size_t j) { return beats(points[j], points[i]); });
            EXPECT_EQ(on_front(i), finite && !beaten);
            for (std::size_t j = 0; j < i; ++j) {
                EXPECT_FALSE(beats(points[i], points[j]) && beats(points[j], points[i]));
                const bool equal =
                    std::tuple(points[i].cost, points[i].error, points[i].below, points[i].above) ==
                    std::tuple(points[j].cost, points[j].error, points[j].below, points[j].above);
                EXPECT_TRUE(!equal || on_front(i) == on_front(j));
            }
        }
        EXPECT_EQ(front.empty(), !measured);
        decided += points.size() - front.size();
    }
    EXPECT_GT(decided, 1000U);
}

TEST(ParetoFront, does_not_depend_on_the_order_of_the_points) {
    base::SplitMix64 random(23);
    for (int round = 0; round < 500; ++round) {
        const Points points = random_points(random);
        std::vector<std::size_t> order(points.size());
        std::iota(order.begin(), order.end(), 0);
        for (std::size_t i = order.size(); i > 1; --i)
            std::swap(order[i - 1], order[random.below(i)]);
        Points shuffled;
        for (const std::size_t i : order) shuffled.push_back(points[i]);
        std::vector<std::size_t> front;
        for (const std::size_t i : pareto_front(shuffled)) front.push_back(order[i]);
        EXPECT_THAT(front, testing::UnorderedElementsAreArray(pareto_front(points)));
    }
}

TEST(TradePoint, has_the_interval_of_its_repetitions) {
    const std::vector<double> runs = {10, 14, 11};
    const TradePoint point = trade_point(runs, 2.0, 1);
    EXPECT_EQ(point.cost, 11);
    EXPECT_EQ(point.below, 1);
    EXPECT_EQ(point.above, 3);
    EXPECT_EQ(trade_point(std::vector<double>{}, 2.0, 1).cost, kInfinity);
    EXPECT_EQ(trade_point(runs, std::nullopt, 1).error, kInfinity);
}

TEST(Hypervolume, of_one_point_is_its_rectangle) {
    EXPECT_DOUBLE_EQ(hypervolume(Points{{4, 1}}, {8, 2}), 0.25);
    EXPECT_DOUBLE_EQ(hypervolume(Points{{0, 0}}, {8, 2}), 1.0);
    EXPECT_EQ(hypervolume(Points{}, {8, 2}), 0.0);
}

TEST(Hypervolume, of_steps_is_their_union) {
    // (1, 3): 3 x 1, (2, 2): 2 x 1, (3, 1): 1 x 1 of 4 x 4; (3, 3) adds nothing.
    EXPECT_DOUBLE_EQ(hypervolume(Points{{2, 2}, {3, 1}, {3, 3}, {1, 3}, {2, 2}}, {4, 4}), 6.0 / 16);
}

TEST(Hypervolume, leaves_out_what_lies_beyond_the_reference_or_was_not_measured) {
    EXPECT_DOUBLE_EQ(
        hypervolume(Points{{2, 2}, {5, 0}, {0, 5}, {kNan, 0}, {0, kInfinity}, {-1, 0}}, {4, 4}),
        0.25);
    EXPECT_THROW((void)hypervolume(Points{}, {0, 1}), ContractError);
    EXPECT_THROW((void)hypervolume(Points{}, {1, kInfinity}), ContractError);
}

TEST(MethodTrades, count_the_front_of_all_and_end_with_all_together) {
    const std::map<std::string, Points> methods = {
        {"a", {{1, 3}, {3, 2}}}, {"b", {{2, 2}}}, {"c", {{kInfinity, 1}}}};
    const auto trades = method_trades(methods, {4, 4});
    ASSERT_EQ(trades.size(), 4U);
    EXPECT_EQ(trades[0].method, "a");
    EXPECT_EQ(trades[0].settings, 2U);
    EXPECT_EQ(trades[0].on_front, 1U);
    EXPECT_DOUBLE_EQ(trades[0].hypervolume, 4.0 / 16);  // 3 x 1 and 1 x 1
    EXPECT_EQ(trades[1].on_front, 1U);
    EXPECT_DOUBLE_EQ(trades[1].hypervolume, 4.0 / 16);
    EXPECT_EQ(trades[2].settings, 1U);
    EXPECT_EQ(trades[2].on_front, 0U);
    EXPECT_EQ(trades[2].hypervolume, 0.0);
    EXPECT_EQ(trades[3].method, "all");
    EXPECT_EQ(trades[3].settings, 4U);
    EXPECT_EQ(trades[3].on_front, 2U);
    EXPECT_DOUBLE_EQ(trades[3].hypervolume, 5.0 / 16);
}

TEST(ReferencePoint, is_a_tenth_beyond_the_worst_that_was_measured) {
    const auto reference = reference_point(Points{{10, 2}, {5, 4}, {99, kInfinity}});
    ASSERT_TRUE(reference.has_value());
    EXPECT_DOUBLE_EQ(reference->cost, 11);
    EXPECT_DOUBLE_EQ(reference->error, 4.4);
    EXPECT_FALSE(reference_point(Points{{1, kInfinity}}).has_value());
    EXPECT_FALSE(reference_point(Points{{1, 0}}).has_value());
}

results::CellRecord cell(const std::string& method, double tau, int repetition,
                         const std::string& error, double frame_ms) {
    const Json::Value json = results::parse_json(
        R"({"cell":"x","scenario":"s","method":")" + method + R"(","params":{"tau":)" +
            std::to_string(tau) + R"(},"repetition":)" + std::to_string(repetition) +
            R"(,"status":"ok","pixel_error_px":)" + error + R"(,"frame_ms":{"mean":)" +
            std::to_string(frame_ms) + R"(},"triangles":{"mean":100},"gpu_bytes":1048576,)" +
            R"("prepare_s":null})",
        "a cell");
    return results::read_cell(json, "a cell");
}

TEST(TradeRows, take_medians_of_repetitions_and_mark_the_front_within_a_scenario) {
    std::vector<results::CellRecord> cells = {
        cell("m", 4, 0, R"({"p999":4,"max":"inf"})", 10), cell("m", 4, 1, "null", 14),
        cell("m", 4, 2, "null", 12), cell("m", 1, 0, R"({"p999":1,"max":8})", 30),
        cell("n", 1, 0, R"({"p999":5,"max":6})", 20)};
    results::CellRecord failed = cell("n", 2, 0, "null", 0);
    failed.status = results::CellStatus::failed;
    failed.reason = "out of luck";
    cells.push_back(failed);
    results::CellRecord elsewhere = cell("n", 1, 0, R"({"p999":50,"max":60})", 200);
    elsewhere.scenario = "t";
    cells.push_back(elsewhere);
    const auto rows = trade_rows(cells, {{"m", "tau"}}, results::ErrorMetric::p999, 1);
    ASSERT_EQ(rows.size(), 5U);
    EXPECT_EQ(rows[0].label, "m tau=1");
    EXPECT_EQ(rows[1].label, "m tau=4");
    EXPECT_EQ(rows[1].knob, 4.0);
    EXPECT_EQ(rows[1].error, 4.0);
    EXPECT_EQ(rows[1].frame_ms->centre, 12.0);
    EXPECT_TRUE(rows[0].on_front);
    EXPECT_TRUE(rows[1].on_front);
    EXPECT_FALSE(rows[2].on_front) << "m at 4 is faster and better";
    EXPECT_FALSE(rows[2].knob.has_value()) << "no knob is known of n";
    EXPECT_FALSE(rows[3].on_front);
    EXPECT_THAT(rows[3].failures, ElementsAre("failed (repetition 0): out of luck"));
    EXPECT_TRUE(rows[4].on_front) << "another scenario, another front";
    const std::string text =
        trade_text_with_hypervolumes(rows, results::ErrorMetric::p999, TradePoint{40, 10});
    EXPECT_THAT(text, HasSubstr("out of luck"));
    // (12, 4) and (30, 1) of 40 x 10: 28 x 6 and 10 x 3.
    EXPECT_THAT(text, HasSubstr("| m      |      0.4950 |"));
    const std::string table = trade_text(rows, results::ErrorMetric::p999);
    EXPECT_THAT(table, HasSubstr("out of luck"));
    EXPECT_THAT(table, testing::Not(HasSubstr("ypervolume")));
    const auto largest = trade_rows(cells, {}, results::ErrorMetric::max, 1);
    EXPECT_EQ(largest[1].error, kInfinity);
    EXPECT_FALSE(largest[1].on_front) << "uncovered ground is no error to trade";
}

TEST(TradeRows, an_asynchronous_method_is_judged_by_what_its_pace_showed) {
    results::CellRecord one = cell("m", 1, 0, R"({"p999":1})", 10);
    one.pixel_error_realtime_px.emplace();
    one.pixel_error_realtime_px->p999 = 3.5;
    EXPECT_EQ(results::pixel_error(one, results::ErrorMetric::p999), 3.5);
    one.pixel_error_realtime_px.reset();
    EXPECT_EQ(results::pixel_error(one, results::ErrorMetric::p999), 1.0);
    EXPECT_EQ(results::pixel_error(one, results::ErrorMetric::rms), std::nullopt);
}

}  // namespace
}  // namespace lodbench::report
