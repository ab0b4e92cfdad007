// Standard streams that are closed or full, and text from outside that reaches them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/printable.h"
#include "cli/run_lodbench.h"

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
        {"list"}, {"list", "--json"}, {"describe", "pgm"}, {"--help"}, {"run", "--help"}, run()};
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
    EXPECT_THAT(report::to_text(value), HasSubstr("[2J\xEF\xBF\xBD.toml"));
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
