// Knobs: the values of a sweep, and the search for the one that meets a target.

#include "run/knob.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace lodbench::run {
namespace {

using testing::ElementsAre;

const Knob kTau{"tau", false, 0.01, 1000, 1};
const Knob kGrid{"grid", true, 2, 2048, 240};
constexpr double kTolerance = 0.05;

/// Asserts what every search promises of its probes.
SearchResult searched(const Knob& knob, double target,
                      const std::function<std::optional<double>(double)>& measure,
                      int most_probes = 16) {
    SearchResult result = search_knob(knob, target, kTolerance, most_probes, measure);
    std::set<double> asked;
    for (const Probe& probe : result.probes) {
        EXPECT_GE(probe.knob, knob.minimum);
        EXPECT_LE(probe.knob, knob.maximum);
        EXPECT_TRUE(asked.insert(probe.knob).second) << probe.knob << " asked twice";
        EXPECT_EQ(probe.knob, knob.admitted(probe.knob));
    }
    EXPECT_LE(int(result.probes.size()), most_probes);
    return result;
}

TEST(Knob, sweep_doubles_around_the_default_within_the_range) {
    EXPECT_THAT(sweep_values(kTau, 5), ElementsAre(0.25, 0.5, 1, 2, 4));
    EXPECT_THAT(sweep_values(kTau, 2), ElementsAre(1, 2));
    EXPECT_THAT(sweep_values(kGrid, 9), ElementsAre(15, 30, 60, 120, 240, 480, 960, 1920));
    EXPECT_THAT(sweep_values({"few", true, 1, 3, 2}, 5), ElementsAre(2));
    EXPECT_THAT(sweep_values({"linear", false, -5, 5, 0}, 3), ElementsAre(-1, 0, 1));
}

TEST(Knob, values_are_written_as_the_parameter_reads_them) {
    EXPECT_EQ(kTau.text(kTau.admitted(0.123456789)), "0.1235");
    EXPECT_EQ(kTau.text(kTau.admitted(1e9)), "1000");
    EXPECT_EQ(kGrid.text(kGrid.admitted(99.6)), "100");
    EXPECT_EQ(kGrid.admitted(0), 2);
}

TEST(Knob, is_the_numeric_parameter_that_the_descriptor_names) {
    MethodInfo method;
    EXPECT_FALSE(quality_knob(method));
    method.params = {{"tau", ParamType::real, 1, 0.01, 100, "", {}, ""},
                     {"mode", ParamType::choice, 0, 0, 0, "a", {"a", "b"}, ""}};
    method.quality_knob = "tau";
    ASSERT_TRUE(quality_knob(method));
    EXPECT_EQ(quality_knob(method)->maximum, 100);
    method.quality_knob = "mode";
    EXPECT_FALSE(quality_knob(method));
}

TEST(KnobSearch, meets_targets_of_rising_and_falling_measures_over_decades) {
    for (const double target : {0.02, 0.3, 1.0, 7.0, 90.0}) {
        const auto rising = searched(kTau, target, [](double tau) { return 0.8 * tau; });
        EXPECT_EQ(rising.outcome, SearchOutcome::met) << target;
        EXPECT_NEAR(*rising.best->value, target, kTolerance * target);
        EXPECT_TRUE(rising.monotone);
        const auto falling =
            searched(kTau, target, [](double tau) { return 3 / std::sqrt(tau) + 0.001; });
        if (target > 0.1 && target < 30) {
            EXPECT_EQ(falling.outcome, SearchOutcome::met) << target;
        }
    }
    const auto grid = searched(kGrid, 3.0, [](double rows) { return 3500 / rows; });
    EXPECT_EQ(grid.outcome, SearchOutcome::met);
    EXPECT_NEAR(*grid.best->value, 3.0, 0.15);
}

TEST(KnobSearch, needs_few_probes_where_error_goes_like_the_knob) {
    const auto result = searched(kTau, 40, [](double tau) { return 0.9 * std::pow(tau, 0.95); });
    EXPECT_EQ(result.outcome, SearchOutcome::met);
    EXPECT_LE(result.probes.size(), 6U);
}

TEST(KnobSearch, says_unreachable_with_the_best_there_is_after_two_steps_the_wrong_way) {
    const auto above = searched(kTau, 5, [](double tau) { return std::min(tau, 3.0); });
    EXPECT_EQ(above.outcome, SearchOutcome::unreachable);
    EXPECT_EQ(above.best->value, 3.0);
    for (const Probe& probe : above.probes) EXPECT_GE(probe.knob, 1.0 / 16);
    const auto below = searched(kGrid, 1, [](double rows) { return 3500 / rows; });
    EXPECT_EQ(below.outcome, SearchOutcome::unreachable);
    EXPECT_EQ(below.best->knob, 2048);
    const auto flat = searched(kTau, 5, [](double) { return 2.0; });
    EXPECT_EQ(flat.outcome, SearchOutcome::unreachable);
    EXPECT_EQ(flat.best->value, 2.0);
}

TEST(KnobSearch, goes_the_other_way_where_the_first_led_nearer_and_not_there) {
    const auto result = searched(kTau, 8, [](double tau) { return tau >= 4 ? 48.0 : 145 * tau; });
    EXPECT_EQ(result.outcome, SearchOutcome::met);
    EXPECT_LT(result.best->knob, 1);
}

TEST(KnobSearch, goes_on_where_the_error_is_noise_far_below_the_target) {
    const auto result = searched(kTau, 1, [](double tau) {
        return tau < 2 ? 0.016 : tau < 10 ? 0.02 : tau < 30 ? 0.0001 : 0.03 * tau;
    });
    EXPECT_EQ(result.outcome, SearchOutcome::met);
    EXPECT_NEAR(*result.best->value, 1, 0.05);
}

TEST(KnobSearch, between_neighbours_it_gives_the_nearer) {
    const Knob few{"k", true, 1, 64, 8};
    const auto result = searched(few, 10, [](double k) { return k < 20 ? 4.0 : 11.0; });
    EXPECT_EQ(result.outcome, SearchOutcome::between);
    EXPECT_EQ(result.best->value, 11.0);
    EXPECT_GE(result.best->knob, 20);
}

TEST(KnobSearch, closes_in_on_a_jump_by_halves) {
    const auto result = searched(
        kTau, 1, [](double tau) { return tau < 66.27 ? 0.8 : 1.14; }, 40);
    EXPECT_EQ(result.outcome, SearchOutcome::between);
    EXPECT_NEAR(result.best->knob, 66.27, 0.005 * 66.27);
    EXPECT_LE(result.probes.size(), 16U);
    const auto finer =
        search_knob(kTau, 1, 0.002, 40, [](double tau) { return tau < 66.27 ? 0.8 : 1.14; });
    EXPECT_NEAR(finer.best->knob, 66.27, 0.0002 * 66.27 + 0.01);
}

TEST(KnobSearch, infinite_and_zero_values_are_far_away_not_lost) {
    const double infinity = std::numeric_limits<double>::infinity();
    const auto result =
        searched(kTau, 2, [&](double tau) { return tau < 3 ? (tau < 0.5 ? 0.0 : tau) : infinity; });
    EXPECT_EQ(result.outcome, SearchOutcome::met);
    EXPECT_NEAR(*result.best->value, 2, 0.1);
}

TEST(KnobSearch, a_value_that_cannot_be_flown_ends_the_way_there) {
    const auto result = searched(kGrid, 1, [](double rows) -> std::optional<double> {
        if (rows > 1000) return std::nullopt;
        return 3500 / rows;
    });
    EXPECT_EQ(result.outcome, SearchOutcome::unreachable);
    EXPECT_EQ(result.best->knob, 960);
    const auto none = searched(kGrid, 1, [](double) { return std::nullopt; });
    EXPECT_FALSE(none.best.has_value());
    EXPECT_EQ(none.outcome, SearchOutcome::unreachable);
}

TEST(KnobSearch, tells_a_measure_that_goes_up_and_down) {
    const auto result = searched(kTau, 3.0, [](double tau) {
        return tau < 3 ? tau : tau < 5 ? 2.5 : tau / 2;
    });
    EXPECT_EQ(result.outcome, SearchOutcome::met);
    const auto waves = searched(
        kTau, 9.0, [](double tau) { return 5 + 3 * std::sin(2.9 * std::log(tau)) + 0.001 * tau; });
    EXPECT_FALSE(waves.monotone);
    EXPECT_TRUE(waves.best.has_value());
}

TEST(KnobSearch, asks_no_more_than_it_may) {
    int asked = 0;
    const auto result = searched(
        kTau, 5.0, [&](double tau) { return ++asked, tau < 7.7 ? 1.0 : 20.0; }, 6);
    EXPECT_EQ(asked, 6);
    EXPECT_EQ(result.outcome, SearchOutcome::between);
}

}  // namespace
}  // namespace lodbench::run
