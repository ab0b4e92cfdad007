// The Pareto front against its definition, and on inputs chosen to be hard.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "report/trade.h"

namespace lodbench::report {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAreArray;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<std::size_t> front(const std::vector<TradePoint>& points) {
    return pareto_front(points);
}

TEST(ParetoFront, of_nothing_is_empty_and_of_one_point_that_point) {
    EXPECT_THAT(front({}), IsEmpty());
    EXPECT_THAT(front({{3, 4}}), ElementsAre(0));
}

TEST(ParetoFront, is_in_order_of_cost_without_what_is_dominated) {
    EXPECT_THAT(front({{4, 1}, {2, 2}, {3, 3}, {1, 5}, {4, 1.5}}), ElementsAre(3, 1, 0));
}

TEST(ParetoFront, a_tie_in_one_coordinate_is_decided_by_the_other) {
    EXPECT_THAT(front({{1, 3}, {1, 2}}), ElementsAre(1));
    EXPECT_THAT(front({{2, 1}, {1, 1}}), ElementsAre(1));
}

TEST(ParetoFront, equal_points_stand_on_it_together_or_not_at_all) {
    EXPECT_THAT(front({{2, 2}, {1, 3}, {2, 2}, {3, 3}, {3, 3}, {2, 2}}), ElementsAre(1, 0, 2, 5));
}

TEST(ParetoFront, what_was_not_measured_is_never_on_it_and_hides_nothing) {
    EXPECT_THAT(front({{kNaN, 0},
                       {0, kNaN},
                       {-kInfinity, 0},
                       {0, -kInfinity},
                       {kInfinity, 0},
                       {0, kInfinity},
                       {5, 5}}),
                ElementsAre(6));
    EXPECT_THAT(front({{kNaN, kNaN}}), IsEmpty());
}

TEST(ParetoFront, is_what_the_definition_says_of_random_points_with_many_ties) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> coordinate(0, 9);
    for (int round = 0; round < 500; ++round) {
        std::vector<TradePoint> points(std::size_t(round % 40));
        for (TradePoint& point : points) {
            point = {double(coordinate(random)), double(coordinate(random))};
            if (coordinate(random) == 0) point.error = kNaN;
        }
        std::vector<std::size_t> expected;
        for (std::size_t i = 0; i < points.size(); ++i) {
            bool dominated = std::isnan(points[i].error);
            for (const TradePoint& other : points) {
                dominated =
                    dominated || (other.cost <= points[i].cost && other.error <= points[i].error &&
                                  (other.cost < points[i].cost || other.error < points[i].error));
            }
            if (!dominated) expected.push_back(i);
        }
        EXPECT_THAT(front(points), UnorderedElementsAreArray(expected));
    }
}

}  // namespace
}  // namespace lodbench::report
