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
    bool explained;
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
    return {outcome.verdicts.at(0).outcome, outcome.verdicts.at(0).explained(),
            to_markdown({outcome}), findings};
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

/// 400 triangles at tau 1 are to be 300 at most; at tau 4 there are 100.
std::string explained_claim(const std::string& explanation) {
    return claim("kind = \"bound\"\nof = { field = \"triangles.mean\", tau = 1 }\nmost = 300\n" +
                 explanation);
}

std::string explanation(const std::string& test) {
    return "[[claim.explanation]]\nwords = \"the tolerance is too fine\"\n"
           "[[claim.explanation.test]]\n" +
           test;
}

const std::string kCoarserIsFewer = explanation(
    "kind = \"ratio\"\nof = { field = \"triangles.mean\", tau = 4 }\nto = { field = "
    "\"triangles.mean\", tau = 1 }\nbelow = 0.5\n");

TEST(Judge, what_does_not_hold_is_explained_by_figures_alone) {
    const Judged without = judged(explained_claim(""), flown());
    EXPECT_EQ(without.outcome, Outcome::fails);
    EXPECT_FALSE(without.explained);
    EXPECT_THAT(without.text, HasSubstr("| not explained |"));

    const Judged confirmed = judged(explained_claim(kCoarserIsFewer), flown());
    EXPECT_EQ(confirmed.outcome, Outcome::fails);
    EXPECT_TRUE(confirmed.explained);
    EXPECT_THAT(confirmed.text, HasSubstr("| the tolerance is too fine (triangles.mean"));

    FlownExperiment same = flown();
    for (CellRecord& record : same.cells) record.triangles->mean = 400;
    const Judged refuted = judged(explained_claim(kCoarserIsFewer), same);
    EXPECT_EQ(refuted.outcome, Outcome::fails);
    EXPECT_FALSE(refuted.explained);
    EXPECT_THAT(refuted.text, HasSubstr("| not explained |"));

    FlownExperiment failed = flown();
    failed.cells[5].status = CellStatus::crashed;
    EXPECT_FALSE(judged(explained_claim(kCoarserIsFewer), failed).explained);
    // One that is confirmed is enough.
    EXPECT_TRUE(judged(explained_claim(explanation("kind = \"bound\"\nof = { field = "
                                                   "\"triangles.mean\", tau = 4 }\nmost = 1\n") +
                                       kCoarserIsFewer),
                       flown())
                    .explained);
}

TEST(Judge, what_holds_needs_no_explanation) {
    FlownExperiment fewer = flown();
    for (CellRecord& record : fewer.cells) *record.triangles->mean /= 2;
    const Judged holds = judged(explained_claim(kCoarserIsFewer), fewer);
    EXPECT_EQ(holds.outcome, Outcome::holds);
    EXPECT_FALSE(holds.explained);
    EXPECT_THAT(holds.text, testing::Not(HasSubstr("the tolerance is too fine")));
    EXPECT_THAT(holds.text, testing::Not(HasSubstr("not explained")));
}

TEST(Judge, the_overview_counts_what_is_explained) {
    const ScratchFolder folder;
    const Paper paper =
        read_paper(test::paper_file(folder.path(), explained_claim(kCoarserIsFewer)));
    PaperOutcome outcome;
    outcome.paper = &paper;
    outcome.evidence.experiments["flight"] = flown();
    outcome.verdicts = judge(paper, outcome.evidence, {});
    EXPECT_EQ(overview_markdown({outcome}, "there.md"),
              "| paper | claims | judged | holds | does not hold | of these explained | depends on "
              "the reading | not decided | cannot be judged here |\n"
              "|---|---:|---:|---:|---:|---:|---:|---:|---:|\n"
              "| [A paper](there.md#paper) | 1 | 1 | 0 | 1 | 1 | 0 | 0 | 0 |\n");
    const Json::Value json = to_json({outcome})["papers"][0]["claims"][0];
    EXPECT_TRUE(json["explained"].asBool());
    EXPECT_TRUE(json["readings"][0]["explanations"][0]["confirmed"].asBool());
    EXPECT_EQ(json["readings"][0]["findings"][0]["cells"][0], "flight/refined__tau=1__r0");
}

TEST(Judge, an_explanation_without_an_experiment_is_refused) {
    const auto refusal = [](const std::string& text) -> std::string {
        try {
            (void)judged(text, flown());
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_THAT(
        refusal(explained_claim(explanation(
            "kind = \"bound\"\nof = { field = \"frame_ms.median\", tau = 1 }\nleast = 0\n"))),
        HasSubstr("this explanation asks only for what the claim itself flies"));
}

TEST(Judge, an_empty_value_selects_any) {
    const std::string claim_at_one = R"([[claim]]
id = "C1"
words = "It is so"
place = "section 1"
select = { experiment = "flight", method = "refined", tau = 1, skirts = "no" }
[[claim.test]]
kind = "bound"
most = 400
)";
    EXPECT_THROW((void)judged(claim_at_one + "of = \"triangles.mean\"\n", flown()), InputError);
    EXPECT_EQ(judged(claim_at_one + "of = { field = \"triangles.mean\", skirts = \"\" }\n", flown())
                  .outcome,
              Outcome::holds);
}

TEST(Judge, curves_stand_over_the_mean_of_their_own_baseline) {
    const ScratchFolder folder;
    const Paper paper = read_paper(test::paper_file(folder.path(), R"([[figure]]
id = "8"
title = "Figure 8"
column = "fps"
baseline = "slow"
select = { experiment = "flight", method = "refined" }
[[figure.curve]]
title = "slow"
select = { tau = 1 }
points = [[0, 50], [0.5, 100], [1, 150]]
[[figure.curve]]
title = "fast"
select = { tau = 4 }
points = [[0, 300], [1, 100]]
[[figure.curve]]
title = "kept"
select = { tau = 2 }
)"));
    Evidence evidence;
    evidence.experiments["flight"] = flown();
    auto& frames = evidence.experiments["flight"].frames;
    frames["refined__tau=1__r0"].columns["wall_ms"] = {10, 30};
    frames["refined__tau=1__r1"].columns["wall_ms"] = {12, 34};
    frames["refined__tau=4__r0"].columns["wall_ms"] = {4, 5};
    const std::vector<CurvePair> pairs = curve_pairs(paper.figures.at(0), evidence);
    ASSERT_EQ(pairs.size(), 3U);
    EXPECT_EQ(pairs[0].published, (CurvePair::Points{{0, 0.5}, {0.5, 1}, {1, 1.5}}));
    EXPECT_EQ(pairs[1].published, (CurvePair::Points{{0, 3}, {1, 1}}));
    EXPECT_DOUBLE_EQ(*pairs[1].published_mean, 2);
    // Medians are 10 and 30 ms: 20 ms on the mean are 50 frames a second.
    ASSERT_EQ(pairs[0].ours.size(), 2U);
    EXPECT_DOUBLE_EQ(pairs[0].ours[0].second, 2);
    EXPECT_DOUBLE_EQ(pairs[0].ours[1].second, 1000.0 / 30 / 50);
    EXPECT_DOUBLE_EQ(*pairs[0].our_mean, 1);
    EXPECT_DOUBLE_EQ(*pairs[1].our_mean, 1000 / 4.5 / 50);
    EXPECT_TRUE(pairs[2].ours.empty());
    EXPECT_EQ(pairs[2].why_not, "its frames were not kept");

    PaperOutcome outcome;
    outcome.paper = &paper;
    outcome.evidence = evidence;
    EXPECT_THAT(to_markdown({outcome}), HasSubstr("| fast | 2 | 4.444 |"));
    EXPECT_THAT(to_html({outcome}), HasSubstr("fast, the paper"));
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
