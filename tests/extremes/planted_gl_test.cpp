// Planted instabilities: each is faultless in the mild setting, is found where it breaks, and is
// graded with step, place and figure.

#include <gmock/gmock.h>

#include <algorithm>

#include "extremes/output.h"
#include "extremes/run.h"
#include "run/locations.h"
#include "support/run_lodbench.h"

namespace lodbench::extremes {
namespace {

using testing::HasSubstr;

class Planted : public testing::Test {
protected:
    /// Of the quick form: all steps of an axis, one method.
    results::ExtremesMatrix push(const std::string& method, const std::string& axis) {
        Request request;
        request.out = folder_.path() / (method + "-" + axis);
        request.methods = {method};
        request.axes = {axis};
        request.quick = true;
        for (const Step& step : battery_.axis(axis).steps) {
            if (!step.heavy) request.steps.push_back(step.name);
        }
        const auto plugins = run::list_plugins({LODBENCH_BUILD_DIR "/broken-plugins/unstable"});
        return extremes::run(battery_, request, plugins,
                             [&](const std::string&, const std::string& of,
                                 const results::ExtremesStep& step, std::size_t, std::size_t) {
                                 if (of == "mild") mild_ = step;
                             });
    }
    static const results::ExtremesStep& at(const results::ExtremesCell& cell,
                                           const std::string& name) {
        return *std::ranges::find(cell.steps, name, &results::ExtremesStep::step);
    }

    Battery battery_ =
        read_battery(std::filesystem::path(LODBENCH_SOURCE_DIR) / "scenarios/extremes");
    test::ScratchFolder folder_;
    results::ExtremesStep mild_;
};

TEST_F(Planted, float_world_coordinates_are_found_and_graded) {
    const results::ExtremesMatrix matrix = push("float-world", "origin");
    ASSERT_EQ(matrix.cells.size(), 1U);
    const results::ExtremesCell& cell = matrix.cells.front();
    EXPECT_EQ(mild_.outcome, "good") << (mild_.faults.empty() ? "" : mild_.faults[0].words);
    EXPECT_EQ(cell.grade, "degrades");
    EXPECT_EQ(at(cell, "0 m").outcome, "good");
    EXPECT_FALSE(cell.last_good.empty());
    EXPECT_FALSE(cell.first_failure.empty());
    // A float of 1e7 m has steps of 1 m: eye and vertex are off by half of one at most.
    const results::ExtremesStep& far = at(cell, "1e7 m");
    const auto moved = std::ranges::find(far.faults, "moved", &results::ExtremesFault::what);
    ASSERT_NE(moved, far.faults.end());
    EXPECT_GT(moved->found.value_or(0), 0.1);
    EXPECT_LT(moved->found.value_or(9), 2);
    EXPECT_THAT(far.again, HasSubstr("--method float-world --axis origin --step '1e7 m' --quick"));
    EXPECT_FALSE(far.picture.empty());
    EXPECT_GT(unexplained(cell), 0U);
}

TEST_F(Planted, a_blind_division_by_distance_less_radius_is_found_and_graded) {
    const results::ExtremesMatrix matrix = push("blind-metric", "viewpoint");
    const results::ExtremesCell& cell = matrix.cells.front();
    EXPECT_EQ(mild_.outcome, "good") << (mild_.faults.empty() ? "" : mild_.faults[0].words);
    EXPECT_NE(cell.grade, "stable");
    EXPECT_EQ(at(cell, "straight down").outcome, "good");
    // Inside of the spheres of the blocks around the eye.
    const results::ExtremesStep& inside = at(cell, "2 m above ground");
    ASSERT_FALSE(inside.faults.empty());
    const auto bound = std::ranges::find(inside.faults, "bound", &results::ExtremesFault::what);
    ASSERT_NE(bound, inside.faults.end());
    EXPECT_GT(bound->found.value_or(0), 10 * bound->allowed.value_or(1));
    EXPECT_THAT(bound->where, HasSubstr("sample at row"));
    const std::string markdown = to_markdown(matrix);
    EXPECT_THAT(markdown, HasSubstr("| blind-metric |"));
    EXPECT_THAT(markdown, HasSubstr("px are claimed"));
}

}  // namespace
}  // namespace lodbench::extremes
