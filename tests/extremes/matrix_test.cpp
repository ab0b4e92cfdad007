// The matrix as a record, as text, and against another one.

#include <gmock/gmock.h>

#include "api/error.h"
#include "compare/extremes.h"
#include "extremes/output.h"
#include "extremes/run.h"
#include "results/extremes.h"
#include "results/json.h"

namespace lodbench {
namespace {

using results::ExtremesCell;
using results::ExtremesMatrix;
using results::ExtremesStep;
using testing::HasSubstr;

ExtremesStep step(const std::string& name, const std::string& outcome,
                  const std::string& fault = {}) {
    ExtremesStep made;
    made.step = name;
    made.outcome = outcome;
    if (fault.empty()) return made;
    made.faults.push_back({fault, "frame 1", 3.5, 1.0, "px", "3.5 px, 1 px is claimed", ""});
    made.again = "lodbench extremes --step '" + name + "'";
    return made;
}

ExtremesMatrix matrix(std::vector<ExtremesStep> steps) {
    ExtremesMatrix made;
    made.form = "quick";
    made.terrain = "ridged";
    made.methods = {"one"};
    made.axes = {{"lens", "Lens", "fields of view", {"90", "170", "179"}}};
    ExtremesCell cell;
    cell.method = "one";
    cell.axis = "lens";
    cell.steps = std::move(steps);
    results::sum_up(cell);
    made.cells = {cell};
    return made;
}

TEST(ExtremesMatrix, a_cell_has_the_worst_grade_the_last_good_step_and_the_first_failure) {
    const ExtremesMatrix made =
        matrix({step("90", "good"), step("170", "degraded", "bound"),
                step("179", "broken", "failed"), step("wide", "not-flown"), step("zoom", "good")});
    const ExtremesCell& cell = made.cells.front();
    EXPECT_EQ(cell.grade, "breaks");
    EXPECT_EQ(cell.flown, 4);
    EXPECT_EQ(cell.good, 2);
    EXPECT_EQ(cell.last_good, "90");
    EXPECT_EQ(cell.first_failure, "170");
    EXPECT_EQ(results::words_of(cell), "breaks 2/4: 170: 3.5 px, 1 px is claimed");
    EXPECT_EQ(matrix({step("90", "good")}).cells.front().grade, "stable");
    EXPECT_EQ(matrix({step("90", "not-flown")}).cells.front().grade, "not-flown");
    EXPECT_EQ(matrix({step("90", "dead", "crash")}).cells.front().grade, "dies");
}

TEST(ExtremesMatrix, is_read_back_as_it_was_written) {
    ExtremesMatrix made = matrix({step("90", "good"), step("170", "degraded", "bound")});
    made.cells[0].steps[1].figures.emplace().moved_m = 0.25;
    made.warnings = {"a warning"};
    const Json::Value json = results::to_json(made);
    const ExtremesMatrix read = results::read_extremes(json, "extremes.json");
    EXPECT_EQ(results::to_text(results::to_json(read)), results::to_text(json));
    EXPECT_EQ(read.cells[0].steps[1].figures->moved_m, 0.25);
    EXPECT_EQ(read.axes[0].steps, made.axes[0].steps);
    Json::Value wrong = json;
    wrong["cells"][0]["steps"][0]["outcome"] = "splendid";
    try {
        (void)results::read_extremes(wrong, "extremes.json");
        FAIL() << "was accepted";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("extremes.json"));
        EXPECT_THAT(error.what(), HasSubstr("outcome"));
    }
}

TEST(ExtremesMatrix, shows_each_failure_with_its_reason_and_the_command_that_repeats_it) {
    ExtremesMatrix made = matrix({step("90", "good"), step("170", "degraded", "bound")});
    EXPECT_EQ(extremes::unexplained(made.cells[0]), 1U);
    made.cells[0].steps[1].faults[0].inherent = "the paper bounds vertical errors alone";
    EXPECT_EQ(extremes::unexplained(made.cells[0]), 0U);
    const std::string markdown = extremes::to_markdown(made);
    EXPECT_THAT(markdown, HasSubstr("| method | lens |"));
    EXPECT_THAT(markdown, HasSubstr("| one | degrades 1/2 |"));
    EXPECT_THAT(markdown,
                HasSubstr("| one | 90 | 170 | bound: 3.5 px, 1 px is claimed (frame 1) | the paper "
                          "bounds vertical errors alone | `lodbench extremes --step '170'` |"));
    const std::string page = extremes::to_html(made, "nowhere");
    EXPECT_THAT(page, HasSubstr("degrades 1/2"));
    EXPECT_THAT(page, HasSubstr("Inherent: the paper bounds vertical errors alone"));
}

TEST(ExtremesComparison, sees_a_cell_change_and_whether_it_became_worse) {
    const ExtremesMatrix base = matrix({step("90", "good"), step("170", "good")});
    EXPECT_TRUE(compare::compare_extremes(base, base).changes.empty());
    const ExtremesMatrix worse = matrix({step("90", "good"), step("170", "degraded", "bound")});
    const auto lost = compare::compare_extremes(base, worse);
    ASSERT_EQ(lost.changes.size(), 1U);
    EXPECT_TRUE(lost.changes[0].worse);
    EXPECT_EQ(lost.changes[0].before, "stable 2/2");
    EXPECT_EQ(lost.exit_status(true), 1);
    EXPECT_EQ(lost.exit_status(false), 0);
    EXPECT_THAT(compare::to_text(lost), HasSubstr("170: good -> degraded: bound"));
    const auto gained = compare::compare_extremes(worse, base);
    ASSERT_EQ(gained.changes.size(), 1U);
    EXPECT_FALSE(gained.changes[0].worse);
    EXPECT_EQ(gained.exit_status(true), 0);
    // Not flown any more is not better, and another kind of failure is a change.
    EXPECT_TRUE(compare::compare_extremes(base, matrix({step("90", "good")})).changes[0].worse);
    const ExtremesMatrix other = matrix({step("90", "good"), step("170", "degraded", "cracks")});
    EXPECT_EQ(compare::compare_extremes(worse, other).changes.size(), 1U);
}

}  // namespace
}  // namespace lodbench
