#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "api/error.h"
#include "reproduce/paper.h"
#include "support/paper_files.h"

namespace lodbench::reproduce {
namespace {

using test::ScratchFolder;
using testing::HasSubstr;

std::string refusal(const std::string& rest) {
    const ScratchFolder folder;
    try {
        (void)read_paper(test::paper_file(folder.path(), rest));
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

const std::string kClaim = R"([[claim]]
id = "C1"
words = "It is so"
place = "section 1"
select = { experiment = "flight" }
)";

TEST(ReadPaper, every_paper_of_the_tree_is_read) {
    int read = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(LODBENCH_SOURCE_DIR "/scenarios/papers")) {
        const auto file = entry.path() / (entry.path().filename().string() + ".toml");
        if (!entry.is_directory()) continue;
        ASSERT_TRUE(std::filesystem::exists(file)) << "a paper's folder holds NAME/NAME.toml";
        const Paper paper = read_paper(file);
        ++read;
        EXPECT_GE(paper.claims.size(), 5U) << file;
        for (const Experiment& experiment : paper.experiments) {
            for (const auto& scenario : experiment.scenarios) {
                EXPECT_NO_THROW((void)scenario::load_scenario(scenario, experiment.overrides));
            }
        }
    }
    EXPECT_GE(read, 1);
}

TEST(ReadPaper, every_scenario_of_a_papers_folder_is_flown_by_one_of_its_experiments) {
    namespace fs = std::filesystem;
    int scenarios = 0;
    for (const auto& entry : fs::directory_iterator(LODBENCH_SOURCE_DIR "/scenarios/papers")) {
        if (!entry.is_directory()) continue;
        const auto own = entry.path() / (entry.path().filename().string() + ".toml");
        std::set<fs::path> flown;
        for (const Experiment& experiment : read_paper(own).experiments) {
            for (const auto& file : experiment.scenarios) flown.insert(fs::weakly_canonical(file));
        }
        for (const auto& file : fs::directory_iterator(entry.path())) {
            if (file.path() == own || file.path().extension() != ".toml") continue;
            ++scenarios;
            EXPECT_TRUE(flown.contains(fs::weakly_canonical(file.path()))) << file.path();
        }
    }
    EXPECT_GE(scenarios, 10);
}

TEST(ReadPaper, what_stands_in_the_file_is_there) {
    const ScratchFolder folder;
    const Paper paper = read_paper(test::paper_file(folder.path(), R"(repetitions = 4
match = { triangles = 100 }
[experiment.override]
"flight.frames" = 3
[[experiment.method]]
id = "refined"
tau = [0.5, 2]
[[table]]
id = "1"
title = "Table 1"
rows_are = "tau"
field = "fps"
baseline_column = "b"
select = { experiment = "flight", method = "refined" }
[[table.column]]
title = "a"
[[table.column]]
title = "b"
[[table.row]]
title = "one half"
select = { tau = 0.5 }
values = [10, "-"]
)" + kClaim + R"([[claim.test]]
kind = "ratio"
of = { field = "fps * triangles.mean", tau = 0.5 }
to = "frame_ms.median"
least = 1
for_each = [{ tau = [1, 2] }, { tau = 3, k = "a" }]
)"));
    EXPECT_EQ(paper.id, "paper");
    ASSERT_EQ(paper.experiments.size(), 1U);
    const Experiment& experiment = paper.experiments[0];
    EXPECT_EQ(experiment.match->value, 100);
    EXPECT_EQ(experiment.overrides.values().at("run.repetitions").toml, "4");
    const auto scenario = scenario::load_scenario(experiment.scenarios[0], experiment.overrides);
    EXPECT_EQ(scenario.frames, 3);
    ASSERT_EQ(scenario.methods.size(), 1U);
    EXPECT_EQ(scenario.methods[0].settings[0].second, (std::vector<std::string>{"0.5", "2"}));
    ASSERT_EQ(paper.tables.size(), 1U);
    EXPECT_EQ(paper.tables[0].rows[0].values[0], 10);
    EXPECT_FALSE(paper.tables[0].rows[0].values[1]);
    EXPECT_EQ(paper.tables[0].baseline_of(0, 0), std::pair(std::size_t(0), std::size_t(1)));
    const reproduce::Test& test = paper.claims[0].tests[0];
    EXPECT_EQ(test.of->selection.params.at("tau"), "0.5");
    EXPECT_TRUE(test.of->figure.is_time());
    ASSERT_EQ(test.for_each.size(), 3U);
    EXPECT_EQ(test.for_each[1].params.at("tau"), "2");
    EXPECT_EQ(test.for_each[2].words(), "k=a, tau=3");
}

const std::string kFigure = R"([[figure]]
id = "8"
title = "Figure 8"
column = "triangles"
baseline = "a"
[[figure.curve]]
title = "a"
)";

TEST(ReadPaper, mistakes_are_told_by_line_and_remedy) {
    const std::string test = kClaim + "[[claim.test]]\n";
    const std::pair<std::string, std::string> cases[] = {
        {test + "kind = \"bound\"\nof = \"frame_ms.mediam\"\nmost = 1\n",
         "paper.toml:17: \"frame_ms.mediam\" is no number of a cell; did you mean "
         "frame_ms.median?"},
        {test + "kind = \"bound\"\nof = \"fps +\"\nmost = 1\n",
         "paper.toml:17: \"+\" in \"fps +\": fields are joined by * and /"},
        {test + "kind = \"bound\"\nof = \"frames.triangles@2\"\nmost = 1\n",
         "paper.toml:17: \"frames.triangles@2\" is no figure of a frame"},
        {test + "kind = \"bound\"\nof = \"frames.triangels@0\"\nmost = 1\n",
         "is no figure of a frame"},
        {test + "kind = \"bound\"\nof = \"fps *\"\nmost = 1\n", "ends without a field"},
        {test + "kind = \"bounds\"\nof = \"fps\"\nmost = 1\n",
         "paper.toml:16: [[claim.test]] kind = \"bounds\": no such predicate; did you mean bound?"},
        {test + "kind = \"bound\"\nof = \"fps\"\n", "least is missing: write least, most, above"},
        {test + "kind = \"ratio\"\nof = \"fps\"\nleast = 1\n", "to is missing"},
        {test + "kind = \"bound\"\nof = \"fps\"\nto = \"fps\"\nleast = 1\n",
         "to = \"fps\": kind = \"bound\" has no use for it"},
        {test + "kind = \"rises\"\nof = \"fps\"\nover = { tau = 1 }\n",
         "write two selections or more"},
        {test + "kind = \"published\"\ntable = \"9\"\nwithin = 2\n",
         "table = \"9\": no [[table]] of this id stands above"},
        {test + "kind = \"bound\"\nof = { field = \"fps\", experiment = \"fligth\" }\nmost = 1\n",
         "there is no experiment \"fligth\"; did you mean flight?"},
        {kClaim, "write [[claim.test]], or unjudged"},
        {kClaim + "unjudged = \"why\"\nwrods = 1\n",
         "paper.toml:16: [[claim]] \"wrods\" is not a key of a paper; did you mean words?"},
        {kClaim + "unjudged = \"why\"\nneeds = [\"luck\"]\n", "write \"gpu\", \"terrain\" or both"},
        {"[[experiment]]\nid = \"flight\"\ndid = \"x\"\nscenarios = [\"tiny.toml\"]\n",
         "there twice"},
        {"[[experiment]]\nid = \"a/b\"\ndid = \"x\"\nscenarios = [\"tiny.toml\"]\n",
         "ids are 1 to 64 of"},
        {"[[experiment]]\nid = \"b\"\ndid = \"x\"\nscenarios = [\"no.toml\"]\n", "no.toml"},
        {kClaim + "unjudged = \"why\"\n[[claim.explanation]]\nwords = \"so\"\n",
         "write [[claim.explanation.test]]: figures decide"},
        {test +
             "kind = \"bound\"\nof = \"fps\"\nmost = 1\n[[claim.explanation]]\nwords = \"so\"\n"
             "select = { experiment = \"fligth\" }\n[[claim.explanation.test]]\nkind = \"bound\"\n"
             "of = \"fps\"\nmost = 1\n",
         "there is no experiment \"fligth\"; did you mean flight?"},
        {kFigure + "points = [[0.5, 1], [0.5, 2]]\n", "the parts rising from 0 to 1"},
        {kFigure + "points = [[0, 1], [2, 2]]\n", "paper.toml:17: "},
        {kFigure + "points = [0, 1]\n", "write a list of [part of the flight, value]"},
        {"[[figure]]\nid = \"8\"\ntitle = \"t\"\ncolumn = \"tringles\"\n",
         "did you mean triangles?"},
        {"[[figure]]\nid = \"8\"\ntitle = \"t\"\ncolumn = \"fps\"\n[[figure.curve]]\ntitle = "
         "\"a\"\n",
         "baseline is missing"},
        {"match = { error_px = 1, triangles = 5 }\n", "write one of error_px"},
    };
    for (const auto& [rest, expected] : cases) EXPECT_THAT(refusal(rest), HasSubstr(expected));
}

TEST(ReadPaper, published_times_need_a_baseline_to_be_compared) {
    const std::string table = R"([[table]]
id = "1"
title = "Table 1"
rows_are = "x"
field = "FIELD"
select = { experiment = "flight" }
[[table.column]]
title = "a"
[[table.row]]
title = "r"
values = [10]
)" + kClaim + "[[claim.test]]\nkind = \"published\"\ntable = \"1\"\nwithin = 2\n";
    const auto with = [&](const std::string& field) {
        std::string text = table;
        return refusal(text.replace(text.find("FIELD"), 5, field));
    };
    EXPECT_THAT(with("fps"), HasSubstr("compare by ratios alone"));
    EXPECT_EQ(with("triangles.mean"), "accepted");
}

}  // namespace
}  // namespace lodbench::reproduce
