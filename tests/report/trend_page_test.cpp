// The page and the Markdown of a history: each step with its commit, and nothing but text.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/html/axis.h"
#include "report/html/trend_page.h"
#include "report/trend_rows.h"
#include "trend/fake_history.h"

namespace lodbench::report {
namespace {

using test::fake_cell;
using test::fake_run;
using testing::HasSubstr;
using testing::Not;

trend::Trends trends_of(const std::vector<trend::RunEntry>& runs) {
    trend::Database database = trend::Database::in_memory();
    for (const trend::RunEntry& run : runs) database.add(run);
    return trend::find_trends(database.read(), {});
}

std::string triangles(int mean) {
    return fmt::format(R"({{"triangles":{{"mean":{}}},"shots_hash":"{}"}})", mean, mean);
}

std::vector<trend::RunEntry> two_steps() {
    std::vector<trend::RunEntry> runs;
    for (int run = 0; run < 40; ++run) {
        runs.push_back(fake_run(
            run, {fake_cell("m", run < 20 ? 5 : 8, triangles(run < 30 ? 123456 : 123457))}));
    }
    return runs;
}

TEST(TrendPage, has_the_commit_at_each_step_and_the_figures_before_and_after) {
    const std::string page = html::trend_page(trends_of(two_steps()), "history");
    EXPECT_THAT(page, HasSubstr("m: frame_ms.median"));
    EXPECT_THAT(page, HasSubstr(">c000020</text>"));
    EXPECT_THAT(page, HasSubstr("m: triangles.mean"));
    EXPECT_THAT(page, HasSubstr(">c000030</text>"));
    EXPECT_THAT(page, HasSubstr("data-value=\"123456\">123456</td>"));
    EXPECT_THAT(page, HasSubstr("data-value=\"123457\">123457</td>"));
    EXPECT_THAT(page, HasSubstr("data-value=\"+60 %\">+60 %</td>"));
    EXPECT_THAT(page, HasSubstr("c000020: 5 → 8, +60 %"));
    EXPECT_THAT(page, HasSubstr("c000030: 123456 → 123457, +0.00081 %"));
    EXPECT_THAT(page, HasSubstr("median between steps"));
    EXPECT_THAT(page, HasSubstr("default-src 'none'")) << "it fetches nothing";
}

TEST(TrendPage, of_one_triangle_more_has_an_axis_that_shows_it) {
    const std::string page = html::trend_page(trends_of(two_steps()), "history");
    EXPECT_THAT(page, HasSubstr(">123456.0</text>"));
    EXPECT_THAT(page, HasSubstr(">123457.0</text>"));
}

TEST(TrendPage, of_a_hostile_history_is_text) {
    std::vector<trend::RunEntry> runs = two_steps();
    for (trend::RunEntry& run : runs) {
        run.commit = "<script>alert(1)</script>\x1b[2J";
        run.folder = "\"><img src=x>";
        run.cells[0].series.scenario = "</script><b>";
        run.cells[0].series.machine = "<machine>";
        run.cells[0].series.method = "a|b`c*d\n# e";
    }
    const trend::Trends trends = trends_of(runs);
    const std::string page = html::trend_page(trends, "<name>");
    for (const char* smuggled : {"<script>alert", "<img", "<b>", "<machine>", "<name>", "\x1b"}) {
        EXPECT_THAT(page, Not(HasSubstr(smuggled)));
    }
    const std::string text = trend_text(trends);
    EXPECT_THAT(text, HasSubstr("| a\\|b\\`c\\*d # e |"));
    EXPECT_THAT(text, Not(HasSubstr("<script>")));
}

TEST(TrendPage, of_an_empty_history_says_so) {
    const trend::Trends trends = trends_of({});
    EXPECT_THAT(html::trend_page(trends, "history"), HasSubstr("No series steps."));
    EXPECT_THAT(trend_text(trends), HasSubstr("0 steps in 0 runs"));
}

TEST(TrendText, has_the_newest_step_first_and_says_by_what_it_is_judged) {
    const std::string text = trend_text(trends_of(two_steps()));
    const std::size_t newest = text.find(
        "| c000030 | c000029 | demo | m | triangles.mean | 123456 "
        "| 123457 | +0.00081 % |");
    const std::size_t older =
        text.find("| c000020 | c000019 | demo | m | frame\\_ms.median | 5 | 8 | +60 % |");
    ASSERT_NE(newest, text.npos) << text;
    ASSERT_NE(older, text.npos) << text;
    EXPECT_LT(newest, older);
    EXPECT_THAT(text, HasSubstr("at least 6 runs on each side, at most 50 of them looked at, "
                                "differ by at least 10 % and 2.5 standard deviations"));
}

TEST(TrendText, names_the_machines_where_there_are_several) {
    std::vector<trend::RunEntry> runs = two_steps();
    EXPECT_THAT(trend_text(trends_of(runs)), Not(HasSubstr("device A")));
    trend::CellEntry other = fake_cell("n", 1);
    other.series.machine = "device B; Release build";
    runs.push_back(fake_run(50, {other}));
    EXPECT_THAT(trend_text(trends_of(runs)), HasSubstr("| device A; Release build |"));
}

TEST(Axis, that_spans_its_values_does_not_reach_to_zero_and_tells_its_ticks_apart) {
    const std::vector<double> values = {123456, 123457};
    const html::Axis axis(values, html::Axis::Scale::spanning, 0, 100);
    EXPECT_LT(axis.place(123456), 10);
    EXPECT_GT(axis.place(123457), 90);
    std::vector<std::string> labels;
    for (const double tick : axis.ticks()) labels.push_back(axis.tick_label(tick));
    EXPECT_GE(labels.size(), 3U);
    EXPECT_EQ(std::ranges::adjacent_find(labels), labels.end());
}

}  // namespace
}  // namespace lodbench::report
