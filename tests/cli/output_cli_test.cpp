// Standard streams that are closed or full, and text from outside that reaches them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/printable.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class Output : public testing::Test {
protected:
    [[nodiscard]] fs::path out() const { return scratch_.path() / "out"; }
    [[nodiscard]] std::vector<std::string> run() const {
        return {"run",      tiny_scenario(scratch_.path(), "repetitions = 2\n").string(),
                "--out",    out().string(),
                "--method", "template"};
    }
    static void redirect(int descriptor, const char* file) {
        const int opened = open(file, O_WRONLY);
        dup2(opened, descriptor);
        close(opened);
    }

    const ScratchFolder scratch_;
};

TEST_F(Output, run_ends_well_whatever_of_its_standard_descriptors_is_closed) {
    for (int closed = 1; closed < 8; ++closed) {
        fs::remove_all(out());
        const Finished finished = run_lodbench(run(), scratch_.path(), [closed] {
            for (int descriptor = 0; descriptor < 3; ++descriptor) {
                if ((closed >> descriptor) & 1) close(descriptor);
            }
        });
        EXPECT_EQ(finished.status, 0) << closed << finished.output;
        EXPECT_EQ(cells_of(out()).size(), 2U);
        EXPECT_EQ(text_of(out() / ".lock"), "") << "descriptors " << closed;
    }
}

TEST_F(Output, progress_that_cannot_be_written_does_not_end_a_run) {
    const Finished finished =
        run_lodbench(run(), scratch_.path(), [] { redirect(2, "/dev/full"); });
    EXPECT_EQ(finished.status, 0) << finished.output;
    EXPECT_EQ(cells_of(out()).size(), 2U);
}

TEST_F(Output, what_was_asked_for_and_is_lost_gives_status_2_and_words) {
    const std::vector<std::vector<std::string>> commands = {
        {"list"},   {"list", "--json"}, {"describe", "template"},
        {"--help"}, {"run", "--help"},  run()};
    for (const auto& command : commands) {
        const Finished finished =
            run_lodbench(command, scratch_.path(), [] { redirect(1, "/dev/full"); });
        EXPECT_EQ(finished.status, 2) << command[0];
        EXPECT_THAT(finished.output, HasSubstr("cannot write standard output"));
    }
}

TEST_F(Output, names_from_outside_neither_steer_the_terminal_nor_break_json) {
    const std::string name = "evil\x1b[2J\xe9.toml";
    const Finished finished = run_lodbench({"run", name, "--out", out().string()}, scratch_.path());
    EXPECT_EQ(finished.status, 2);
    EXPECT_THAT(finished.output, HasSubstr("evil\\x1b[2J\\xe9.toml"));
    EXPECT_THAT(finished.output, Not(HasSubstr("\x1b")));
    Json::Value value;
    value["name"] = name;
    EXPECT_THAT(results::to_text(value), HasSubstr("[2J\xEF\xBF\xBD.toml"));
}

TEST_F(Output, a_pipe_that_nobody_reads_is_an_error_and_no_signal) {
    const Finished finished = run_lodbench({"list"}, scratch_.path(), [] {
        int ends[2];
        if (pipe(ends) != 0) _exit(126);
        dup2(ends[1], 1);
        close(ends[0]);
    });
    EXPECT_EQ(finished.status, 2);
    EXPECT_THAT(finished.output, HasSubstr("cannot write standard output: Broken pipe"));
}

TEST_F(Output, bytes_of_a_file_name_neither_steer_the_terminal_nor_spoil_json) {
    const fs::path hill = scratch_.path() / "caf\xe9\x1b[31m\xc2\x9b.asc";
    std::ofstream(hill) << "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n";
    const Finished json =
        run_lodbench({"terrain", "info", hill.string(), "--json"}, scratch_.path());
    EXPECT_EQ(json.status, 0) << json.output;
    EXPECT_THAT(json.output, HasSubstr("caf\uFFFD\\u001b[31m\\u009b"));
    const Finished text = run_lodbench({"terrain", "info", hill.string()}, scratch_.path());
    EXPECT_EQ(text.status, 0) << text.output;
    EXPECT_THAT(text.output, HasSubstr("caf\\xe9\\x1b[31m\\xc2\\x9b"));
    const Finished refused = run_lodbench(
        {"terrain", "info", (scratch_.path() / "no\xe9\x1b[31m.asc").string()}, scratch_.path());
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.output, HasSubstr("no\\xe9\\x1b[31m.asc"));
    for (const Finished& finished : {json, text, refused}) {
        EXPECT_THAT(finished.output, Not(HasSubstr("\x1b")));
        EXPECT_THAT(finished.output, Not(HasSubstr("\xe9")));
    }
}

TEST_F(Output, a_terrain_whose_path_is_not_utf8_is_flown_and_its_records_are_utf8) {
    const fs::path inputs = scratch_.path() / "caf\xe9";
    fs::create_directory(inputs);
    std::ofstream hill(inputs / "hill.asc");
    hill << "ncols 17\nnrows 17\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
    for (int i = 0; i < 17 * 17; ++i) hill << i % 5 << '\n';
    hill.close();
    std::string scenario = text_of(tiny_scenario(scratch_.path(), "repetitions = 1\n"));
    const std::string synthetic = "synthetic = \"ramp\"\nrows = 17\ncolumns = 17\nspacing = 10";
    scenario.replace(scenario.find(synthetic), synthetic.size(), "file = \"hill.asc\"");
    std::ofstream(inputs / "s.toml") << scenario;
    const Finished finished = run_lodbench({"run", (inputs / "s.toml").string(), "--method",
                                            "template", "--no-truth", "--out", out().string()},
                                           scratch_.path());
    EXPECT_EQ(finished.status, 0) << finished.output;
    EXPECT_THAT(text_of(out() / "run.json"), HasSubstr("caf\uFFFD"));
    EXPECT_THAT(text_of(out() / "run.json"), Not(HasSubstr("\xe9")));
    EXPECT_THAT(text_of(out() / "cells.jsonl"), Not(HasSubstr("\xe9")));
}

TEST(Plain, escapes_controls_of_both_sets_and_keeps_lines_and_letters) {
    EXPECT_EQ(base::plain("a\nb"), "a\nb");
    EXPECT_EQ(base::plain("\t\r\x7f"), "\\x09\\x0d\\x7f");
    EXPECT_EQ(base::plain("\xC2\x9B"), "\\xc2\\x9b");
    EXPECT_EQ(base::plain("h\xC3\xB6he"), "h\xC3\xB6he");
    EXPECT_EQ(base::plain("\xff"), "\\xff");
}

}  // namespace
}  // namespace lodbench::test
