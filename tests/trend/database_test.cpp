// A history takes each run once and whole, and refuses what is none.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>
#include <string>

#include "api/error.h"
#include "base/hash.h"
#include "support/run_lodbench.h"
#include "trend/database.h"
#include "trend/fake_history.h"
#include "trend/trends.h"

namespace lodbench::trend {
namespace {

using test::fake_cell;
using test::fake_run;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class HistoryFile : public testing::Test {
protected:
    [[nodiscard]] std::filesystem::path file() const { return scratch_.path() / "trend.sqlite"; }
    Added add(const RunEntry& run) const { return Database::for_adding(file()).add(run); }
    [[nodiscard]] History read() const { return Database::for_reading(file()).read(); }

    /// As another program would.
    void execute(const std::string& sql) const {
        sqlite3* handle = nullptr;
        ASSERT_EQ(sqlite3_open(file().c_str(), &handle), SQLITE_OK);
        char* words = nullptr;
        EXPECT_EQ(sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, &words), SQLITE_OK) << words;
        sqlite3_free(words);
        sqlite3_close(handle);
    }

    template <typename Work>
    [[nodiscard]] std::string refusal(const Work& work) const {
        try {
            work();
        } catch (const InputError& error) {
            return error.what();
        }
        return "no InputError";
    }
    [[nodiscard]] std::string refusal_to_read() const {
        return refusal([&] { (void)read(); });
    }
    [[nodiscard]] std::string refusal_to_add() const {
        return refusal([&] { add(fake_run(9, {fake_cell("m", 1)})); });
    }

    const test::ScratchFolder scratch_;
};

TEST_F(HistoryFile, keeps_runs_in_the_order_in_which_they_began) {
    for (const int number : {3, 1, 2}) add(fake_run(number, {fake_cell("m", number)}));
    const History history = read();
    ASSERT_EQ(history.runs.size(), 3U);
    EXPECT_EQ(history.runs[0].commit, "c000001");
    EXPECT_EQ(history.runs[2].commit, "c000003");
    ASSERT_EQ(history.figures.size(), 1U);
    EXPECT_EQ(history.figures[0].figure, "frame_ms.median");
    EXPECT_THAT(history.figures[0].runs, ElementsAre(0, 1, 2));
    EXPECT_THAT(history.figures[0].values, ElementsAre(1, 2, 3));
    ASSERT_EQ(history.facts.size(), 1U);
    EXPECT_THAT(history.facts[0].runs, ElementsAre(0, 1, 2));
    EXPECT_EQ(history.texts.size(), 1U) << "what does not change is kept once";
}

TEST_F(HistoryFile, takes_a_run_once_and_its_later_cells_when_it_was_resumed) {
    const RunEntry half = fake_run(1, {fake_cell("a", 5)});
    const RunEntry whole = fake_run(1, {fake_cell("a", 5), fake_cell("b", 6)});
    EXPECT_EQ(add(half).cells, 1U);
    EXPECT_EQ(add(half).cells, 0U);
    EXPECT_EQ(add(half).known, 1U);
    const Added added = add(whole);
    EXPECT_EQ(added.cells, 1U);
    EXPECT_EQ(added.known, 1U);
    const History history = read();
    ASSERT_EQ(history.runs.size(), 1U);
    EXPECT_EQ(history.runs[0].cells, 2U);
    EXPECT_EQ(history.figures.size(), 2U);
}

TEST_F(HistoryFile, refuses_another_record_of_a_cell_and_stays_as_it_was) {
    add(fake_run(1, {fake_cell("a", 5)}));
    const std::string words = refusal([&] {
        add(fake_run(1, {fake_cell("b", 7), fake_cell("a", 6)}));
    });
    EXPECT_THAT(words, StartsWith(file().string() + ": of run 0000000000000001 (run-1) "));
    EXPECT_THAT(words, HasSubstr("another record of cell 'a__demo__r0'"));
    const History history = read();
    ASSERT_EQ(history.figures.size(), 1U) << "nothing of the refused run is kept";
    EXPECT_THAT(history.figures[0].values, ElementsAre(5));
}

TEST_F(HistoryFile, gives_the_median_over_the_repetitions_of_a_run) {
    add(fake_run(
        1, {fake_cell("m", 9, "{}", 0), fake_cell("m", 1, "{}", 1), fake_cell("m", 4, "{}", 2)}));
    EXPECT_THAT(read().figures.at(0).values, ElementsAre(4));
}

TEST_F(HistoryFile, counts_cells_that_failed_and_keeps_no_figures_of_them) {
    CellEntry failed = fake_cell("m", 1);
    failed.status = "crashed";
    failed.facts.clear();
    failed.figures.clear();
    add(fake_run(1, {failed, fake_cell("n", 2)}));
    const History history = read();
    EXPECT_EQ(history.runs.at(0).cells, 2U);
    EXPECT_EQ(history.runs.at(0).ok, 1U);
    EXPECT_EQ(history.figures.size(), 1U);
    EXPECT_EQ(history.facts.size(), 1U);
}

TEST_F(HistoryFile, that_is_not_there_is_told) {
    EXPECT_EQ(refusal_to_read(), file().string() +
                                     ": there is no such database; `lodbench trend add RUN --db " +
                                     file().string() + "` makes it");
    EXPECT_FALSE(std::filesystem::exists(file()));
}

TEST_F(HistoryFile, that_is_no_database_is_refused_and_left_as_it_is) {
    const std::string text(5000, 'x');
    std::ofstream(file()) << text;
    for (const std::string& words : {refusal_to_read(), refusal_to_add()}) {
        EXPECT_EQ(words, file().string() +
                             ": this is no database of `lodbench trend` (file is not a database); "
                             "name another with --db");
    }
    EXPECT_EQ(test::text_of(file()), text);
}

TEST_F(HistoryFile, that_is_a_folder_or_a_pipe_is_refused) {
    std::filesystem::create_directory(file());
    EXPECT_THAT(refusal_to_read(), HasSubstr("this is no file"));
    EXPECT_THAT(refusal_to_add(), HasSubstr("this is no file"));
    std::filesystem::remove(file());
    ASSERT_EQ(mkfifo(file().c_str(), 0644), 0);
    EXPECT_THAT(refusal_to_read(), HasSubstr("this is no file"));
}

TEST_F(HistoryFile, of_another_program_is_refused_and_left_as_it_is) {
    execute("CREATE TABLE bookmarks (url TEXT)");
    const std::string before = test::text_of(file());
    for (const std::string& words : {refusal_to_read(), refusal_to_add()}) {
        EXPECT_EQ(words, file().string() +
                             ": this database is of another program, not of "
                             "`lodbench trend`; name another with --db");
    }
    EXPECT_EQ(test::text_of(file()), before);
}

TEST_F(HistoryFile, of_a_newer_version_is_refused_and_left_as_it_is) {
    add(fake_run(1, {fake_cell("m", 5)}));
    execute("PRAGMA user_version = 7");
    const std::string before = test::text_of(file());
    for (const std::string& words : {refusal_to_read(), refusal_to_add()}) {
        EXPECT_EQ(words, file().string() +
                             ": this database is of schema 7, and this lodbench knows none above "
                             "1; use the lodbench that wrote it, or name another with --db");
    }
    EXPECT_EQ(test::text_of(file()), before);
}

TEST_F(HistoryFile, that_is_empty_holds_no_runs) {
    std::ofstream(file()) << "";
    EXPECT_TRUE(read().runs.empty());
    EXPECT_EQ(add(fake_run(1, {fake_cell("m", 5)})).cells, 1U);
}

TEST_F(HistoryFile, whose_tables_lack_something_or_hold_something_else_is_refused) {
    const std::pair<const char*, const char*> damages[] = {
        {"DROP TABLE value", "no such table: value"},
        {"ALTER TABLE run DROP COLUMN folder", "no such column: folder"},
        {"DROP TABLE facts; CREATE TABLE facts (id INTEGER PRIMARY KEY, text BLOB); "
         "INSERT INTO facts VALUES (1, x'00ff')",
         "column 'text' holds something else than text"},
        {"DELETE FROM series", "a cell of no series"},
        {"DELETE FROM figure", "a value of no figure"},
        {"UPDATE cell SET facts = 77", "facts that are not there"},
        {"UPDATE value SET value = 9e999", "a value that is not finite"},
        {"DROP TABLE run; CREATE VIEW run AS SELECT 1 AS id, 'r' AS run_id, 's' AS started, 'c' AS "
         "commit_id, 't' AS tool_version, 'f' AS folder",
         "access to view \"run\" prohibited"},
    };
    for (const auto& [sql, words] : damages) {
        std::filesystem::remove(file());
        add(fake_run(1, {fake_cell("m", 5)}));
        execute(sql);
        EXPECT_THAT(refusal_to_read(),
                    StartsWith(file().string() + ": the database is damaged: " + words))
            << sql;
    }
}

TEST_F(HistoryFile, with_any_bytes_changed_is_read_or_refused_in_words) {
    for (int run = 1; run <= 30; ++run) {
        add(fake_run(run, {fake_cell("a", run), fake_cell("b", 2 * run)}));
    }
    const std::string good = test::text_of(file());
    base::SplitMix64 random(5);
    std::size_t refused = 0;
    for (int i = 0; i < 400; ++i) {
        std::string bytes = good;
        for (std::uint64_t k = 0; k < 1 + random.below(20); ++k) {
            bytes[random.below(bytes.size())] = char(random.below(256));
        }
        if (i % 4 == 0) bytes.resize(random.below(bytes.size()));
        std::ofstream(file(), std::ios::binary) << bytes;
        try {
            (void)find_trends(read(), {});
        } catch (const InputError& error) {
            ++refused;
            EXPECT_THAT(error.what(), StartsWith(file().string() + ": "));
        }
    }
    EXPECT_GT(refused, 100U);
}

}  // namespace
}  // namespace lodbench::trend
