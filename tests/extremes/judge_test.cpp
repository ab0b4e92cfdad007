// What is called a failure, how bad it is, and what is held against it.

#include "extremes/judge.h"

#include <gmock/gmock.h>

#include <array>
#include <limits>
#include <tuple>

namespace lodbench::extremes {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Nothing wrong with it.
ProbeOutcome healthy() {
    ProbeOutcome outcome;
    results::ExtremesFigures& figures = outcome.figures;
    figures.frames = 2;
    figures.triangles_min = figures.triangles_max = 1000;
    figures.not_finite = figures.unrepeated = 0;
    figures.samples = 5000;
    figures.uncovered_samples = figures.crack_pixels = 0;
    figures.pixels = 19200;
    figures.screen_max_px = 0.5;
    figures.claimed_px = 1;
    return outcome;
}

std::vector<std::string> kinds(const ProbeOutcome& outcome, const WorldChange& world = {},
                               const std::optional<results::ExtremesFigures>& mild = {}) {
    std::vector<std::string> found;
    for (const results::ExtremesFault& fault : judge(outcome, world, mild)) {
        EXPECT_FALSE(fault.words.empty()) << fault.what;
        found.push_back(fault.what);
    }
    return found;
}

using Kinds = std::vector<std::string>;

TEST(Judge, finds_nothing_wrong_with_what_is_right) {
    EXPECT_THAT(judge(healthy(), {}, healthy().figures), IsEmpty());
    EXPECT_STREQ(outcome_of({}), "good");
}

TEST(Judge, an_end_of_the_process_is_worse_than_a_failed_call_and_that_than_a_wrong_figure) {
    ProbeOutcome outcome = healthy();
    using Ending = ProbeOutcome::Ending;
    const std::tuple<Ending, const char*, const char*> endings[] = {
        {Ending::crashed, "crash", "dead"},
        {Ending::hung, "hang", "dead"},
        {Ending::out_of_memory, "memory", "dead"},
        {Ending::failed, "failed", "broken"}};
    for (const auto& [ending, kind, grade] : endings) {
        outcome.ending = ending;
        outcome.words = "in select";
        outcome.figures.crack_pixels = 3;
        const auto faults = judge(outcome, {}, {});
        ASSERT_EQ(faults.size(), 2U);
        EXPECT_EQ(faults.front().what, kind) << "the worst comes first";
        EXPECT_EQ(faults.front().words, "in select");
        EXPECT_STREQ(outcome_of(faults), grade);
    }
}

TEST(Judge, vertices_and_repetition_have_to_hold_always) {
    ProbeOutcome outcome = healthy();
    outcome.figures.not_finite = 4;
    EXPECT_EQ(kinds(outcome, {}, outcome.figures), Kinds{"not-finite"});
    outcome = healthy();
    outcome.figures.unrepeated = 1;
    EXPECT_EQ(kinds(outcome, {}, outcome.figures), Kinds{"not-repeatable"});
    outcome = healthy();
    outcome.figures.triangles_max = 0;
    EXPECT_EQ(kinds(outcome, {}, {}), Kinds{"nothing-drawn"});
    outcome.figures.samples = 0;  // nothing is in view
    EXPECT_EQ(kinds(outcome, {}, {}), Kinds{});
}

TEST(Judge, cover_and_cracks_are_held_against_the_mild_setting) {
    ProbeOutcome outcome = healthy();
    outcome.figures.uncovered_samples = 1;
    outcome.figures.crack_pixels = 10;
    EXPECT_EQ(kinds(outcome, {}, healthy().figures), (Kinds{"uncovered", "cracks"}));
    results::ExtremesFigures mild = healthy().figures;
    mild.uncovered_samples = 7;
    mild.crack_pixels = 5;
    EXPECT_EQ(kinds(outcome, {}, mild), Kinds{});
    outcome.figures.crack_pixels = 11;
    EXPECT_EQ(kinds(outcome, {}, mild), Kinds{"cracks"});
}

TEST(Judge, a_bound_holds_or_is_as_far_off_as_in_the_mild_setting) {
    ProbeOutcome outcome = healthy();
    outcome.figures.screen_max_px = 1.0009;
    EXPECT_EQ(kinds(outcome, {}, healthy().figures), Kinds{});
    outcome.figures.screen_max_px = 1.0011;
    EXPECT_EQ(kinds(outcome, {}, healthy().figures), Kinds{"bound"});
    outcome.figures.rounding_px = 0.001;  // of float positions, next to the eye
    EXPECT_EQ(kinds(outcome, {}, healthy().figures), Kinds{});
    results::ExtremesFigures mild = healthy().figures;
    mild.screen_max_px = 1.7;
    outcome.figures.screen_max_px = 3.3;
    EXPECT_EQ(kinds(outcome, {}, mild), Kinds{});
    outcome.figures.screen_max_px = 3.5;
    EXPECT_EQ(kinds(outcome, {}, mild), Kinds{"bound"});
    outcome.figures.claimed_px.reset();
    EXPECT_EQ(kinds(outcome, {}, mild), Kinds{}) << "nothing is claimed";
}

TEST(Judge, a_moved_world_has_the_same_surface_to_a_millimetre_and_the_same_picture_to_a_level) {
    ProbeOutcome outcome = healthy();
    results::ExtremesFigures& figures = outcome.figures;
    figures.moved_m = 1e-3;
    figures.image_levels = 1;
    figures.changed_triangles = 9;
    figures.compared_triangles = 1000;
    figures.changed_pixels = 0;
    const WorldChange moved{.shift = {1e7, 0}};
    EXPECT_EQ(kinds(outcome, moved, {}), Kinds{});
    figures.moved_m = 1.1e-3;
    EXPECT_EQ(kinds(outcome, moved, {}), Kinds{"moved"});
    figures.moved_m = std::numeric_limits<double>::infinity();
    EXPECT_EQ(kinds(outcome, moved, {}), Kinds{"moved"});
    figures.moved_m = 0;
    figures.image_levels = 2;
    figures.changed_pixels = 1;
    EXPECT_EQ(kinds(outcome, moved, {}), Kinds{"image"});
}

TEST(Judge, a_world_scaled_by_a_power_of_two_has_the_same_triangles_to_the_bit) {
    ProbeOutcome outcome = healthy();
    results::ExtremesFigures& figures = outcome.figures;
    figures.moved_m = 0;
    figures.image_levels = 0;
    figures.changed_pixels = 0;
    figures.changed_triangles = 1;
    figures.compared_triangles = 1000;
    EXPECT_EQ(kinds(outcome, {.shift = {}, .scale = 1024}, {}), Kinds{"selection"});
    EXPECT_EQ(kinds(outcome, {.shift = {}, .scale = 1e6}, {}), Kinds{})
        << "every product rounds anew";
    figures.moved_m = 5;  // a decision within rounding, which no picture shows
    figures.image_levels = 30;
    figures.changed_pixels = 19;
    EXPECT_EQ(kinds(outcome, {.shift = {}, .scale = 1e6}, {}), Kinds{});
    figures.changed_pixels = 20;
    EXPECT_EQ(kinds(outcome, {.shift = {}, .scale = 1e6}, {}), (Kinds{"moved", "image"}));
    EXPECT_EQ(kinds(outcome, {.shift = {}, .scale = 0.5}, {}), (Kinds{"moved", "image"}));
}

TEST(Judge, what_is_inherent_is_explained_where_it_was_said_and_nowhere_else) {
    Battery battery;
    battery.inherent = {{"m", "lens", {"170 degrees"}, {"bound"}, "the paper's reason", ""}};
    ProbeOutcome outcome = healthy();
    outcome.figures.screen_max_px = 5;
    outcome.figures.crack_pixels = 1;
    auto faults = judge(outcome, {}, {});
    explain(faults, battery, "m", "lens", "170 degrees");
    ASSERT_EQ(faults.size(), 2U);
    EXPECT_EQ(faults[0].what, "cracks");
    EXPECT_EQ(faults[0].inherent, "");
    EXPECT_EQ(faults[1].inherent, "the paper's reason");
    for (const auto& [method, axis, step] :
         {std::array{"n", "lens", "170 degrees"}, std::array{"m", "size", "170 degrees"},
          std::array{"m", "lens", "179 degrees"}}) {
        auto others = judge(outcome, {}, {});
        explain(others, battery, method, axis, step);
        EXPECT_EQ(others[1].inherent, "");
    }
}

TEST(Judge, a_reason_that_no_failure_needs_any_more_is_told) {
    Battery battery;
    battery.inherent = {{"m", "lens", {}, {"bound"}, "why", "inherent.toml:3"},
                        {"m", "", {}, {"cracks"}, "why", "inherent.toml:9"},
                        {"elsewhere", "lens", {}, {}, "why", "inherent.toml:15"}};
    results::ExtremesMatrix matrix;
    results::ExtremesCell& cell = matrix.cells.emplace_back();
    cell.method = "m";
    cell.axis = "lens";
    cell.steps.emplace_back().faults.push_back({"cracks", "", {}, {}, "", "words", ""});
    EXPECT_THAT(unneeded_reasons(battery, matrix),
                testing::ElementsAre(HasSubstr("inherent.toml:3: no failure needs this reason")));
}

}  // namespace
}  // namespace lodbench::extremes
