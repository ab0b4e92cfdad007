#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "support/paper_files.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;

/// `refined` at two settings of its knob, and a method that is not there.
std::string paper_text(const std::string& published) {
    return R"([experiment.override]
"flight.frames" = 2
[[experiment.method]]
id = "refined"
tau = [0.01, 100]
[[experiment.method]]
id = "nowhere"
[[table]]
id = "1"
title = "Table 1"
rows_are = "tau"
field = "triangles.mean"
baseline_row = "coarse"
select = { experiment = "flight", method = "refined" }
[[table.column]]
title = "triangles"
[[table.row]]
title = "coarse"
select = { tau = 100 }
values = [10]
[[table.row]]
title = "fine"
select = { tau = 0.01 }
values = [)" +
           published + R"(]
[[claim]]
id = "same"
words = "As many triangles at each tau: a ramp is flat"
place = "table 1"
[[claim.test]]
kind = "published"
table = "1"
within = 1.01
[[claim]]
id = "absent"
words = "Another method draws fewer"
place = "table 2"
select = { experiment = "flight" }
[[claim.test]]
kind = "bound"
of = { field = "triangles.mean", method = "nowhere" }
most = 1
)";
}

std::string verdict(const fs::path& out, int claim) {
    const Json::Value json = results::parse_json(text_of(out / "verdicts.json"), "verdicts.json");
    return json["papers"][0]["claims"][claim]["verdict"].asString();
}

TEST(Reproduce, flies_judges_and_writes) {
    const ScratchFolder folder;
    const fs::path paper = paper_file(folder.path(), paper_text("10"));
    const fs::path out = folder.path() / "out";
    const auto run = run_lodbench({"reproduce", paper, "--out", out}, folder.path());
    EXPECT_EQ(run.status, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("cannot be judged here"));
    EXPECT_EQ(verdict(out, 0), "holds") << text_of(out / "reproduce.md");
    EXPECT_EQ(verdict(out, 1), "cannot be judged here");
    EXPECT_THAT(text_of(out / "reproduce.md"), HasSubstr("there is no method nowhere here"));
    EXPECT_THAT(
        text_of(out / "reproduce.md"),
        HasSubstr("Terrain: synthetic ramp, 17 x 17 samples, in the place of the paper's: a ramp"));
    EXPECT_THAT(text_of(out / "reproduce.html"), HasSubstr("</html>"));
    EXPECT_TRUE(fs::exists(out / "paper" / "flight" / "cells.jsonl"));
}

TEST(Reproduce, judges_anew_what_was_flown_when_a_published_figure_changes) {
    const ScratchFolder folder;
    const fs::path paper = paper_file(folder.path(), paper_text("10"));
    const fs::path out = folder.path() / "out";
    ASSERT_EQ(run_lodbench({"reproduce", paper, "--out", out}, folder.path()).status, 0);
    const std::string cells = text_of(out / "paper" / "flight" / "cells.jsonl");
    paper_file(folder.path(), paper_text("11"));
    EXPECT_EQ(run_lodbench({"reproduce", paper, "--out", out}, folder.path()).status, 2);
    const auto again = run_lodbench({"reproduce", paper, "--out", out, "--resume"}, folder.path());
    EXPECT_EQ(again.status, 0) << again.output;
    EXPECT_EQ(verdict(out, 0), "does not hold");
    EXPECT_EQ(text_of(out / "paper" / "flight" / "cells.jsonl"), cells);
    const auto strict =
        run_lodbench({"reproduce", paper, "--out", out, "--resume", "--strict"}, folder.path());
    EXPECT_EQ(strict.status, 1);
}

TEST(Reproduce, a_search_that_does_not_come_to_its_target_judges_nothing) {
    const ScratchFolder folder;
    const fs::path paper = paper_file(folder.path(), R"(match = { triangles = 1e9 }
probes = 2
[[experiment.method]]
id = "refined"
[[claim]]
id = "equal"
words = "Fast at a billion triangles"
place = "section 1"
select = { experiment = "flight", method = "refined" }
[[claim.test]]
kind = "bound"
of = "triangles.mean"
least = 0
)");
    const fs::path out = folder.path() / "out";
    const auto run = run_lodbench({"reproduce", paper, "--out", out}, folder.path());
    EXPECT_EQ(run.status, 0) << run.output;
    EXPECT_EQ(verdict(out, 0), "cannot be judged here");
    EXPECT_THAT(text_of(out / "reproduce.md"), HasSubstr("does not come to mean triangles"));
}

TEST(Reproduce, a_plan_flies_nothing) {
    const ScratchFolder folder;
    const fs::path paper = paper_file(folder.path(), paper_text("10"));
    const auto run = run_lodbench({"reproduce", paper, "--plan"}, folder.path());
    EXPECT_EQ(run.status, 0);
    EXPECT_THAT(run.output, HasSubstr("expected: not known; --from DIR"));
    EXPECT_FALSE(fs::exists(folder.path() / "lodbench-results"));
}

TEST(Reproduce, what_is_wrong_in_a_paper_is_refused_before_anything_is_flown) {
    const ScratchFolder folder;
    const fs::path out = folder.path() / "out";
    const auto refusal = [&](const std::string& from, const std::string& to) {
        std::string text = paper_text("10");
        const fs::path paper =
            paper_file(folder.path(), text.replace(text.find(from), from.size(), to));
        const auto run = run_lodbench({"reproduce", paper, "--out", out}, folder.path());
        EXPECT_EQ(run.status, 2) << run.output;
        EXPECT_FALSE(fs::exists(out));
        return run.output;
    };
    EXPECT_THAT(refusal("tau = [0.01, 100]", "tau = [0.01, -1]"), HasSubstr("paper.toml:"));
    EXPECT_THAT(refusal("tau = [0.01, 100]", "tua = [0.01, 100]"), HasSubstr("tau"));
    EXPECT_THAT(refusal("tau = 100 }", "tau = 99 }"),
                HasSubstr("no cell of experiment flight has refined, tau=99"));
}

TEST(Reproduce, a_claim_that_does_not_hold_is_explained_by_an_experiment) {
    const ScratchFolder folder;
    const std::string explanation = R"([[claim]]
id = "few"
words = "Fewer than ten triangles"
place = "table 3"
select = { experiment = "flight", method = "refined" }
[[claim.test]]
kind = "bound"
of = { field = "triangles.mean", tau = 100 }
below = 1
[[claim.explanation]]
words = "none are left out at any tolerance"
[[claim.explanation.test]]
kind = "ratio"
of = { field = "triangles.mean", tau = 0.01 }
to = { field = "triangles.mean", tau = 100 }
)";
    const fs::path out = folder.path() / "out";
    fs::path paper = paper_file(folder.path(), paper_text("10") + explanation + "most = 1\n");
    ASSERT_EQ(run_lodbench({"reproduce", paper, "--out", out}, folder.path()).status, 0);
    EXPECT_EQ(verdict(out, 2), "does not hold");
    EXPECT_THAT(text_of(out / "reproduce.md"), HasSubstr("| none are left out at any tolerance ("));
    EXPECT_THAT(text_of(out / "overview.md"),
                HasSubstr("| [A paper](reproduce.md#paper) | 3 | 2 | 1 | 1 | 1 |"));
    paper = paper_file(folder.path(), paper_text("10") + explanation + "above = 1\n");
    ASSERT_EQ(run_lodbench({"reproduce", paper, "--out", out, "--resume"}, folder.path()).status,
              0);
    EXPECT_EQ(verdict(out, 2), "does not hold");
    EXPECT_THAT(text_of(out / "reproduce.md"), HasSubstr("| not explained |"));
}

TEST(Reproduce, refuses_folders_that_are_not_its_own) {
    const ScratchFolder folder;
    const fs::path paper = paper_file(folder.path(), paper_text("10"));
    const auto run = run_lodbench({"reproduce", paper, "--out", folder.path()}, folder.path());
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.output, HasSubstr("not a folder that `lodbench reproduce` began"));
    EXPECT_FALSE(fs::exists(folder.path() / "reproduce.json"));
}

TEST(Reproduce, an_unknown_paper_is_told_with_those_that_are_known) {
    const ScratchFolder folder;
    const auto run = run_lodbench({"reproduce", "nobody"}, folder.path());
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.output, HasSubstr("there is no paper 'nobody'; known: "));
}

}  // namespace
}  // namespace lodbench::test
