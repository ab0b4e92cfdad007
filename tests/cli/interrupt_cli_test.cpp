// Ctrl-C at random moments: said is what is kept and what goes on, and that ends as if nothing had
// been.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "base/process_tree.h"
#include "cli/kills.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;
using Arguments = std::vector<std::string>;

constexpr int kExitInterrupted = 3;
constexpr int kBySignal = 1000;

class Interrupt : public testing::Test {
protected:
    [[nodiscard]] fs::path out(const char* name) const { return scratch_.path() / name; }

    [[nodiscard]] Arguments command(const std::string& name, const Arguments& more) const {
        Arguments arguments = {name, tiny_scenario(scratch_.path(), "repetitions = 3\n").string(),
                               "--method", "lindstrom"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }

    /// Starts the command in the scratch folder.
    [[nodiscard]] pid_t start(const Arguments& arguments) const {
        return start_lodbench(arguments, log(), [this] {
            if (chdir(scratch_.path().c_str()) != 0) _exit(126);
        });
    }
    [[nodiscard]] fs::path log() const { return scratch_.path() / "log"; }

    static int ending_of(pid_t process) {
        int status = 0;
        waitpid(process, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : kBySignal + WTERMSIG(status);
    }

    /// Waits, a minute at most, until `happened`.
    template <typename Happened>
    static void await(const Happened& happened) {
        for (int i = 0; i < 12000 && !happened(); ++i) usleep(5000);
        ASSERT_TRUE(happened());
    }

    /// The last line that was said: the command that goes on.
    [[nodiscard]] std::string command_that_goes_on() const {
        const std::string text = text_of(log());
        EXPECT_THAT(text, HasSubstr("lodbench: interrupted; "));
        EXPECT_THAT(text, HasSubstr(" kept in "));
        EXPECT_TRUE(text.ends_with("\n"));
        const std::size_t end = text.find_last_not_of(" \n");
        return text.substr(text.rfind('\n', end) + 1, end - text.rfind('\n', end));
    }

    [[nodiscard]] int shell(const std::string& line) const {
        const int status = std::system(
            fmt::format("cd '{}' && {} >log 2>&1", scratch_.path().string(), line).c_str());
        return WEXITSTATUS(status);
    }

    const ScratchFolder scratch_;
};

TEST_F(Interrupt, a_sweep_says_what_is_kept_and_the_command_that_goes_on_to_the_same_result) {
    const Arguments more = {"--points", "3", "--out"};
    const auto into = [&](const char* name) {
        Arguments arguments = more;
        arguments.push_back(out(name).string());
        return command("sweep", arguments);
    };
    ASSERT_EQ(run_lodbench(into("undisturbed"), scratch_.path()).status, 0);
    std::mt19937 random(15);
    // The name has a blank, so that the command has to be quoted.
    const pid_t process = start(into("inter rupted"));
    await([&] { return fs::exists(out("inter rupted") / "run.json"); });
    usleep(useconds_t(1000 * (random() % 1500)));
    kill(process, SIGINT);
    ASSERT_EQ(ending_of(process), kExitInterrupted) << text_of(log());
    const std::size_t kept = cells_of(out("inter rupted")).size();
    EXPECT_LT(kept, 9U);
    EXPECT_THAT(text_of(log()), HasSubstr(fmt::format("interrupted; {} finished cell", kept)));
    const std::string again = command_that_goes_on();
    EXPECT_THAT(again, testing::EndsWith("--resume"));
    EXPECT_EQ(shell(again), 0) << again << "\n" << text_of(log());
    EXPECT_EQ(lockstep_of(out("inter rupted")), lockstep_of(out("undisturbed")));
    EXPECT_TRUE(fs::exists(out("inter rupted") / "trade.md"));
}

TEST_F(Interrupt, a_match_goes_on_with_its_search) {
    const pid_t process = start(
        command("match", {"--triangles", "100", "--probes", "5", "--out", out("match").string()}));
    await([&] { return fs::exists(out("match") / "search" / "lindstrom-00" / "cells.jsonl"); });
    kill(process, SIGTERM);
    ASSERT_EQ(ending_of(process), kExitInterrupted) << text_of(log());
    EXPECT_EQ(shell(command_that_goes_on()), 0) << text_of(log());
    EXPECT_TRUE(fs::exists(out("match") / "match.md"));
}

TEST_F(Interrupt, a_run_that_named_no_folder_goes_on_in_the_one_that_it_made) {
    const pid_t process = start(command("run", {}));
    const fs::path parent = scratch_.path() / "lodbench-results";
    const auto made = [&] {
        std::error_code none;
        return fs::directory_iterator(parent, none) != fs::directory_iterator() &&
               fs::exists(fs::directory_iterator(parent)->path() / "run.json");
    };
    await(made);
    kill(process, SIGINT);
    ASSERT_EQ(ending_of(process), kExitInterrupted) << text_of(log());
    const std::string again = command_that_goes_on();
    EXPECT_THAT(again, HasSubstr(" --resume --out lodbench-results/"));
    EXPECT_EQ(shell(again), 0) << text_of(log());
    EXPECT_EQ(cells_of(fs::directory_iterator(parent)->path()).size(), 3U);
    EXPECT_EQ(std::distance(fs::directory_iterator(parent), {}), 1);
}

TEST_F(Interrupt, ends_the_cell_that_is_flown_and_a_second_one_ends_at_once) {
    Arguments arguments = {"run",          tiny_scenario(scratch_.path(), "").string(),
                           "--method",     "loops",
                           "--plugin-dir", broken_plugin_folder("loops"),
                           "--out",        out("run").string()};
    const auto begun = [&](pid_t process) { return base::descendants_of(process).size() >= 2; };
    pid_t process = start(arguments);
    await([&] { return begun(process) && fs::exists(out("run") / "run.json"); });
    const std::vector<pid_t> cell = base::descendants_of(process);
    kill(process, SIGINT);
    EXPECT_EQ(ending_of(process), kExitInterrupted) << text_of(log());
    EXPECT_TRUE(std::ranges::all_of(cell, base::has_ended));
    EXPECT_THAT(text_of(log()), HasSubstr("interrupted; 0 finished cells are kept"));

    arguments.emplace_back("--resume");
    process = start(arguments);
    await([&] { return begun(process); });
    // With its keeper held, the cell takes a while to end.
    const pid_t keeper = base::children_of(process).front();
    const std::vector<pid_t> left = base::descendants_of(process);
    kill(keeper, SIGSTOP);
    kill(process, SIGINT);
    usleep(200'000);
    EXPECT_FALSE(base::has_ended(process)) << "it waits for the cell";
    kill(process, SIGINT);
    EXPECT_EQ(ending_of(process), kBySignal + SIGINT) << text_of(log());
    kill(keeper, SIGCONT);
    await([&] { return std::ranges::all_of(left, base::has_ended); });
}

}  // namespace
}  // namespace lodbench::test
