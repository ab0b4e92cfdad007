// Nothing of the user's is lost, whatever becomes of a run: a results folder is new, empty or our
// own, and only what a run gives a name to is ever removed or replaced.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "cli/kills.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;

/// Every file and link below a folder, with its content or target.
std::map<std::string, std::string> tree_of(const fs::path& folder) {
    std::map<std::string, std::string> tree;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        const std::string name = fs::relative(entry.path(), folder).string();
        if (entry.is_symlink()) {
            tree[name] = "-> " + fs::read_symlink(entry.path()).string();
        } else if (entry.is_regular_file()) {
            tree[name] = text_of(entry.path());
        }
    }
    return tree;
}

class ResultsFolder : public testing::Test {
protected:
    void SetUp() override { fs::create_directories(scratch_.path() / "work"); }
    [[nodiscard]] fs::path out() const { return scratch_.path() / "work" / "out"; }
    /// A command that flies, over the tiny scenario, into `out`.
    [[nodiscard]] std::vector<std::string> command(const std::string& name,
                                                   std::vector<std::string> more) const {
        std::vector<std::string> arguments = {
            name, tiny_scenario(scratch_.path(), "repetitions = 2\n").string(), "--out",
            out().string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
    Finished lodbench(const std::string& name, std::vector<std::string> more = {}) const {
        return run_lodbench(command(name, std::move(more)), scratch_.path());
    }
    void write(const fs::path& file, const std::string& text) const {
        fs::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }

    const ScratchFolder scratch_;
};

const std::vector<std::string> kTemplate = {"--method", "template"};

TEST_F(ResultsFolder, that_holds_the_users_files_is_refused_by_name_and_left_as_it_is) {
    const std::vector<std::pair<std::string, std::vector<std::string>>> commands = {
        {"run", {"--method", "template"}},
        {"run", {"--method", "nosuch"}},
        {"run", {"--method", "template", "--resume"}},
        {"sweep", {"--method", "template"}},
        {"match", {"--method", "refined", "--error", "1"}},
    };
    std::mt19937 random(13);
    const char* const folders[] = {"",       "scenarios/", "frames/", "flights/",   "logs/",
                                   "shots/", "search/",    "mine/",   "frames/a/b/"};
    const char* const files[] = {"tiny.toml",  "notes.txt",          "template__tiny__r0.csv",
                                 ".x.csv.tmp", "template__tiny.log", "cells.jsonl"};
    for (const auto& [name, arguments] : commands) {
        for (int round = 0; round < 3; ++round) {
            fs::remove_all(out());
            for (int i = 0; i < 6; ++i) {
                write(out() / (folders[random() % std::size(folders)] +
                               std::string(files[random() % std::size(files)])),
                      std::to_string(random()));
            }
            const auto before = tree_of(out());
            const Finished finished = lodbench(name, arguments);
            EXPECT_EQ(finished.status, 2) << finished.output;
            EXPECT_EQ(tree_of(out()), before) << name << ": " << finished.output;
        }
    }
}

TEST_F(ResultsFolder, message_names_what_is_in_the_way) {
    write(out() / "notes.txt", "mine");
    const Finished finished = lodbench("run", kTemplate);
    EXPECT_EQ(finished.status, 2);
    EXPECT_THAT(finished.output, HasSubstr("notes.txt"));
    EXPECT_THAT(finished.output, HasSubstr("name a new or an empty folder with --out"));
}

TEST_F(ResultsFolder, refused_run_leaves_an_empty_folder_empty_and_makes_none) {
    EXPECT_EQ(lodbench("run", {"--method", "nosuch"}).status, 2);
    EXPECT_FALSE(fs::exists(out()));
    fs::create_directories(out());
    EXPECT_EQ(lodbench("run", {"--method", "nosuch"}).status, 2);
    EXPECT_TRUE(fs::is_empty(out()));
}

TEST_F(ResultsFolder, foreign_files_stay_when_a_run_is_resumed) {
    ASSERT_EQ(lodbench("run", kTemplate).status, 0);
    const auto run = tree_of(out());
    const std::string lines = text_of(out() / "cells.jsonl");
    fs::resize_file(out() / "cells.jsonl", lines.find('\n') + 1);  // as if killed
    std::map<std::string, std::string> foreign;
    for (const char* file : {"notes.txt", "frames/mine.csv", "frames/.mine.csv.tmp",
                             "scenarios/other.toml", "shots/photo.png", "logs/deep/x.log"}) {
        write(out() / file, file);
        foreign[file] = file;
    }
    EXPECT_EQ(lodbench("run", {"--method", "nosuch", "--resume"}).status, 2);
    ASSERT_EQ(lodbench("run", {"--method", "template", "--resume"}).status, 0);
    const auto after = tree_of(out());
    for (const auto& [name, text] : foreign) {
        ASSERT_TRUE(after.contains(name)) << name;
        EXPECT_EQ(after.at(name), text);
    }
    for (const auto& [name, text] : run) EXPECT_TRUE(after.contains(name)) << name;
    EXPECT_EQ(cells_of(out()).size(), 2U);
}

TEST_F(ResultsFolder, links_are_neither_followed_nor_removed) {
    const fs::path elsewhere = scratch_.path() / "elsewhere";
    write(elsewhere / "precious.txt", "mine");
    fs::create_directory_symlink(elsewhere, out());
    const Finished linked = lodbench("run", kTemplate);
    EXPECT_EQ(linked.status, 2);
    EXPECT_THAT(linked.output, HasSubstr("symbolic link"));
    EXPECT_TRUE(fs::is_symlink(out()));
    fs::remove(out());
    ASSERT_EQ(lodbench("run", kTemplate).status, 0);
    const std::string lines = text_of(out() / "cells.jsonl");
    fs::resize_file(out() / "cells.jsonl", lines.find('\n') + 1);
    fs::remove_all(out() / "frames");
    fs::create_directory_symlink(elsewhere, out() / "frames");
    const Finished resumed = lodbench("run", {"--method", "template", "--resume"});
    EXPECT_EQ(resumed.status, 2) << resumed.output;
    EXPECT_THAT(resumed.output, HasSubstr("frames: this is not a folder"));
    EXPECT_EQ(tree_of(elsewhere).size(), 1U);
}

TEST_F(ResultsFolder, run_that_was_killed_before_its_scenarios_stood_is_resumed) {
    ASSERT_EQ(lodbench("run", kTemplate).status, 0);
    for (const char* part : {"scenarios", "frames", "shots", "logs", "cells.jsonl"}) {
        fs::remove_all(out() / part);
    }
    EXPECT_EQ(lodbench("run", {"--method", "template", "--resume"}).status, 0);
    EXPECT_EQ(cells_of(out()).size(), 2U);
    fs::remove_all(out());
    write(out() / ".lock", "");  // killed before run.json stood
    write(out() / ".run.json.1-0.tmp", "{");
    EXPECT_EQ(lodbench("run", {"--method", "template", "--resume"}).status, 0);
}

TEST_F(ResultsFolder, match_that_is_killed_goes_on_to_the_result_of_an_undisturbed_one) {
    const std::vector<std::string> more = {"--method", "refined",  "--triangles",
                                           "100",      "--probes", "4"};
    ASSERT_EQ(lodbench("match", more).status, 0);
    const std::string undisturbed = text_of(out() / "match.json");
    const Finished again = lodbench("match", more);
    EXPECT_EQ(again.status, 2);
    EXPECT_THAT(again.output, HasSubstr("--resume"));
    fs::remove_all(out());
    EXPECT_EQ(
        after_kills(resumed(command("match", more)), scratch_.path(), out() / "match.json", 5),
        undisturbed);
    EXPECT_TRUE(fs::exists(out() / "match.md"));
    std::vector<std::string> other = more;
    other[3] = "200";
    other.emplace_back("--resume");
    const Finished changed = lodbench("match", other);
    EXPECT_EQ(changed.status, 2);
    EXPECT_THAT(changed.output, HasSubstr("has another target"));
}

TEST_F(ResultsFolder, sweep_that_is_killed_goes_on_and_writes_its_table) {
    const std::vector<std::string> more = {"--method", "refined", "--points", "3"};
    const std::string table =
        after_kills(resumed(command("sweep", more)), scratch_.path(), out() / "trade.md", 4);
    EXPECT_THAT(table, HasSubstr("refined tau="));
    EXPECT_EQ(cells_of(out()).size(), 6U);
}

TEST_F(ResultsFolder, a_flipped_digit_is_found_by_report_and_resume_which_name_the_file) {
    ASSERT_EQ(lodbench("run", kTemplate).status, 0);
    std::mt19937 random(8);
    for (const char* file : {"cells.jsonl", "frames/template__tiny__r0.csv", "flights/tiny.json"}) {
        const std::string whole = text_of(out() / file);
        for (int round = 0; round < 8; ++round) {
            std::string damaged = whole;
            std::size_t place = 0;
            do {
                place = random() % damaged.size();
            } while (damaged[place] < '0' || damaged[place] > '9');
            damaged[place] = damaged[place] == '9' ? '8' : char(damaged[place] + 1);
            std::ofstream(out() / file) << damaged;
            std::vector<std::vector<std::string>> commands = {
                {"report", out().string(), "-o", (scratch_.path() / "page.html").string()}};
            if (std::string(file) != "flights/tiny.json") {  // of which a run reads nothing
                commands.push_back({"run", "--resume", "--out", out().string()});
            }
            for (const auto& arguments : commands) {
                const Finished finished = run_lodbench(arguments, scratch_.path());
                EXPECT_EQ(finished.status, 2) << arguments[0] << " " << file << ":" << place;
                EXPECT_THAT(finished.output, HasSubstr((out() / file).string()));
            }
        }
        std::ofstream(out() / file) << whole;
    }
    EXPECT_EQ(run_lodbench({"run", "--resume", "--out", out().string()}, scratch_.path()).status,
              0);
}

}  // namespace
}  // namespace lodbench::test
