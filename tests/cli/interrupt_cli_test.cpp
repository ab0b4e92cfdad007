// Ctrl-C at random moments: said is what is kept and what goes on, and that ends as if nothing had
// been.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <sstream>

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
    [[nodiscard]] fs::path out(const std::string& name) const { return scratch_.path() / name; }

    [[nodiscard]] Arguments command(const std::string& name, const Arguments& more) const {
        Arguments arguments = {name, tiny_scenario(scratch_.path(), "repetitions = 3\n").string(),
                               "--method", "refined"};
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

    /// Flies the command undisturbed, then into `folder` with five interrupts, SIGINT and SIGTERM
    /// in turn, each a random while after something more was kept.
    void expect_same_after_five(const std::string& name, const Arguments& more,
                                const std::string& folder) const {
        const auto into = [&](const std::string& place) {
            Arguments arguments = more;
            arguments.insert(arguments.end(), {"--out", out(place).string()});
            return command(name, arguments);
        };
        ASSERT_EQ(run_lodbench(into("undisturbed"), scratch_.path()).status, 0);
        std::mt19937 random(15);
        std::string again;
        for (int i = 0; i < 5; ++i) {
            const std::size_t before = kept(out(folder));
            const pid_t process = i == 0 ? start(into(folder)) : start_in_shell(again);
            await([&] { return kept(out(folder)) > before || base::has_ended(process); });
            usleep(useconds_t(1000 * (random() % 100)));
            kill(process, i % 2 == 0 ? SIGINT : SIGTERM);
            ASSERT_EQ(ending_of(process), kExitInterrupted) << i << "\n" << text_of(log());
            EXPECT_THAT(text_of(log()),
                        HasSubstr(fmt::format("interrupted; {} finished cell", kept(out(folder)))));
            again = command_that_goes_on();
            EXPECT_EQ(again.find("--resume"), again.rfind("--resume")) << "said once: " << again;
        }
        EXPECT_EQ(shell(again), 0) << again << "\n" << text_of(log());
        EXPECT_EQ(lockstep_of(out(folder)), lockstep_of(out("undisturbed")));
    }

    /// Finished cells, those of a search included.
    static std::size_t kept(const fs::path& folder) {
        std::size_t count = 0;
        std::error_code none;
        for (const auto& entry : fs::recursive_directory_iterator(folder, none)) {
            if (entry.path().filename() != "cells.jsonl") continue;
            const std::string text = text_of(entry.path());
            count += std::size_t(std::ranges::count(text, '\n'));
        }
        return count;
    }

    /// The command as a shell reads it, with its words in `log`.
    [[nodiscard]] pid_t start_in_shell(const std::string& line) const {
        const std::string text =
            fmt::format("cd '{}' && exec {} >log 2>&1", scratch_.path().string(), line);
        const pid_t child = fork();
        if (child == 0) {
            execl("/bin/sh", "sh", "-c", text.c_str(), nullptr);
            _exit(127);
        }
        return child;
    }

    const ScratchFolder scratch_;
};

/// Of tables in Markdown the text, without the columns of times and of what depends on them.
std::string table_without_times(const fs::path& file) {
    std::istringstream stream(text_of(file));
    std::string text;
    std::vector<bool> timed;
    for (std::string line; std::getline(stream, line);) {
        if (!line.starts_with('|')) {
            timed.clear();
            // A hypervolume is of errors and times.
            if (!line.starts_with("Hypervolume")) text += line + "\n";
            continue;
        }
        std::istringstream fields(line);
        const bool heading = timed.empty();
        std::size_t i = 0;
        for (std::string field; std::getline(fields, field, '|'); ++i) {
            field = field.substr(0, field.find_last_not_of(' ') + 1);  // widths are those of times
            if (heading) {
                timed.push_back(field.ends_with(" ms (range)") || field.ends_with("prepare s") ||
                                field.ends_with("front") || field.ends_with("hypervolume"));
            }
            if (!timed.at(i) && field.find("---") == field.npos) text += field + "|";
        }
        text += "\n";
    }
    return text;
}

TEST_F(Interrupt, a_sweep_goes_on_by_the_command_that_each_of_five_says_to_the_same_result) {
    // The name has a blank, so that the command has to be quoted.
    expect_same_after_five("sweep", {"--points", "3"}, "inter rupted");
    EXPECT_EQ(table_without_times(out("inter rupted") / "trade.md"),
              table_without_times(out("undisturbed") / "trade.md"));
}

TEST_F(Interrupt, a_match_goes_on_by_the_command_that_each_of_five_says_to_the_same_search) {
    expect_same_after_five("match", {"--triangles", "100", "--probes", "5"}, "interrupted");
    EXPECT_EQ(table_without_times(out("interrupted") / "match.md"),
              table_without_times(out("undisturbed") / "match.md"));
    EXPECT_EQ(text_of(out("interrupted") / "match.json"),
              text_of(out("undisturbed") / "match.json"));
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
