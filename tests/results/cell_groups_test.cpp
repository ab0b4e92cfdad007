// Repetitions of one setting, and whether they drew the same.

#include "results/cell_groups.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
