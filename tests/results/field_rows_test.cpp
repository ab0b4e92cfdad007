// What a field's row says of it beside its name: from which column of the frames it is summed up,
// and whether it comes out the same each time.

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <type_traits>

#include "results/cell.h"
#include "results/deterministic.h"

namespace lodbench::results {
namespace {

TEST(FieldRows, a_cell_is_summed_up_from_the_columns_that_its_rows_name) {
    std::size_t summed = 0;
    each_field<CellRecord>([&](const auto& field) {
        if constexpr (requires { field.source; }) {
            CellResult result;
            for (const int value : {3, 8, 4}) {
                FrameRecord& frame = result.frames.emplace_back();
                frame.*field.source = std::remove_cvref_t<decltype(frame.*field.source)>(value);
            }
            const CellRecord cell = finish_cell({}, result, 16.67);
            const auto& summary = cell.*field.member;
            ASSERT_TRUE(summary) << field.name;
            EXPECT_EQ(summary->mean, 5) << field.name;
            EXPECT_EQ(summary->min, 3) << field.name;
            EXPECT_EQ(summary->max, 8) << field.name;
            ++summed;
        }
    });
    EXPECT_GE(summed, 9U) << "the times and the counts of a frame";
}

TEST(FieldRows, what_no_frame_or_not_every_frame_has_is_summed_up_or_left_out_by_its_kind) {
    CellResult result;
    result.frames.resize(2);
    result.frames[1].gpu_ms = 2;
    result.frames[1].triangles_nondegenerate = 7;
    const CellRecord cell = finish_cell({}, result, 16.67);
    EXPECT_FALSE(cell.gpu_ms) << "a time of some frames says nothing of the flight";
    ASSERT_TRUE(cell.triangles_nondegenerate) << "only measured frames have it";
    EXPECT_EQ(cell.triangles_nondegenerate->mean, 7);
    EXPECT_FALSE(cell.draw_calls);
}

TEST(FieldRows, all_that_the_truth_measures_of_a_frame_repeats_and_no_time_does) {
    std::set<std::string> repeating;
    for (const DeterministicField& column : deterministic_columns()) repeating.insert(column.name);
    each_field<FrameRecord>([&](const auto& field) {
        const bool is_truth = requires(measure::FrameTruth truth) {
            truth.*field.member;
        };
        if (is_truth) {
            EXPECT_TRUE(repeating.contains(field.name)) << field.name;
        }
        if (std::string(field.unit) == "ms") {
            EXPECT_FALSE(repeating.contains(field.name)) << field.name;
        }
    });
    EXPECT_TRUE(repeating.contains("triangles"));
}

}  // namespace
}  // namespace lodbench::results
