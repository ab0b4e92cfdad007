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

Json::Value cell(int repetition) {
    Json::Value json;
    json["cell"] = fmt::format("m__s__r{}", repetition);
    json["method"] = "m";
    json["scenario"] = "s";
    json["params"] = Json::objectValue;
    json["status"] = "ok";
    json["repetition"] = repetition;
    json["triangles"]["mean"] = 10.5;
    json["triangles"]["min"] = 10;
    json["triangles"]["max"] = 11;
    json["draw_calls"]["mean"] = 2;
    json["samples_prepared"] = 289;
    json["shots_hash"] = "00000000000000aa";
    return json;
}

std::vector<std::string> disagreements(const std::vector<Json::Value>& cells) {
    return disagreements_of(group_cells(cells).at(0));
}

TEST(Disagreements, of_equal_repetitions_are_none) {
    EXPECT_THAT(disagreements({cell(0)}), IsEmpty());
    EXPECT_THAT(disagreements({cell(0), cell(1), cell(2)}), IsEmpty());
}

TEST(Disagreements, name_the_figure_both_values_and_both_repetitions) {
    std::vector<Json::Value> cells = {cell(0), cell(1), cell(2)};
    cells[2]["triangles"]["mean"] = 12.25;
    EXPECT_THAT(disagreements(cells),
                ElementsAre(HasSubstr("triangles a frame differ between repetitions: 10.5 in "
                                      "repetition 0, 12.25 in repetition 2")));
    for (const char* key : {"samples_prepared", "shots_hash"}) {
        std::vector<Json::Value> others = {cell(0), cell(1)};
        others[1][key] = key == std::string("shots_hash") ? Json::Value("00000000000000ab") : 290;
        EXPECT_THAT(disagreements(others), ElementsAre(HasSubstr("differ between repetitions")))
            << key;
    }
}

TEST(Disagreements, leave_out_what_failed_or_was_not_measured) {
    std::vector<Json::Value> cells = {cell(0), cell(1), cell(2)};
    cells[1]["status"] = "failed";
    cells[1]["triangles"] = Json::Value::null;
    cells[2]["shots_hash"] = Json::Value::null;  // of an older version
    EXPECT_THAT(disagreements(cells), IsEmpty());
}

}  // namespace
}  // namespace lodbench::results
