// Student's t and Welch's test against printed tables.

#include <gtest/gtest.h>

#include <array>

#include "trend/t_test.h"

namespace lodbench::trend {
namespace {

TEST(StudentT, has_the_two_sided_quantiles_of_the_tables) {
    struct Row {
        double t;
        int degrees;
        double p;
    };
    // Abramowitz and Stegun, table 26.10, three decimals of t.
    for (const Row& row : {Row{12.706, 1, 0.05}, Row{4.303, 2, 0.05}, Row{3.182, 3, 0.05},
                           Row{2.228, 10, 0.05}, Row{2.042, 30, 0.05}, Row{63.657, 1, 0.01},
                           Row{4.587, 10, 0.001}, Row{3.646, 30, 0.001}, Row{3.460, 60, 0.001}}) {
        // Half of t's last printed digit moves p by less than a thousandth of itself.
        EXPECT_NEAR(student_p(row.t, row.degrees), row.p, 1.2e-3 * row.p) << row.degrees;
        EXPECT_EQ(student_p(-row.t, row.degrees), student_p(row.t, row.degrees));
    }
    EXPECT_EQ(student_p(0, 5), 1);
}

TEST(WelchTest, agrees_with_the_density_integrated) {
    // Means 20.82 and 22.99, t = -2.4554, 24.99 degrees of freedom: Student's density with 24,
    // summed over 200,000 stretches, leaves 0.0216999661 outside. With 24.99 it is 0.02138.
    const std::array a = {27.5, 21.0, 19.0, 23.6, 17.0, 17.9, 16.9, 20.1,
                          21.9, 22.6, 23.1, 19.6, 19.0, 21.7, 21.4};
    const std::array b = {27.1, 22.0, 20.8, 23.4, 23.4, 23.5, 25.8, 22.0,
                          24.8, 20.2, 21.9, 22.1, 22.9, 20.5, 24.4};
    EXPECT_NEAR(welch_p(spread_of(a), spread_of(b)), 0.0216999661, 1e-8);
}

TEST(WelchTest, of_groups_without_spread_is_certain) {
    const std::array low = {1.0, 1.0};
    const std::array high = {2.0, 2.0};
    EXPECT_EQ(welch_p(spread_of(low), spread_of(high)), 0);
    EXPECT_EQ(welch_p(spread_of(low), spread_of(low)), 1);
}

}  // namespace
}  // namespace lodbench::trend
