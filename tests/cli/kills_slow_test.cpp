// A hundred kills over five commands: each goes on, or is given again, to the result of an
// undisturbed one, and leaves nothing half-written.

#include <gtest/gtest.h>

#include "cli/kills.h"

namespace lodbench::test {
namespace {

constexpr int kKillsEach = 20;

class Kills : public testing::Test {
protected:
    [[nodiscard]] fs::path out(const std::string& name) const { return scratch_.path() / name; }
    /// A command that flies the tiny scenario into a folder of the command's name.
    [[nodiscard]] std::vector<std::string> command(const std::string& name,
                                                   const std::vector<std::string>& more,
                                                   const std::string& folder) const {
        std::vector<std::string> arguments = {
            name, tiny_scenario(scratch_.path(), "repetitions = 3\n").string(), "--out",
            out(folder).string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
    /// The command, flown undisturbed and killed, gives the same cells and leaves no temporary
    /// file.
    void expect_same_cells(const std::string& name, const std::vector<std::string>& more,
                           const char* document) const {
        ASSERT_EQ(run_lodbench(command(name, more, "undisturbed"), scratch_.path()).status, 0);
        after_kills(resumed(command(name, more, "killed")), scratch_.path(),
                    out("killed") / document, kKillsEach);
        EXPECT_EQ(lockstep_of(out("killed")), lockstep_of(out("undisturbed")));
        for (const auto& entry : fs::recursive_directory_iterator(out("killed"))) {
            EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
        }
    }

    const ScratchFolder scratch_;
};

TEST_F(Kills, run_goes_on_to_the_same_cells) {
    expect_same_cells("run", {"--method", "template", "--method", "refined"}, "summary.md");
}

TEST_F(Kills, sweep_goes_on_to_the_same_cells) {
    expect_same_cells("sweep", {"--method", "refined", "--points", "3"}, "trade.md");
}

TEST_F(Kills, match_goes_on_to_the_same_cells_and_the_same_search) {
    expect_same_cells("match", {"--method", "refined", "--triangles", "100", "--probes", "5"},
                      "match.md");
    EXPECT_EQ(text_of(out("killed") / "match.json"), text_of(out("undisturbed") / "match.json"));
}

TEST_F(Kills, terrain_import_is_whole_or_absent) {
    const std::vector<std::string> source = {"terrain",
                                             "synth",
                                             "ridged",
                                             "--rows",
                                             "1025",
                                             "--columns",
                                             "1025",
                                             "--spacing",
                                             "10",
                                             "-o",
                                             out("source.raw").string()};
    ASSERT_EQ(run_lodbench(source, scratch_.path()).status, 0);
    const auto import = [&](const char* name) {
        return std::vector<std::string>{"terrain", "import", out("source.raw").string(), "-o",
                                        out(name).string()};
    };
    ASSERT_EQ(run_lodbench(import("whole.tiles"), scratch_.path()).status, 0);
    EXPECT_EQ(
        after_kills(import("killed.tiles"), scratch_.path(), out("killed.tiles"), kKillsEach, 100),
        text_of(out("whole.tiles")));
}

TEST_F(Kills, report_is_whole_or_absent) {
    ASSERT_EQ(run_lodbench(command("run", {"--method", "template"}, "run"), scratch_.path()).status,
              0);
    const auto report = [&](const char* name) {
        return std::vector<std::string>{"report", out("run").string(), "-o", out(name).string()};
    };
    ASSERT_EQ(run_lodbench(report("whole.html"), scratch_.path()).status, 0);
    EXPECT_EQ(
        after_kills(report("killed.html"), scratch_.path(), out("killed.html"), kKillsEach, 60),
        text_of(out("whole.html")));
}

}  // namespace
}  // namespace lodbench::test
