// What a history shows: steps of times by statistics, of all else to the bit.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api/error.h"
#include "support/campaign_folders.h"
#include "support/run_lodbench.h"
#include "trend/fake_history.h"
#include "trend/trends.h"

namespace lodbench::trend {
namespace {

using test::fake_cell;
using test::fake_run;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string triangles(int mean) {
    return fmt::format(R"({{"triangles":{{"mean":{},"max":99}},"shots_hash":"aa"}})", mean);
}

class TrendsOfHistory : public testing::Test {
protected:
    void add(int number, std::vector<CellEntry> cells) {
        database_.add(fake_run(number, std::move(cells)));
    }
    [[nodiscard]] Trends trends() const { return find_trends(database_.read(), {}); }

    Database database_ = Database::in_memory();
};

TEST_F(TrendsOfHistory, tell_one_triangle_more_with_the_runs_on_both_sides) {
    for (int run = 0; run < 5; ++run)
        add(run, {fake_cell("m", 5, triangles(run < 3 ? 1000 : 1001))});
    const Trends found = trends();
    ASSERT_EQ(found.changes.size(), 1U);
    const Change& change = found.changes[0];
    EXPECT_EQ(change.field, "triangles.mean");
    EXPECT_EQ(change.before.asInt(), 1000);
    EXPECT_EQ(change.after.asInt(), 1001);
    EXPECT_EQ(found.history.runs[change.previous].commit, "c000002");
    EXPECT_EQ(found.history.runs[change.run].commit, "c000003");
    EXPECT_THAT(found.facts_of(0, "triangles.mean").values,
                ElementsAre(1000, 1000, 1000, 1001, 1001));
}

TEST_F(TrendsOfHistory, do_not_tell_what_is_measured_for_the_first_time_or_is_missing_once) {
    add(0, {fake_cell("m", 5, R"({"a":1})")});
    add(1, {fake_cell("m", 5, R"({"a":1,"b":2})")});
    add(2, {fake_cell("m", 5, R"({"b":2})")});
    add(3, {fake_cell("m", 5, R"({"a":1,"b":2})")});
    EXPECT_THAT(trends().changes, IsEmpty());
    add(4, {fake_cell("m", 5, R"({"b":2})")});
    add(5, {fake_cell("m", 5, R"({"a":3,"b":2})")});
    ASSERT_EQ(trends().changes.size(), 1U) << "what was known before the gap is not forgotten";
}

TEST_F(TrendsOfHistory, tell_of_a_list_which_entry_is_another) {
    for (int run = 0; run < 2; ++run) {
        add(run, {fake_cell("m", 5,
                            fmt::format(R"({{"economy":[{{"ratio":2}},{{"ratio":{}}}]}})", run))});
    }
    const Trends found = trends();
    ASSERT_EQ(found.changes.size(), 1U);
    EXPECT_EQ(found.changes[0].field, "economy.1.ratio");
}

TEST_F(TrendsOfHistory, take_the_truth_from_the_repetition_that_has_it) {
    for (int run = 0; run < 2; ++run) {
        add(run, {fake_cell("m", 5, R"({"triangles":7,"error":1})", 0),
                  fake_cell("m", 6, R"({"triangles":7})", 1)});
    }
    EXPECT_THAT(trends().changes, IsEmpty());
    EXPECT_THAT(trends().facts_of(0, "error").values, ElementsAre(1, 1));
}

TEST_F(TrendsOfHistory, break_a_series_where_the_machine_changes) {
    for (int run = 0; run < 40; ++run) {
        CellEntry cell = fake_cell("m", run < 20 ? 5 : 9, triangles(run < 20 ? 10 : 11));
        if (run >= 20) cell.series.machine = "device B; Release build";
        add(run, {cell});
    }
    const Trends found = trends();
    EXPECT_EQ(found.history.series.size(), 2U);
    EXPECT_EQ(found.step_count(), 0U);
}

TEST_F(TrendsOfHistory, find_a_step_of_times_on_each_of_two_machines_that_take_turns) {
    for (int run = 0; run < 60; ++run) {
        CellEntry cell = fake_cell("m", (run % 2 == 0 ? 5 : 50) * (run < 30 ? 1 : 2));
        if (run % 2 == 1) cell.series.machine = "device B; Release build";
        add(run, {cell});
    }
    const Trends found = trends();
    ASSERT_EQ(found.figures.size(), 2U);
    for (const FigureTrend& figure : found.figures) {
        ASSERT_EQ(figure.steps.size(), 1U);
        EXPECT_EQ(figure.steps[0].place, 15U);
    }
}

TEST_F(TrendsOfHistory, tell_what_never_stays_the_same_once_and_not_each_time) {
    for (int run = 0; run < 30; ++run) add(run, {fake_cell("m", 5, triangles(run))});
    const Trends found = trends();
    EXPECT_THAT(found.changes, IsEmpty());
    ASSERT_EQ(found.unsteady.size(), 1U);
    EXPECT_EQ(found.unsteady[0].field, "triangles.mean");
    EXPECT_EQ(found.unsteady[0].changes, 29U);
    EXPECT_EQ(found.unsteady[0].runs, 30U);
}

TEST_F(TrendsOfHistory, say_of_short_series_that_they_are_not_judged) {
    for (int run = 0; run < 12; ++run) {
        EXPECT_EQ(run > 0 && trends().figures.at(0).judged, false);
        add(run, {fake_cell("m", 5)});
    }
    EXPECT_TRUE(trends().figures.at(0).judged);
}

TEST_F(TrendsOfHistory, name_a_series_by_the_parameters_that_differ) {
    CellEntry fine = fake_cell("m", 5);
    fine.series.params = R"({"morph":true,"tau":0.5})";
    CellEntry coarse = fake_cell("m", 5);
    coarse.series.params = R"({"morph":true,"tau":2.0})";
    add(0, {fine, coarse, fake_cell("n", 1)});
    EXPECT_THAT(trends().labels, ElementsAre("m tau=0.5", "m tau=2", "n"));
}

TEST_F(TrendsOfHistory, refuse_texts_that_are_no_objects) {
    add(0, {fake_cell("m", 5, "[1]")});
    try {
        (void)trends();
        FAIL() << "a list was taken as facts";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "memory: facts of a cell: expected an object; the history is damaged: make it "
                     "anew with `lodbench trend add` from the results folders");
    }
}

TEST_F(TrendsOfHistory, as_JSON_have_every_step_with_its_commits) {
    for (int run = 0; run < 40; ++run) {
        add(run, {fake_cell("m", run < 25 ? 5 : 8, triangles(run < 10 ? 1 : 2))});
    }
    const Json::Value json = to_json(trends());
    EXPECT_EQ(json["runs"].size(), 40U);
    const Json::Value& series = json["series"][0];
    const Json::Value& step = series["figures"][0]["steps"][0];
    EXPECT_EQ(step["commit"], "c000025");
    EXPECT_EQ(step["previous"]["commit"], "c000024");
    EXPECT_EQ(step["before"], 5.0);
    EXPECT_EQ(step["after"], 8.0);
    const Json::Value& change = series["changes"][0];
    EXPECT_EQ(change["field"], "triangles.mean");
    EXPECT_EQ(change["commit"], "c000010");
}

TEST(RunEntryOfFolder, has_the_noisy_figures_the_facts_and_an_id_that_outlives_a_resume) {
    const test::ScratchFolder scratch;
    const test::FakeCampaign campaign;
    const auto planned = campaign.cells();
    const auto half = std::vector(planned.begin(), planned.begin() + 6);
    campaign.write(scratch.path() / "half", planned, half, 1, 1);
    campaign.write(scratch.path() / "whole", planned, planned, 1, 1);
    const RunEntry first = run_entry(results::read_result_folder(scratch.path() / "half"));
    const RunEntry second = run_entry(results::read_result_folder(scratch.path() / "whole"));
    EXPECT_EQ(first.id, second.id);
    EXPECT_EQ(first.cells.size(), 6U);
    ASSERT_EQ(second.cells.size(), planned.size());
    const CellEntry& cell = second.cells[0];
    EXPECT_EQ(cell.series.method, "m0");
    EXPECT_THAT(cell.series.machine, HasSubstr("renderer A, OpenGL 4.5; processor, 8 cores; "));
    EXPECT_THAT(cell.series.flight, HasSubstr("terrain 0000000000000000"));
    EXPECT_THAT(cell.figures, testing::Contains(testing::Pair("frame_ms.median", 10.0)));
    EXPECT_THAT(cell.facts, HasSubstr("\"shots_hash\":\"0000000000000000\""));
    EXPECT_THAT(cell.facts, Not(HasSubstr("seed")));
    EXPECT_THAT(cell.facts, Not(HasSubstr("frame_ms")));
    test::FakeCampaign other;
    other.device = "renderer B, OpenGL 4.5; processor, 8 cores";
    other.write(scratch.path() / "other", planned, planned, 2, 2);
    EXPECT_NE(run_entry(results::read_result_folder(scratch.path() / "other")).id, first.id);
}

}  // namespace
}  // namespace lodbench::trend
