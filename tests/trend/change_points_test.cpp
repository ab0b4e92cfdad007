// Steps of known series are found where they are, and no others. The whole study is the slow test.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "api/error.h"
#include "trend/change_points.h"
#include "trend/change_points_study.h"

namespace lodbench::trend {
namespace {

using test::Pattern;
using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::size_t> places_of(const std::vector<double>& values,
                                   const StepOptions& options = {}) {
    std::vector<std::size_t> places;
    for (const Step& step : find_steps(values, options)) places.push_back(step.place);
    return places;
}

std::vector<double> two_levels(std::size_t before, std::size_t after, double low, double high) {
    std::vector<double> values(before, low);
    values.insert(values.end(), after, high);
    return values;
}

TEST(ChangePoints, find_a_step_without_noise_at_its_place_wherever_it_is) {
    for (std::size_t place = 6; place <= 114; ++place) {
        const std::vector<Step> steps = find_steps(two_levels(place, 120 - place, 10, 12));
        ASSERT_EQ(steps.size(), 1U) << place;
        EXPECT_EQ(steps[0].place, place);
        EXPECT_EQ(steps[0].before, 10);
        EXPECT_EQ(steps[0].after, 12);
        EXPECT_EQ(steps[0].p_value, 0);
    }
}

TEST(ChangePoints, find_every_step_of_a_long_series) {
    std::vector<double> values;
    std::vector<std::size_t> expected;
    for (int level = 0; level < 40; ++level) {
        if (level > 0) expected.push_back(values.size());
        values.insert(values.end(), std::size_t(20 + 7 * level), level % 2 == 0 ? 10 : 13);
    }
    EXPECT_EQ(places_of(values), expected);
}

TEST(ChangePoints, below_the_least_change_are_not_told) {
    EXPECT_THAT(places_of(two_levels(50, 50, 100, 109)), IsEmpty());
    EXPECT_THAT(places_of(two_levels(50, 50, 100, 111)), ElementsAre(50));
    StepOptions options;
    options.change = 0.05;
    EXPECT_THAT(places_of(two_levels(50, 50, 100, 109), options), ElementsAre(50));
}

TEST(ChangePoints, need_a_segment_on_each_side) {
    EXPECT_THAT(places_of(two_levels(50, 5, 10, 20)), IsEmpty());
    EXPECT_THAT(places_of(two_levels(50, 6, 10, 20)), ElementsAre(50));
    EXPECT_THAT(places_of({}), IsEmpty());
    EXPECT_THAT(places_of(two_levels(5, 5, 10, 20)), IsEmpty());
}

TEST(ChangePoints, do_not_depend_on_the_unit) {
    for (const Pattern& pattern : test::patterns()) {
        test::Noise noise(3);
        const std::vector<double> values = pattern.draw(noise, 3);
        std::vector<double> scaled;
        for (const double value : values) scaled.push_back(1024 * value);  // exact
        EXPECT_EQ(places_of(values), places_of(scaled)) << pattern.name;
    }
}

TEST(ChangePoints, refuse_options_out_of_range) {
    for (const StepOptions& options :
         {StepOptions{50, 2}, StepOptions{11, 6}, StepOptions{50, 6, -1}}) {
        EXPECT_THROW((void)find_steps(std::vector<double>(20), options), ContractError);
    }
}

TEST(ChangePoints, of_the_study_are_found_and_false_alarms_are_rare) {
    std::size_t found = 0;
    std::size_t expected = 0;
    std::size_t alarms = 0;
    std::size_t quiet = 0;
    for (const Pattern& pattern : test::patterns()) {
        const test::Outcome outcome = test::study(pattern, 3, 60, 11);
        if (pattern.kind == Pattern::Kind::steps) {
            found += outcome.found;
            expected += outcome.expected;
        } else if (pattern.kind == Pattern::Kind::quiet) {
            alarms += outcome.with_steps;
            quiet += outcome.series;
        }
    }
    EXPECT_GE(expected, 1000U);
    EXPECT_GE(double(found), 0.95 * double(expected));
    EXPECT_GE(quiet, 700U);
    EXPECT_LE(double(alarms), 0.01 * double(quiet));
}

}  // namespace
}  // namespace lodbench::trend
