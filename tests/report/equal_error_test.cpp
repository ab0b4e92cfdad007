// The table of a flight at equal error, and what it says in words.

#include "report/equal_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "results/json.h"

namespace lodbench::report {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

results::CellRecord cell(const std::string& method, double frame_ms, double error_px,
                         double honesty = 0) {
    results::CellRecord record;
    record.scenario = "alps";
    record.method = method;
    record.status = results::CellStatus::ok;
    if (method != "whole") record.params.set("tau", 2.5);
    record.frame_ms.emplace();
    record.frame_ms->median = frame_ms;
    record.frame_ms->max = 2 * frame_ms;
    record.triangles = {1000.4, 1000, 1001};
    record.pixel_error_px.emplace();
    record.pixel_error_px->p999 = error_px;
    if (honesty > 0) {
        record.claimed_px = 2.5;
        record.bound_honesty = honesty;
    }
    return record;
}

class EqualError : public testing::Test {
protected:
    std::string text(const std::vector<results::CellRecord>& cells) {
        return equal_text(flight_, cells, knobs_);
    }
    /// The first line below the table.
    std::string verdict(const std::vector<results::CellRecord>& cells) {
        const std::string all = text(cells);
        const std::size_t begin = all.find("|\n\n") + 3;
        return all.substr(begin, all.find('\n', begin) - begin);
    }
    const std::map<std::string, std::string> knobs_{{"a", "tau"}, {"b", "tau"}, {"c", "tau"}};
    EqualFlight flight_{
        .scenario = "alps", .error_px = 2, .tolerance = 0.1, .as_kept = true, .off = {}};
};

TEST_F(EqualError, the_first_line_says_who_is_fastest_at_which_error_and_against_whom) {
    EXPECT_EQ(
        verdict({cell("a", 30, 2.1), cell("b", 20, 1.9), cell("whole", 400, 0), cell("c", 5, 3)}),
        "At equal error (99.9 % of the pixels within 2 px of the true terrain, measured) b is "
        "fastest: "
        "20.0 ms a frame (median); the next, a, takes 30.0 ms; whole, which draws every sample, "
        "400.0 ms.");
}

TEST_F(EqualError, times_that_one_flight_cannot_tell_apart_win_together) {
    EXPECT_THAT(verdict({cell("a", 20.9, 2), cell("b", 20, 2)}),
                HasSubstr(") b and a are fastest: 20.0 ms"));
    EXPECT_THAT(verdict({cell("a", 21.1, 2), cell("b", 20, 2)}),
                HasSubstr(") b is fastest: 20.0 ms"));
}

TEST_F(EqualError, those_that_follow_are_told_together_where_one_flight_cannot_tell_them_apart) {
    EXPECT_THAT(verdict({cell("a", 20, 2), cell("b", 30.5, 2), cell("c", 30, 2), cell("d", 32, 2)}),
                HasSubstr("; the next, c and b, take 30.0 to 30.5 ms."));
}

TEST_F(EqualError, a_winner_that_shows_more_than_it_claims_is_said_to) {
    EXPECT_THAT(verdict({cell("a", 20, 2, 1.5), cell("b", 20, 2, 1.2), cell("c", 30, 2, 3)}),
                HasSubstr(" ms. In places a and b show more error than they claim."));
    EXPECT_THAT(verdict({cell("a", 20, 2, 0.5), cell("c", 30, 2, 3)}),
                Not(HasSubstr("more error")));
}

TEST_F(EqualError, rows_stand_by_rising_time_those_at_another_error_last_and_marked) {
    const std::string all = text({cell("a", 30, 2), cell("b", 20, 2), cell("c", 5, 3)});
    EXPECT_LT(all.find("| b "), all.find("| a "));
    EXPECT_LT(all.find("| a "), all.find("| c "));
    EXPECT_THAT(
        all,
        AllOf(
            HasSubstr(
                "## alps: what methods cost at the same measured error, P99.9 = 2 px within 10 %"),
            HasSubstr("| 3.00 (not 2 px) |"), HasSubstr("| tau = 2.5 |"),
            HasSubstr("|      1000 |"), HasSubstr("|       60.0 |")));
}

TEST_F(EqualError, what_is_off_is_said_with_the_reason_that_is_known) {
    const std::vector<results::CellRecord> cells = {cell("a", 30, 2), cell("c", 5, 3)};
    EXPECT_THAT(text(cells),
                AllOf(HasSubstr("- c shows 3 px: the value of the knob that the scenario keeps, or "
                                "the method's default where it keeps none, gives another error"),
                      HasSubstr("`lodbench match` finds the one that meets it.\n")));
    flight_.off["c"] = "its grid ends there";
    EXPECT_THAT(text(cells), HasSubstr("- c shows 3 px: its grid ends there.\n"));
    flight_.as_kept = false;
    EXPECT_THAT(text(cells),
                AllOf(HasSubstr("- c shows 3 px: what the scenario keeps is for the flight as it"),
                      HasSubstr("keeps no value flies at its default; `lodbench match` finds"),
                      Not(HasSubstr("grid"))));
    EXPECT_THAT(text({cell("a", 30, 2), cell("other", 5, 3)}),
                HasSubstr("- other shows 3 px: it has no knob to set."));
}

TEST_F(EqualError, an_asynchronous_method_is_off_by_what_it_shows_at_pace_and_said_to_be_late) {
    results::CellRecord late = cell("b", 20, 2.1);
    late.pixel_error_realtime_px.emplace();
    late.pixel_error_realtime_px->p999 = 4;
    EXPECT_THAT(text({cell("a", 30, 2), late}),
                HasSubstr("- b shows 4 px: at this machine's pace its selection comes late; "
                          "caught up, it shows 2.1 px.\n"));
    EXPECT_THAT(verdict({cell("a", 30, 2), late}), HasSubstr(") a is fastest"));
}

TEST_F(EqualError, nobody_wins_where_nobody_shows_the_error) {
    EXPECT_EQ(verdict({cell("a", 30, 1), cell("whole", 400, 0)}),
              "No method shows the error that all were to show (99.9 % of the pixels within 2 px "
              "of the true "
              "terrain, measured), so their frame times do not compare.");
}

TEST_F(EqualError, of_a_search_for_that_error_the_winner_is_told_and_of_another_target_nothing) {
    const std::vector<results::CellRecord> cells = {cell("a", 20, 2), cell("b", 30, 2.05),
                                                    cell("c", 31, 3)};
    const std::vector<results::CellGroup> groups = results::group_cells(cells);
    results::MatchTarget target;
    target.value = 2;
    const auto words = match_words(target, groups, knobs_);
    ASSERT_TRUE(words);
    EXPECT_EQ(*words,
              "At equal error (99.9 % of the pixels within 2 px of the true terrain, measured) a "
              "is fastest: 20.0 ms a frame (median); the next, b, takes 30.0 ms.");
    target.value = 10;
    EXPECT_THAT(*match_words(target, groups, knobs_), HasSubstr("No method shows the error"));
    target.metric = results::ErrorMetric::max;
    EXPECT_FALSE(match_words(target, groups, knobs_));
    target = {.quantity = results::MatchTarget::Quantity::triangles, .value = 2};
    EXPECT_FALSE(match_words(target, groups, knobs_));
}

TEST_F(EqualError, an_error_above_a_claimed_bound_is_marked_and_said) {
    const std::string all =
        text({cell("a", 30, 2, 1.5), cell("b", 20, 2, 1.0005), cell("c", 40, 2)});
    EXPECT_THAT(all, AllOf(HasSubstr("| 2.5 (exceeded 1.50 x) |"), HasSubstr(" 2.5 |\n")));
    EXPECT_THAT(
        all,
        HasSubstr(
            "- The greatest measured screen error exceeds the bound that the method claims: a 1.50 "
            "times.\n"));
    EXPECT_THAT(text({cell("b", 20, 2, 0.9)}), Not(HasSubstr("exceed")));
}

TEST_F(EqualError, an_error_that_was_not_measured_or_is_infinite_is_off) {
    results::CellRecord none = cell("a", 30, 2);
    none.pixel_error_px.reset();
    EXPECT_THAT(text({none}), HasSubstr("- a shows no measured error: "));
    results::CellRecord infinite = cell("a", 30, 2);
    infinite.pixel_error_px->p999 = std::numeric_limits<double>::infinity();
    EXPECT_THAT(text({infinite}), HasSubstr("- a shows inf px: "));
}

TEST(EqualFlights, are_those_of_run_json) {
    const auto run = results::read_record<results::RunRecord>(results::parse_json(R"({
        "scenarios": [{"name": "one"},
                      {"name": "two", "equal": {"error_px": 1.5, "tolerance": 0.05, "as_kept": true,
                                                "off": {"pgm": "slow"}}}],
        "plugins": [{"methods": [{"id": "pgm", "quality_knob": "grid"}, {"id": "full", "quality_knob": null}]}]})",
                                                                                  "run.json"),
                                                              "run.json");
    const auto flights = equal_flights(run);
    ASSERT_EQ(flights.size(), 1U);
    EXPECT_EQ(flights[0].scenario, "two");
    EXPECT_EQ(flights[0].error_px, 1.5);
    EXPECT_TRUE(flights[0].as_kept);
    EXPECT_THAT(flights[0].off, testing::ElementsAre(testing::Pair("pgm", "slow")));
    EXPECT_THAT(quality_knobs(run), testing::ElementsAre(testing::Pair("pgm", "grid")));
}

}  // namespace
}  // namespace lodbench::report
