#include "reproduce/judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "api/error.h"
#include "reproduce/output.h"
#include "support/paper_files.h"

namespace lodbench::reproduce {
namespace {

using results::CellRecord;
using results::CellStatus;
using test::ScratchFolder;
using testing::HasSubstr;

/// A cell of method `refined` at `tau`, of which `frame_ms` and `triangles` are known.
CellRecord cell(double tau, int repetition, double frame_ms, double triangles) {
    CellRecord record;
    record.cell = fmt::format("refined__tau={}__r{}", tau, repetition);
    record.method = "refined";
    record.scenario = "tiny";
    record.params.set("tau", tau);
    record.repetition = repetition;
    record.status = CellStatus::ok;
    record.frame_ms.emplace().median = frame_ms;
    record.fps = 1000 / frame_ms;
    record.triangles.emplace().mean = triangles;
    record.timer_verdict = "the timer lies";
    return record;
}

/// Two repetitions of taus 1, 2 and 4: 8, 4 and 2 ms to a tenth more, 400, 200 and 100 triangles.
FlownExperiment flown() {
    FlownExperiment experiment;
    for (int repetition = 0; repetition < 2; ++repetition) {
        const double more = 1 + 0.1 * repetition;
        for (const double tau : {1.0, 2.0, 4.0}) {
            experiment.cells.push_back(cell(tau, repetition, 8 / tau * more, 400 / tau));
        }
    }
    return experiment;
}

struct Judged {
    Outcome outcome;
    std::string text;  ///< all that is said of it
    std::vector<Finding> findings;
};

/// The only claim of a paper with this `rest` of it.
Judged judged(const std::string& rest, const FlownExperiment& experiment,
              const Setting& setting = {}) {
    const ScratchFolder folder;
    const Paper paper = read_paper(test::paper_file(folder.path(), rest));
    PaperOutcome outcome;
    outcome.paper = &paper;
    outcome.evidence.experiments["flight"] = experiment;
    outcome.verdicts = judge(paper, outcome.evidence, setting);
    std::vector<Finding> findings;
    for (const ReadingVerdict& reading : outcome.verdicts.at(0).readings) {
        findings.insert(findings.end(), reading.findings.begin(), reading.findings.end());
    }
    return {outcome.verdicts.at(0).outcome, to_markdown({outcome}), findings};
}

const std::string kClaim = R"([[claim]]
id = "C1"
words = "It is so"
place = "section 1"
select = { experiment = "flight", method = "refined" }
)";

std::string claim(const std::string& test) {
    return kClaim + "[[claim.test]]\n" + test;
}

TEST(Judge, a_ratio_is_judged_by_all_of_its_interval) {
    // 8 to 8.8 over 4 to 4.4: 1.818 to 2.2.
    const std::string test =
        "kind = \"ratio\"\nof = { field = \"frame_ms.median\", tau = 1 }\nto = { field = "
        "\"frame_ms.median\", tau = 2 }\n";
    EXPECT_EQ(judged(claim(test + "least = 1.8\nmost = 2.3\n"), flown()).outcome, Outcome::holds);
    EXPECT_EQ(judged(claim(test + "least = 2.1\n"), flown()).outcome, Outcome::undecided);
    EXPECT_EQ(judged(claim(test + "least = 2.3\n"), flown()).outcome, Outcome::fails);
    const auto value = judged(claim(test + "least = 1.8\n"), flown()).findings.at(0).value;
    EXPECT_NEAR(value->low, 8 / 4.4, 1e-12);
    EXPECT_NEAR(value->high, 8.8 / 4, 1e-12);
}

TEST(Judge, a_changed_result_changes_the_verdict) {
    const std::string test =
        claim("kind = \"bound\"\nof = { field = \"triangles.mean\", tau = 4 }\nmost = 100\n");
    FlownExperiment experiment = flown();
    EXPECT_EQ(judged(test, experiment).outcome, Outcome::holds);
    for (CellRecord& record : experiment.cells) *record.triangles->mean += 1;
    EXPECT_EQ(judged(test, experiment).outcome, Outcome::fails);
}

TEST(Judge, a_claim_whose_cell_failed_never_holds) {
    const std::string test = claim(
        "kind = \"bound\"\nof = \"triangles.mean\"\nmost = 1000\nfor_each = { tau = [1, 2, 4] }\n");
    FlownExperiment experiment = flown();
    EXPECT_EQ(judged(test, experiment).outcome, Outcome::holds);
    experiment.cells[4].status = CellStatus::crashed;
    experiment.cells[4].reason = "signal 11 in draw";
    const Judged crashed = judged(test, experiment);
    EXPECT_EQ(crashed.outcome, Outcome::unjudged);
    EXPECT_THAT(crashed.text, HasSubstr("signal 11 in draw"));
    // What decidedly fails elsewhere does not hold, whatever that cell would have said.
    EXPECT_EQ(judged(claim("kind = \"bound\"\nof = \"triangles.mean\"\nmost = 300\nfor_each = { "
                           "tau = [1, 2, 4] }\n"),
                     experiment)
                  .outcome,
              Outcome::fails);
}

TEST(Judge, what_is_not_here_cannot_be_judged) {
    const std::string test =
        claim("kind = \"bound\"\nof = { field = \"triangles.mean\", tau = 1 }\nmost = 1000\n");
    FlownExperiment absent;
    absent.unusable["refined"] = absent.failure = "there is no method refined here";
    EXPECT_EQ(judged(test, absent).outcome, Outcome::unjudged);
    FlownExperiment unequal = flown();
    unequal.unusable["refined"] = "refined does not come to 100 triangles";
    EXPECT_EQ(judged(test, unequal).outcome, Outcome::unjudged);
    const Judged no_time = judged(
        claim("kind = \"bound\"\nof = { field = \"gpu_ms.median\", tau = 1 }\nmost = 1000\n"),
        flown());
    EXPECT_EQ(no_time.outcome, Outcome::unjudged);
    EXPECT_THAT(no_time.text, HasSubstr("no GPU time: the timer lies"));
}

TEST(Judge, a_claim_says_what_it_needs) {
    const std::string test =
        "[[claim.test]]\nkind = \"bound\"\nof = { field = \"triangles.mean\", tau = 1 }\nmost = "
        "1000\n";
    FlownExperiment software = flown();
    software.software = true;
    const std::string gpu = kClaim + "needs = [\"gpu\"]\n" + test;
    EXPECT_EQ(judged(gpu, flown()).outcome, Outcome::holds);
    EXPECT_EQ(judged(gpu, software).outcome, Outcome::unjudged);
    const std::string terrain = kClaim + "needs = [\"terrain\"]\n" + test;
    EXPECT_EQ(judged(terrain, flown()).outcome, Outcome::unjudged);
    EXPECT_EQ(judged(terrain, flown(), {true}).outcome, Outcome::holds);
    const Judged never = judged(kClaim + "unjudged = \"nothing tells\"\n", flown());
    EXPECT_EQ(never.outcome, Outcome::unjudged);
    EXPECT_THAT(never.text, HasSubstr("nothing tells"));
}

TEST(Judge, a_time_that_was_measured_once_decides_nothing) {
    FlownExperiment once = flown();
    once.cells.resize(3);
    const Judged time =
        judged(claim("kind = \"bound\"\nof = { field = \"fps\", tau = 1 }\nleast = 1\n"), once);
    EXPECT_EQ(time.outcome, Outcome::undecided);
    EXPECT_THAT(time.text, HasSubstr("measured once"));
    EXPECT_EQ(judged(claim("kind = \"bound\"\nof = { field = \"triangles.mean\", tau = 1 }\nmost "
                           "= 400\n"),
                     once)
                  .outcome,
              Outcome::holds);
}

TEST(Judge, constant_monotone_and_rank) {
    const std::string over = "over = { tau = [1, 2, 4] }\n";
    const auto outcome = [&](const std::string& test) {
        return judged(claim(test + over), flown()).outcome;
    };
    EXPECT_EQ(outcome("kind = \"constant\"\nof = \"triangles.mean\"\nwithin = 4\n"),
              Outcome::holds);
    EXPECT_EQ(outcome("kind = \"constant\"\nof = \"triangles.mean\"\nwithin = 3.9\n"),
              Outcome::fails);
    // fps * triangles is the same at each tau, to the tenth that the repetitions differ by.
    EXPECT_EQ(outcome("kind = \"constant\"\nof = \"triangles.mean * frame_ms.median / "
                      "params.tau\"\nwithin = 2\n"),
              Outcome::fails);
    EXPECT_EQ(outcome("kind = \"constant\"\nof = \"fps * triangles.mean\"\nwithin = 1.2\n"),
              Outcome::holds);
    EXPECT_EQ(outcome("kind = \"falls\"\nof = \"frame_ms.median\"\nstrictly = true\n"),
              Outcome::holds);
    EXPECT_EQ(outcome("kind = \"rises\"\nof = \"frame_ms.median\"\n"), Outcome::fails);
    // 400, 200 and 100 triangles a tau over 1, 2 and 4.
    EXPECT_EQ(outcome("kind = \"falls\"\nof = \"triangles.mean\"\nto = \"params.tau\"\n"),
              Outcome::holds);
    EXPECT_EQ(outcome("kind = \"rank\"\nof = \"fps\"\nto = \"triangles.mean\"\nmost = -0.9\n"),
              Outcome::holds);
    EXPECT_EQ(outcome("kind = \"rank\"\nof = \"fps\"\nto = \"triangles.mean\"\nleast = 0\n"),
              Outcome::fails);
}

TEST(Judge, figures_of_a_frame_are_found_by_its_part_of_the_flight) {
    FlownExperiment experiment = flown();
    for (const CellRecord& record : experiment.cells) {
        experiment.frames[record.cell].columns["triangles"] = {500, 400, 300, 200, 100};
    }
    const auto outcome = [&](const std::string& part, int value) {
        return judged(claim(fmt::format("kind = \"bound\"\nof = {{ field = "
                                        "\"frames.triangles@{}\", tau = 1 }}\nleast = "
                                        "{}\nmost = {}\n",
                                        part, value, value)),
                      experiment)
            .outcome;
    };
    EXPECT_EQ(outcome("0", 500), Outcome::holds);
    EXPECT_EQ(outcome("0.5", 300), Outcome::holds);
    EXPECT_EQ(outcome("1", 100), Outcome::holds);
    EXPECT_EQ(outcome("1", 200), Outcome::fails);
    experiment.frames.clear();
    EXPECT_EQ(outcome("0", 500), Outcome::unjudged);
}

TEST(Judge, readings_that_differ_are_told_apart) {
    const std::string readings = R"([[claim.reading]]
name = "coarse"
select = { tau = 4 }
[[claim.reading]]
name = "fine"
select = { tau = 1 }
)";
    const auto with = [&](int most) {
        return judged(kClaim + readings +
                          fmt::format("[[claim.test]]\nkind = \"bound\"\nof = "
                                      "\"triangles.mean\"\nmost = {}\n",
                                      most),
                      flown());
    };
    EXPECT_EQ(with(400).outcome, Outcome::holds);
    EXPECT_EQ(with(50).outcome, Outcome::fails);
    const Judged differs = with(200);
    EXPECT_EQ(differs.outcome, Outcome::depends);
    EXPECT_THAT(differs.text, HasSubstr("coarse: holds."));
    EXPECT_THAT(differs.text, HasSubstr("fine: does not hold."));
}

std::string table_with(const std::string& values) {
    return R"([[table]]
id = "1"
title = "Table 1"
rows_are = "tau"
field = "fps"
unit = "1/s"
baseline_row = "one"
select = { experiment = "flight", method = "refined" }
[[table.column]]
title = "fps"
[[table.row]]
title = "one"
select = { tau = 1 }
values = [1000]
[[table.row]]
title = "two"
select = { tau = 2 }
values = [)" +
           values + R"(]
[[table.row]]
title = "four"
select = { tau = 4 }
values = [4000]
)";
}

TEST(Judge, a_changed_published_figure_changes_the_verdict) {
    const std::string shape = claim("kind = \"published\"\ntable = \"1\"\nwithin = 1.2\n");
    const std::string order = claim("kind = \"published-rank\"\ntable = \"1\"\nleast = 0.9\n");
    EXPECT_EQ(judged(table_with("2000") + shape, flown()).outcome, Outcome::holds);
    EXPECT_EQ(judged(table_with("3000") + shape, flown()).outcome, Outcome::fails);
    EXPECT_EQ(judged(table_with("3000") + order, flown()).outcome, Outcome::holds);
    EXPECT_EQ(judged(table_with("5000") + order, flown()).outcome, Outcome::fails);
}

TEST(Judge, published_times_stand_beside_ratios_alone) {
    const Judged shown = judged(
        table_with("2000") + claim("kind = \"published\"\ntable = \"1\"\nwithin = 1.2\n"), flown());
    // 4 to 4.4 ms over 8 to 8.8 ms; our 238 frames a second are nowhere.
    EXPECT_THAT(shown.text, HasSubstr("| two | 2000 (2) | 2 \\[1.818, 2.2\\] |"));
    EXPECT_THAT(shown.text, testing::Not(HasSubstr("238")));
}

// Of a campaign that was resumed some cells are read back from cells.jsonl, which has 15 digits.
TEST(Judge, a_third_is_one_setting_read_back_or_not) {
    FlownExperiment experiment;
    experiment.cells = {cell(1.0 / 3, 0, 1, 10), cell(0.333333333333333, 1, 1, 10)};
    EXPECT_EQ(judged(claim("kind = \"bound\"\nof = { field = \"triangles.mean\", tau = "
                           "0.3333333333333333 }\nmost = 10\n"),
                     experiment)
                  .outcome,
              Outcome::holds);
}

TEST(Judge, selections_that_are_wrong_are_told_by_line) {
    const auto refusal = [](const std::string& test) -> std::string {
        try {
            (void)judged(claim(test), flown());
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_THAT(refusal("kind = \"bound\"\nof = \"fps\"\nmost = 1\n"),
                HasSubstr("paper.toml:15: 3 settings of experiment flight have refined; select "
                          "one of them: refined, tiny, tau=1; "));
    EXPECT_THAT(refusal("kind = \"bound\"\nof = { field = \"fps\", tau = 3 }\nmost = 1\n"),
                HasSubstr("paper.toml:15: no cell of experiment flight has refined, tau=3"));
    EXPECT_EQ(refusal("kind = \"bound\"\nof = { field = \"fps\", tau = 1.0 }\nmost = 1\n"),
              "accepted");
}

}  // namespace
}  // namespace lodbench::reproduce
