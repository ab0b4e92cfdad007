// Repetitions of one setting, and whether they drew the same.

#include "results/cell_groups.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "results/error_metric.h"

namespace lodbench::results {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

CellRecord cell(int repetition) {
    CellRecord record;
    record.cell = fmt::format("m__s__r{}", repetition);
    record.method = "m";
    record.scenario = "s";
    record.status = CellStatus::ok;
    record.repetition = repetition;
    record.triangles = {10.5, 10, 11};
    record.draw_calls = {2, 2, 2};
    record.samples_prepared = 289;
    record.shots_hash = "00000000000000aa";
    return record;
}

std::vector<std::string> disagreements(const std::vector<CellRecord>& cells) {
    return disagreements_of(group_cells(cells).at(0));
}

/// Repetition 0 on device A, which measured the truth, and 1 on B.
std::vector<CellRecord> on_two_devices() {
    std::vector<CellRecord> cells = {cell(0), cell(1)};
    cells[0].device = "A";
    cells[1].device = "B";
    cells[0].truth_frames = 5;
    cells[0].pixel_error_px.emplace().p999 = 0.75;
    cells[0].frame_ms.emplace().median = 3;
    cells[1].fps = 50;
    return cells;
}

TEST(MeasuredElsewhere, errors_of_a_device_without_any_are_those_of_the_other_and_that_is_said) {
    using namespace figures;
    const std::vector<CellRecord> cells = on_two_devices();
    const std::vector<CellGroup> groups = group_cells(cells);
    ASSERT_EQ(groups.size(), 2U);
    EXPECT_THAT(numbers_of(groups[0], of<&Cell::pixel_error_px, &ErrorFigures::p999>),
                ElementsAre(0.75));
    EXPECT_THAT(numbers_of(groups[1], of<&Cell::pixel_error_px, &ErrorFigures::p999>),
                ElementsAre(0.75));
    EXPECT_EQ(pixel_error(groups[1], ErrorMetric::p999), 0.75);
    EXPECT_THAT(numbers_of(groups[1], of<&Cell::frame_ms, &TimeSummary::median>), IsEmpty())
        << "times are each device's own";
    EXPECT_THAT(numbers_of(groups[0], of<&Cell::fps>), IsEmpty()) << "and never borrowed back";
    EXPECT_THAT(borrowed_truth(cells),
                ElementsAre(HasSubstr("the errors of 1 setting on 'B' were measured on 'A'")));
}

TEST(MeasuredElsewhere, nothing_is_borrowed_from_what_drew_something_else_or_at_its_own_pace) {
    using namespace figures;
    std::vector<CellRecord> cells = on_two_devices();
    cells[1].triangles->max = 12;
    EXPECT_THAT(borrowed_truth(cells), IsEmpty());
    EXPECT_THAT(numbers_of(group_cells(cells)[1], of<&Cell::pixel_error_px, &ErrorFigures::p999>),
                IsEmpty());
    cells = on_two_devices();
    cells[0].pixel_error_realtime_px.emplace().p999 = 9;
    const std::vector<CellGroup> groups = group_cells(cells);
    EXPECT_EQ(pixel_error(groups[0], ErrorMetric::p999), 9);
    EXPECT_EQ(pixel_error(groups[1], ErrorMetric::p999), std::nullopt);
    EXPECT_THAT(numbers_of(groups[1], of<&Cell::pixel_error_realtime_px, &ErrorFigures::p999>),
                IsEmpty());
}

TEST(Disagreements, of_equal_repetitions_are_none) {
    EXPECT_THAT(disagreements({cell(0)}), IsEmpty());
    EXPECT_THAT(disagreements({cell(0), cell(1), cell(2)}), IsEmpty());
}

TEST(Disagreements, name_the_figure_both_values_and_both_repetitions) {
    std::vector<CellRecord> cells = {cell(0), cell(1), cell(2)};
    cells[2].triangles->mean = 12.25;
    EXPECT_THAT(disagreements(cells),
                ElementsAre(HasSubstr("triangles a frame differ between repetitions: 10.5 in "
                                      "repetition 0, 12.25 in repetition 2")));
    std::vector<CellRecord> others = {cell(0), cell(1)};
    others[1].samples_prepared = 290;
    EXPECT_THAT(disagreements(others),
                ElementsAre(HasSubstr(
                    "289 in repetition 0, 290 in repetition 1; it keeps what it prepared")));
    others[1] = cell(1);
    others[1].shots_hash = "00000000000000ab";
    EXPECT_THAT(disagreements(others), ElementsAre(HasSubstr("hashes of the depth images differ")));
}

TEST(Disagreements, leave_out_what_failed_or_was_not_measured) {
    std::vector<CellRecord> cells = {cell(0), cell(1), cell(2)};
    cells[1].status = CellStatus::failed;
    cells[1].triangles.reset();
    cells[2].shots_hash.clear();  // of an older version
    EXPECT_THAT(disagreements(cells), IsEmpty());
}

}  // namespace
}  // namespace lodbench::results
