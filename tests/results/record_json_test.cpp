// Records by their field tables: JSON both ways, what is refused, and figures by their names.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "api/error.h"
#include "results/cell.h"
#include "results/frame.h"
#include "results/json.h"

namespace lodbench::results {
namespace {

using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

CellRecord whole() {
    CellRecord cell;
    cell.cell = "m__tau=1__s__r2";
    cell.method = "m";
    cell.scenario = "s";
    cell.params.set("tau", 1.0);
    cell.params.set("levels", std::int64_t(7));
    cell.params.set("cull", true);
    cell.params.set("form", std::string("square"));
    cell.params.set("bound", kInfinity);
    cell.repetition = 2;
    cell.seed = std::numeric_limits<std::uint64_t>::max();
    cell.status = CellStatus::ok;
    cell.frame_ms.emplace();
    cell.frame_ms->median = 12.5;
    cell.triangles = {100.25, 99, 102};
    cell.pixel_error_px.emplace();
    cell.pixel_error_px->count = 640 * 480;
    cell.pixel_error_px->max = kInfinity;
    cell.pixel_error_px->p999 = 0.1;
    cell.pixel_error_px->worst = {3, 40, 50};
    cell.economy.emplace().push_back({7, 1000, 5000, FewestFigures{0.5, 0.4, 2, 500, 600}, {}});
    cell.counters = {{"a", 1}, {"b", 0.5}};
    cell.warnings = {"one", "two"};
    return cell;
}

std::string refusal(const Json::Value& json) {
    try {
        (void)read_cell(json, "cells.jsonl:4");
    } catch (const InputError& error) {
        return error.what();
    }
    return "taken";
}

TEST(Record, is_the_same_after_the_way_through_json) {
    const Json::Value json = to_json(whole());
    const CellRecord back = read_cell(json, "here");
    EXPECT_EQ(to_json(back), json);
    EXPECT_EQ(to_text(to_json(read_cell(parse_json(to_text(json), "here"), "here"))),
              to_text(json));
    EXPECT_EQ(back.params.real("tau"), 1.0);
    EXPECT_EQ(back.params.integer("levels"), 7);
    EXPECT_TRUE(back.params.boolean("cull"));
    EXPECT_EQ(back.seed, std::numeric_limits<std::uint64_t>::max());
    EXPECT_EQ(back.pixel_error_px->max, kInfinity);
    EXPECT_EQ(back.pixel_error_px->worst->column, 50);
    EXPECT_EQ(back.economy->at(0).p999->minimal_triangles, 500U);
    EXPECT_FALSE(back.economy->at(0).max);
}

TEST(Record, says_null_of_what_was_not_measured_and_inf_of_what_is_infinite) {
    const Json::Value json = to_json(whole());
    for (const char* name : {"fps", "gpu_ms", "gpu_bytes", "popping_px", "reason", "shots_hash"}) {
        EXPECT_TRUE(json.isMember(name) && json[name].isNull()) << name;
    }
    EXPECT_EQ(json["pixel_error_px"]["max"], "inf");
    EXPECT_TRUE(json["frame_ms"]["p99"].isNull());
}

TEST(Record, of_another_version_is_read_for_what_it_has) {
    Json::Value json = to_json(whole());
    json.removeMember("triangles");
    json.removeMember("warnings");
    json["triangles_of_tomorrow"] = 5;
    const CellRecord back = read_cell(json, "here");
    EXPECT_FALSE(back.triangles);
    EXPECT_TRUE(back.warnings.empty());
    EXPECT_EQ(back.frame_ms->median, 12.5);
}

TEST(Record, that_lacks_what_it_must_have_or_has_it_of_another_type_is_refused_by_its_name) {
    for (const char* name : {"cell", "method", "scenario", "status", "params", "repetition"}) {
        Json::Value json = to_json(whole());
        json.removeMember(name);
        EXPECT_THAT(refusal(json),
                    HasSubstr(std::string("cells.jsonl:4: '") + name + "' is missing; "));
    }
    const auto with = [](const char* name, const Json::Value& value) {
        Json::Value json = to_json(whole());
        json[name] = value;
        return refusal(json);
    };
    EXPECT_THAT(with("status", "great"), HasSubstr("'status' is not ok, skipped, failed"));
    EXPECT_THAT(with("repetition", "2"), HasSubstr("'repetition' is not a whole number"));
    EXPECT_THAT(with("gpu_bytes", -1), HasSubstr("'gpu_bytes' is not a whole number of at least"));
    EXPECT_THAT(with("fps", "fast"), HasSubstr("'fps' is not a number, \"inf\" or null"));
    EXPECT_THAT(with("frame_ms", 3), HasSubstr("'frame_ms' is not an object"));
    EXPECT_THAT(with("warnings", "one"), HasSubstr("'warnings' is not a list"));
    EXPECT_THAT(with("params", "none"), HasSubstr("'params' is not an object"));
    EXPECT_THAT(with("cell", "../escape"), HasSubstr("'../escape' is no name of a cell"));
    Json::Value nested = to_json(whole());
    nested["pixel_error_px"]["worst"]["row"] = "top";
    EXPECT_THAT(refusal(nested), HasSubstr("'pixel_error_px.worst.row' is not a whole number"));
    EXPECT_THAT(refusal(Json::arrayValue), HasSubstr("cells.jsonl:4: no object"));
}

TEST(Figure, has_the_name_of_its_members_and_reads_the_number_there) {
    using namespace figures;
    const CellRecord cell = whole();
    const CellFigure median = of<&Cell::frame_ms, &TimeSummary::median>;
    EXPECT_EQ(median.name(), "frame_ms.median");
    EXPECT_EQ(median(cell), 12.5);
    EXPECT_EQ((of<&Cell::pixel_error_px, &ErrorFigures::p999>.name()), "pixel_error_px.p999");
    EXPECT_EQ((of<&Cell::pixel_error_px, &ErrorFigures::max>(cell)), kInfinity);
    EXPECT_EQ((of<&Cell::triangles, &CountSummary::max>(cell)), 102.0);
    EXPECT_EQ((of<&Cell::gpu_ms, &TimeSummary::max>(cell)), std::nullopt) << "no GPU time";
    EXPECT_EQ((of<&Cell::frame_ms, &TimeSummary::p99>(cell)), std::nullopt) << "too few frames";
    EXPECT_EQ(of<&Cell::fps>.name(), "fps");
    EXPECT_TRUE(median.is_within("frame_ms"));
    EXPECT_FALSE(median.is_within("cpu_ms"));
}

TEST(FrameRecord, is_a_row_of_numbers_and_a_line_of_the_csv) {
    FrameRecord frame;
    frame.frame = 3;
    frame.wall_ms = 0.1;
    frame.triangles = 12'345'678'901;
    frame.pixel_max_px = kInfinity;
    const Json::Value row = encode(frame);
    FrameRecord back;
    decode(row, back, Place{"here", "frames"});
    EXPECT_EQ(encode(back), row);
    EXPECT_EQ(back.triangles, 12'345'678'901U);
    EXPECT_FALSE(back.gpu_ms);
    const std::string csv = frames_csv({frame});
    EXPECT_THAT(csv, testing::StartsWith("frame,wall_ms,select_ms,submit_ms,cpu_ms,gpu_ms,tri"));
    EXPECT_THAT(csv, HasSubstr("\n3,0.1,0,0,0,,12345678901,"));
    EXPECT_THAT(csv, HasSubstr(",inf,"));
    EXPECT_EQ(std::ranges::count(csv, '\n'), 2);
    Json::Value shorter = row;
    shorter.resize(row.size() - 1);
    EXPECT_THROW(decode(shorter, back, (Place{"here", "frames"})), InputError);
}

}  // namespace
}  // namespace lodbench::results
