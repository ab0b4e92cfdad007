#include "results/number_fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace lodbench::results {
namespace {

TEST(NumberFields, numbers_are_found_by_the_names_that_cells_jsonl_has) {
    CellRecord cell;
    cell.frame_ms.emplace().median = 2.5;
    cell.crack_pixels.emplace().total = 7;
    cell.counters = {{"levels", 3}};
    cell.params.set("tau", 0.5);
    EXPECT_EQ(number_field("frame_ms.median")->read(cell), 2.5);
    EXPECT_EQ(number_field("crack_pixels.total")->read(cell), 7);
    EXPECT_EQ(number_field("counters.levels")->read(cell), 3);
    EXPECT_EQ(number_field("params.tau")->read(cell), 0.5);
    EXPECT_FALSE(number_field("counters.none")->read(cell));
    EXPECT_FALSE(number_field("frame_ms.p90")->read(cell));
    EXPECT_FALSE(number_field("select_ms.median")->read(cell));
}

TEST(NumberFields, what_is_no_number_has_none) {
    for (const char* name : {"frame_ms", "method", "economy", "counters.", "params.", "fsp", ""}) {
        EXPECT_FALSE(number_field(name)) << name;
    }
}

TEST(NumberFields, times_are_known_as_such) {
    for (const char* name : {"fps", "frame_ms.median", "prepare_s", "counters.update_ms"}) {
        EXPECT_TRUE(number_field(name)->is_time()) << name;
    }
    for (const char* name : {"triangles.mean", "pixel_error_px.p999", "counters.levels"}) {
        EXPECT_FALSE(number_field(name)->is_time()) << name;
    }
}

TEST(NumberFields, every_name_is_found_once) {
    const std::vector<std::string>& names = number_field_names();
    EXPECT_GT(names.size(), 90U);
    for (const std::string& name : names) {
        EXPECT_EQ(number_field(name)->name, name);
        EXPECT_EQ(std::ranges::count(names, name), 1) << name;
    }
}

}  // namespace
}  // namespace lodbench::results
