// lodbench trend, as it is typed: a history loses nothing, whatever becomes of who adds to it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sqlite3.h>
#include <sys/prctl.h>

#include <chrono>
#include <random>

#include "support/campaign_folders.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class TrendCommand : public testing::Test {
protected:
    /// A results folder of six cells, as of a run that began `number` minutes after the first.
    fs::path write_run(int number, double slower_ms = 0) const {
        FakeCampaign campaign;
        campaign.repetitions = 1;
        const auto cells = campaign.cells(int(slower_ms));
        const fs::path folder = runs() / ("run-" + std::to_string(1000 + number));
        campaign.write(folder, cells, cells, number, 1);
        Json::Value run = results::parse_json(text_of(folder / "run.json"), "run.json");
        run["started"] = fmt::format("2026-01-01T{:02}:{:02}:00Z", number / 60, number % 60);
        run["commit"] = fmt::format("c{:04}", number);
        FakeCampaign::put(folder / "run.json", results::to_text(run, true) + "\n");
        return folder;
    }
    [[nodiscard]] fs::path runs() const { return scratch_.path() / "runs"; }
    [[nodiscard]] fs::path database() const { return scratch_.path() / "db" / "trend.sqlite"; }
    [[nodiscard]] fs::path out() const { return scratch_.path() / "out"; }
    [[nodiscard]] std::vector<std::string> adding(const fs::path& folder) const {
        return {"trend", "add", folder.string(), "--db", database().string()};
    }
    Finished add(const fs::path& folder, const std::function<void()>& prepare = {}) const {
        return run_lodbench(adding(folder), scratch_.path(), prepare);
    }
    Finished show() const {
        return run_lodbench({"trend", "show", "--db", database().string(), "-o", out().string()},
                            scratch_.path());
    }
    /// Its runs are all whole, and the file is sound.
    std::size_t whole_runs() const {
        sqlite3* handle = nullptr;
        EXPECT_EQ(sqlite3_open(database().c_str(), &handle), SQLITE_OK);
        EXPECT_EQ(answer(handle, "PRAGMA integrity_check"), "ok");
        if (answer(handle, "PRAGMA user_version") == "0") {  // killed before the first was in
            sqlite3_close(handle);
            return 0;
        }
        EXPECT_EQ(answer(handle,
                         "SELECT count(*) FROM (SELECT count(*) AS cells FROM cell GROUP "
                         "BY run) WHERE cells <> 6"),
                  "0");
        EXPECT_EQ(answer(handle,
                         "SELECT count(*) FROM value WHERE figure = (SELECT id FROM figure "
                         "WHERE name = 'frame_ms.median')"),
                  answer(handle, "SELECT count(*) FROM cell"));
        const std::string count = answer(handle, "SELECT count(*) FROM run");
        EXPECT_EQ(answer(handle, "SELECT count(DISTINCT run) FROM cell"), count);
        sqlite3_close(handle);
        return std::stoul(count);
    }
    static std::string answer(sqlite3* handle, const char* sql) {
        sqlite3_stmt* statement = nullptr;
        EXPECT_EQ(sqlite3_prepare_v2(handle, sql, -1, &statement, nullptr), SQLITE_OK) << sql;
        std::string text;
        if (sqlite3_step(statement) == SQLITE_ROW) {
            text = reinterpret_cast<const char*>(sqlite3_column_text(statement, 0));
        }
        sqlite3_finalize(statement);
        return text;
    }

    void SetUp() override {
        fs::create_directories(runs());
        fs::create_directories(database().parent_path());
    }

    const ScratchFolder scratch_;
};

TEST_F(TrendCommand, adds_a_run_once_and_shows_the_step_with_its_commit) {
    for (int run = 0; run < 24; ++run) write_run(run, run < 12 ? 0 : 20);
    const Finished first = add(runs());
    ASSERT_EQ(first.status, 0) << first.output;
    EXPECT_THAT(first.output, HasSubstr("added     6 cells of run "));
    const Finished again = add(runs());
    ASSERT_EQ(again.status, 0) << again.output;
    EXPECT_THAT(again.output, HasSubstr("added     0 cells of run "));
    EXPECT_THAT(again.output, HasSubstr("; 6 were there\n"));
    EXPECT_EQ(whole_runs(), 24U);

    const Finished shown = show();
    ASSERT_EQ(shown.status, 0) << shown.output;
    // Six cells; of each the median and the mean of the frame times.
    EXPECT_THAT(shown.output, StartsWith("trends    12 steps in 24 runs, 6 series\n"));
    EXPECT_THAT(text_of(out() / "trend.md"),
                HasSubstr("| 2026-01-01T00:12:00Z | c0012 | c0011 | s0 | m0 | frame\\_ms.median | "
                          "10 | 30 | +200 % |"));
    const std::string page = text_of(out() / "trend.html");
    EXPECT_THAT(page, HasSubstr(">c0012</text>")) << "the commit stands at the step";
    const Json::Value json = results::parse_json(text_of(out() / "trend.json"), "trend.json");
    bool found = false;
    for (const Json::Value& figure : json["series"][0]["figures"]) {
        if (figure["figure"] != "frame_ms.median") continue;
        found = true;
        EXPECT_EQ(figure["steps"][0]["commit"], "c0012");
    }
    EXPECT_TRUE(found);
}

TEST_F(TrendCommand, shows_a_folder_of_results_folders_without_a_database) {
    for (int run = 0; run < 12; ++run) write_run(run, run < 6 ? 0 : 20);
    const Finished shown =
        run_lodbench({"trend", "show", runs().string(), "-o", out().string()}, scratch_.path());
    ASSERT_EQ(shown.status, 0) << shown.output;
    EXPECT_THAT(shown.output, StartsWith("trends    12 steps in 12 runs, 6 series\n"));
    const Finished neither = run_lodbench({"trend", "show", "-o", out().string()}, scratch_.path());
    EXPECT_EQ(neither.status, 2);
    EXPECT_THAT(neither.output, HasSubstr("name either a history with --db or results folders"));
}

TEST_F(TrendCommand, refuses_what_is_no_run_and_makes_no_database_for_it) {
    fs::create_directories(runs() / "notes");
    const Finished folder = add(runs());
    EXPECT_EQ(folder.status, 2) << folder.output;
    EXPECT_EQ(folder.output, "lodbench: " + (runs() / "run.json").string() +
                                 ": there is no such file; name a results folder, as `lodbench run "
                                 "--out DIR` writes it\n");
    const Finished absent = add(scratch_.path() / "nosuch");
    EXPECT_EQ(absent.status, 2);
    EXPECT_THAT(absent.output, HasSubstr("nosuch: there is no such folder; name a results folder"));
    std::ofstream(runs() / "run.json") << "{";
    EXPECT_EQ(add(runs()).status, 2);
    EXPECT_FALSE(fs::exists(database()));
}

TEST_F(TrendCommand, that_is_killed_at_any_moment_leaves_runs_whole_or_out) {
    constexpr int kRuns = 40;
    std::vector<std::string> arguments = {"trend", "add", "--db", database().string()};
    for (int run = 0; run < kRuns; ++run) arguments.push_back(write_run(run).string());
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    ASSERT_EQ(run_lodbench(arguments, scratch_.path()).status, 0);
    const auto whole = std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start);
    fs::remove(database());
    std::mt19937 random(3);
    std::size_t before = 0;
    int between = 0;
    for (int kills = 0; kills < 200 && between < 12; ++kills) {
        const pid_t child = start_lodbench(arguments, scratch_.path() / "log");
        usleep(useconds_t(random() % unsigned(whole.count())));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        if (!fs::exists(database())) continue;
        const std::size_t runs = whole_runs();
        EXPECT_GE(runs, before) << "a run that was in is lost";
        if (runs > before && runs < kRuns) ++between;
        before = runs;
        if (runs > kRuns / 2) {  // begin anew: kills belong into the middle
            fs::remove(database());
            before = 0;
        }
    }
    EXPECT_EQ(between, 12) << "too few kills came while runs were added";
    ASSERT_EQ(run_lodbench(arguments, scratch_.path()).status, 0);
    EXPECT_EQ(whole_runs(), std::size_t(kRuns));
    EXPECT_EQ(show().status, 0);
}

TEST_F(TrendCommand, by_four_at_once_adds_every_run_once) {
    constexpr int kAdders = 4;
    constexpr int kRuns = 8;  // of each, of which half are another's as well
    std::vector<std::vector<std::string>> commands(kAdders,
                                                   {"trend", "add", "--db", database().string()});
    for (int adder = 0; adder < kAdders; ++adder) {
        for (int run = 0; run < kRuns; ++run) {
            const int number = (adder * kRuns / 2 + run) % (kAdders * kRuns / 2);
            const fs::path folder = runs() / ("run-" + std::to_string(1000 + number));
            if (!fs::exists(folder)) write_run(number);
            commands[std::size_t(adder)].push_back(folder.string());
        }
    }
    std::vector<pid_t> children;
    for (int adder = 0; adder < kAdders; ++adder) {
        const fs::path log = scratch_.path() / ("log-" + std::to_string(adder));
        children.push_back(start_lodbench(commands[std::size_t(adder)], log));
    }
    for (int adder = 0; adder < kAdders; ++adder) {
        int status = 0;
        waitpid(children[std::size_t(adder)], &status, 0);
        EXPECT_EQ(status, 0) << text_of(scratch_.path() / ("log-" + std::to_string(adder)));
    }
    EXPECT_EQ(whole_runs(), std::size_t(kAdders * kRuns / 2));
}

TEST_F(TrendCommand, on_a_full_disk_says_so_and_keeps_what_is_there) {
    ASSERT_EQ(add(write_run(0)).status, 0);
    const auto size = rlim_t(fs::file_size(database()));
    const auto limit = [size] {
        const rlimit bytes{size, size};
        setrlimit(RLIMIT_FSIZE, &bytes);
    };
    Finished full{0, ""};
    std::size_t kept = 1;
    for (int run = 1; run < 50 && full.status == 0; ++run) {
        full = add(write_run(run), limit);
        if (full.status == 0) ++kept;
    }
    EXPECT_EQ(full.status, 4) << full.output;
    EXPECT_EQ(full.output,
              "lodbench: cannot write " + database().string() +
                  ": File too large; the history is as it was: make room there, or choose "
                  "another place with --db\n");
    EXPECT_EQ(whole_runs(), kept);
    ASSERT_EQ(add(runs()).status, 0) << "with room again all is added";
    EXPECT_EQ(whole_runs(), kept + 1);
}

TEST_F(TrendCommand, of_a_database_that_is_newer_damaged_or_none_says_which) {
    const fs::path run = write_run(0);
    ASSERT_EQ(add(run).status, 0);
    sqlite3* handle = nullptr;
    ASSERT_EQ(sqlite3_open(database().c_str(), &handle), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(handle, "PRAGMA user_version = 2", nullptr, nullptr, nullptr),
              SQLITE_OK);
    sqlite3_close(handle);
    for (const Finished& finished : {add(run), show()}) {
        EXPECT_EQ(finished.status, 2);
        EXPECT_EQ(finished.output,
                  "lodbench: " + database().string() +
                      ": this database is of schema 2, and this lodbench knows none above 1; use "
                      "the lodbench that wrote it, or name another with --db\n");
    }
    std::ofstream(database()) << "no database at all, but a text that is long enough to be one";
    for (const Finished& finished : {add(run), show()}) {
        EXPECT_EQ(finished.status, 2);
        EXPECT_THAT(finished.output, HasSubstr("this is no database of `lodbench trend`"));
    }
    fs::remove(database());
    EXPECT_EQ(show().status, 2);
    EXPECT_FALSE(fs::exists(database())) << "reading makes none";
}

TEST_F(TrendCommand, reads_a_write_protected_database_and_adds_nothing_to_it) {
    ASSERT_EQ(add(write_run(0)).status, 0);
    const fs::path other = write_run(1);
    fs::permissions(database(), fs::perms::owner_read);
    fs::permissions(database().parent_path(), fs::perms::owner_read | fs::perms::owner_exec);
    // Root writes wherever it likes, but for this.
    const auto bound = [] { prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE, 0, 0, 0); };
    const Finished refused = add(other, bound);
    EXPECT_EQ(refused.status, 4) << refused.output;
    EXPECT_EQ(refused.output,
              "lodbench: cannot write " + database().string() +
                  ": attempt to write a readonly database; make the file and its folder, where "
                  "the journal stands, writable, or choose another place with --db\n");
    const Finished shown =
        run_lodbench({"trend", "show", "--db", database().string(), "-o", out().string()},
                     scratch_.path(), bound);
    EXPECT_EQ(shown.status, 0) << shown.output;
    EXPECT_THAT(shown.output, StartsWith("trends    0 steps in 1 runs"));
    fs::permissions(database().parent_path(), fs::perms::owner_all);
}

TEST_F(TrendCommand, options_out_of_range_are_refused) {
    ASSERT_EQ(add(write_run(0)).status, 0);
    const auto with = [&](const std::string& option, const std::string& value) {
        return run_lodbench(
            {"trend", "show", "--db", database().string(), "-o", out().string(), option, value},
            scratch_.path());
    };
    EXPECT_EQ(with("--segment", "2").status, 2);
    EXPECT_EQ(with("--p-value", "0").status, 2);
    EXPECT_EQ(with("--change", "-1").status, 2);
    const Finished window = with("--window", "11");
    EXPECT_EQ(window.status, 2);
    EXPECT_EQ(window.output,
              "lodbench: --window 11: a window holds at least two segments; give --window 12 or "
              "more, or a smaller --segment\n");
    EXPECT_EQ(with("--sigma", "0").status, 0);
}

}  // namespace
}  // namespace lodbench::test
