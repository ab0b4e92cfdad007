// What is told of a plugin that stands in for another or was compiled otherwise, and debugging one.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/ptrace.h>

#include <cerrno>
#include <csignal>

#include "api/method.h"
#include "report/table.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;
using Arguments = std::vector<std::string>;

class PluginCli : public testing::Test {
protected:
    [[nodiscard]] fs::path out() const { return scratch_.path() / "out"; }
    [[nodiscard]] Arguments command(const std::string& plugin, const std::string& method,
                                    const std::string& run = "") const {
        return {"run",          tiny_scenario(scratch_.path(), run).string(),
                "--plugin-dir", broken_plugin_folder(plugin),
                "--method",     method,
                "--out",        out().string()};
    }
    [[nodiscard]] Json::Value run_json() const {
        return results::parse_json(text_of(out() / "run.json"), "run.json");
    }
    /// Said in the terminal, and beside the figures.
    void expect_warned(const std::string& terminal, const std::string& words) const {
        EXPECT_THAT(terminal, HasSubstr("warning: " + words));
        EXPECT_THAT(terminal, testing::ContainsRegex("\nwarnings  [0-9]+, in " + out().string() +
                                                     "/summary.md\nresults   "));
        EXPECT_THAT(text_of(out() / "summary.md"), HasSubstr(report::markdown_text(words)));
        const Json::Value run = run_json();
        const Json::Value& warnings = run["warnings"];
        EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [&](const Json::Value& warning) {
            return warning.asString().find(words) != std::string::npos;
        })) << warnings;
    }

    const ScratchFolder scratch_;
};

TEST_F(PluginCli, one_of_plugin_dir_is_used_in_the_place_of_lodbench_s_own_and_that_is_told) {
    const Finished finished = run_lodbench(command("takes_an_id", "refined"), scratch_.path());
    ASSERT_EQ(finished.status, 0) << finished.output;
    const std::string theirs = broken_plugin_folder("takes_an_id") + "/takes_an_id.so";
    const std::string ours = broken_plugin_folder("stand_ins") + "/stand_ins.so";
    const std::string words = fmt::format(
        "method 'refined' is held by two plugins: {} is used, for its folder goes first; {} "
        "is not; remove one, or give its method another id",
        theirs, ours);
    expect_warned(finished.output, words);
    // That one draws nothing.
    EXPECT_EQ(cells_of(out()).at(0)["triangles"]["max"].asInt(), 0);
    const Json::Value run = run_json();
    for (const Json::Value& plugin : run["plugins"]) {
        if (plugin["path"] == theirs) {
            EXPECT_EQ(plugin["methods"][0]["id"], "refined");
        }
        if (plugin["path"] != ours) continue;
        ASSERT_EQ(plugin["methods"].size(), 2U);
        for (const Json::Value& method : plugin["methods"]) EXPECT_NE(method["id"], "refined");
        EXPECT_EQ(plugin["left_out"][0], words);
    }
}

TEST_F(PluginCli, list_tells_what_is_left_out) {
    const Finished listed = run_lodbench(
        {"list", "--plugin-dir", broken_plugin_folder("takes_an_id")}, scratch_.path());
    EXPECT_EQ(listed.status, 0);
    EXPECT_THAT(listed.output, HasSubstr("warning: method 'refined' is held by two plugins: "));
}

TEST_F(PluginCli, one_that_was_compiled_otherwise_is_warned_of_and_others_are_not) {
    const Finished other =
        run_lodbench(command("compiled_otherwise", "compiled-otherwise"), scratch_.path());
    ASSERT_EQ(other.status, 0) << other.output;
    expect_warned(other.output,
                  fmt::format("plugin {}/compiled_otherwise.so of method 'compiled-otherwise' was "
                              "compiled not optimised",
                              broken_plugin_folder("compiled_otherwise")));
    EXPECT_THAT(other.output,
                HasSubstr(fmt::format("lodbench {}: its times do not compare", LODBENCH_COMPILED)));
    EXPECT_THAT(other.output, HasSubstr("build it with lodbench's CMAKE_BUILD_TYPE"));
    fs::remove_all(out());
    const Finished alike = run_lodbench(command("healthy", "healthy"), scratch_.path());
    EXPECT_EQ(alike.status, 0);
    EXPECT_THAT(alike.output, testing::Not(HasSubstr("was compiled")));
}

/// The number after the words in what is printed, once it is there.
pid_t process_in(const fs::path& log, const std::string& words) {
    for (int i = 0; i < 6000; ++i, usleep(5000)) {
        const std::string text = text_of(log);
        const std::size_t at = text.find(words);
        if (at != text.npos && text.find('\n', at) != text.npos) {
            return pid_t(std::stol(text.substr(at + words.size())));
        }
    }
    return 0;
}

TEST_F(PluginCli, a_cell_waits_for_a_debugger_beyond_its_time_limit_and_goes_on_with_it) {
    Arguments arguments =
        command("healthy", "healthy", "repetitions = 1\ncell_time_limit_s = 0.5\n");
    arguments.emplace_back("--wait-for-debugger");
    const fs::path log = scratch_.path() / "log";
    const pid_t lodbench = start_lodbench(arguments, log);
    const pid_t cell = process_in(log, "healthy__tiny__r0 waits for a debugger as process ");
    ASSERT_GT(cell, 0) << text_of(log);
    EXPECT_THAT(text_of(log), HasSubstr(fmt::format("gdb -p {}", cell)));
    usleep(1'500'000);
    int status = 0;
    ASSERT_EQ(waitpid(lodbench, &status, WNOHANG), 0) << text_of(log);
    ASSERT_EQ(ptrace(PTRACE_SEIZE, cell, nullptr, nullptr), 0) << strerror(errno);
    usleep(500'000);
    // As a debugger leaves: from a stop, where the cell is still there to be stopped.
    if (ptrace(PTRACE_INTERRUPT, cell, nullptr, nullptr) == 0 &&
        waitpid(cell, &status, __WALL) == cell && WIFSTOPPED(status)) {
        EXPECT_EQ(ptrace(PTRACE_DETACH, cell, nullptr, nullptr), 0) << strerror(errno);
    }
    ASSERT_EQ(waitpid(lodbench, &status, 0), lodbench);
    EXPECT_EQ(WEXITSTATUS(status), 0) << text_of(log);
    EXPECT_EQ(cells_of(out()).at(0)["status"], "ok");
    expect_warned(text_of(log), "flown under a debugger (--wait-for-debugger): times mean nothing");
}

}  // namespace
}  // namespace lodbench::test
