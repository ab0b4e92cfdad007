// lodbench compare, baseline and report --junit, as they are typed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The tiny flight by one build of the test plugin `steady`.
class CompareRuns : public testing::Test {
protected:
    Finished lodbench(const std::vector<std::string>& arguments) {
        return run_lodbench(arguments, folder_.path());
    }
    std::string fly(const std::string& build, const std::string& name,
                    const std::vector<std::string>& more = {}) {
        const std::string out = path(name);
        std::vector<std::string> arguments = {
            "run",          tiny_scenario(folder_.path(), "").string(),
            "--plugin-dir", broken_plugin_folder(build),
            "--method",     "steady",
            "--out",        out};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Finished finished = lodbench(arguments);
        EXPECT_EQ(finished.status, 0) << finished.output;
        return out;
    }
    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_.path() / name).string();
    }

    ScratchFolder folder_;
};

TEST_F(CompareRuns,
       one_triangle_more_in_one_frame_fails_the_gate_with_method_frame_before_and_after) {
    const std::string base = fly("steady", "base"), same = fly("steady", "same"),
                      more = fly("steady_more", "more");
    const Finished equal = lodbench({"compare", base, same, "--gate"});
    EXPECT_EQ(equal.status, 0) << equal.output;
    EXPECT_THAT(equal.output, HasSubstr("gate      holds"));
    EXPECT_THAT(equal.output, Not(HasSubstr("changed")));
    const Finished changed = lodbench({"compare", base, more, "--gate"});
    EXPECT_EQ(changed.status, 1);
    EXPECT_THAT(
        changed.output,
        HasSubstr("steady, tiny: frame 1: triangles 10 before, 11 after (in 1 of 2 frames)"));
    EXPECT_THAT(changed.output, HasSubstr("steady, tiny: triangles.max: 10 before, 11 after"));
    EXPECT_EQ(lodbench({"compare", base, more}).status, 0) << "without --gate it tells";
}

TEST_F(CompareRuns, holds_a_run_against_a_baseline_of_another) {
    const std::string base = fly("steady", "base"), kept = path("kept");
    ASSERT_EQ(lodbench({"baseline", base, "--out", kept}).status, 0);
    const Finished equal = lodbench({"compare", kept, fly("steady", "same"), "--gate"});
    EXPECT_EQ(equal.status, 0) << equal.output;
    EXPECT_THAT(equal.output, HasSubstr("times are not compared: BASE holds none"));
    const Finished changed = lodbench({"compare", kept, fly("steady_more", "more"), "--gate"});
    EXPECT_EQ(changed.status, 1);
    EXPECT_THAT(changed.output, HasSubstr("frame 1: triangles 10 before, 11 after"));
    const std::string both = fly("steady", "both", {"--method", "template"});
    const Finished wider = lodbench({"compare", kept, both, "--gate"});
    EXPECT_EQ(wider.status, 0) << wider.output;
    EXPECT_THAT(wider.output, HasSubstr("template, tiny: new, so compared with nothing"));
    ASSERT_EQ(lodbench({"baseline", both, "--out", kept}).status, 0);
    const Finished fewer = lodbench({"compare", kept, base, "--gate"});
    EXPECT_EQ(fewer.status, 1);
    EXPECT_THAT(fewer.output, HasSubstr("template, tiny: BASE has it, NEW does not"));
    EXPECT_EQ(lodbench({"baseline", base, "--out", both}).status, 2) << "that is a run";
}

TEST_F(CompareRuns, prints_json_and_markdown_and_writes_junit) {
    const std::string base = fly("steady", "base"), more = fly("steady_more", "more");
    const Finished json = lodbench({"compare", base, more, "--json", "--junit", path("c.xml")});
    ASSERT_EQ(json.status, 0) << json.output;
    const Json::Value told = results::parse_json(json.output, "--json");
    EXPECT_FALSE(told["gate_holds"].asBool());
    const Json::Value& change = told["settings"][0]["frame_changes"][0];
    EXPECT_EQ(change["column"], "triangles");
    EXPECT_EQ(change["frame"], 1);
    EXPECT_EQ(change["before"], "10");
    EXPECT_EQ(change["after"], "11");
    EXPECT_EQ(told["settings"][0]["times"][0]["verdict"], "cannot tell") << "of one repetition";
    EXPECT_EQ(told["settings"][0]["times"][0]["repetitions_needed"], 9);
    EXPECT_THAT(text_of(path("c.xml")),
                HasSubstr("<failure message=\"frame 1: triangles 10 before"));
    const Finished markdown = lodbench({"compare", base, more, "--markdown"});
    EXPECT_THAT(markdown.output, HasSubstr("**Gate fails: "));
    EXPECT_THAT(markdown.output,
                HasSubstr("- steady, tiny: frame 1: triangles 10 before, 11 after"));
    const Finished report = lodbench({"report", base, "--junit", path("r.xml")});
    EXPECT_EQ(report.status, 0) << report.output;
    EXPECT_THAT(text_of(path("r.xml")), HasSubstr("<testcase classname=\"tiny.steady\""));
    EXPECT_EQ(lodbench({"report", base, more, "--junit", path("r.xml")}).status, 2)
        << "a document is of one run";
}

TEST_F(CompareRuns, refuses_what_is_no_run_and_says_when_nothing_was_compared) {
    const std::string base = fly("steady", "base");
    const Finished absent = lodbench({"compare", base, path("none")});
    EXPECT_EQ(absent.status, 2);
    EXPECT_THAT(absent.output, HasSubstr("none: there is no such folder; name a results folder"));
    const Finished same = lodbench({"compare", base, base + "/"});
    EXPECT_EQ(same.status, 2);
    EXPECT_THAT(same.output, HasSubstr("are one folder"));
    fs::create_directory(path("empty"));
    EXPECT_EQ(lodbench({"compare", base, path("empty")}).status, 2);
    std::ofstream(base + "/cells.jsonl", std::ios::app) << "{\"cell\": 3}\n";
    const Finished damaged = lodbench({"compare", fly("steady", "other"), base});
    EXPECT_EQ(damaged.status, 2);
    EXPECT_THAT(damaged.output, HasSubstr("cells.jsonl:4"));
    const std::string other = path("template");
    ASSERT_EQ(lodbench({"run", tiny_scenario(folder_.path(), "").string(), "--method", "template",
                        "--out", other})
                  .status,
              0);
    const Finished nothing = lodbench({"compare", path("other"), other});
    EXPECT_EQ(nothing.status, 4) << nothing.output;
    EXPECT_THAT(nothing.output, HasSubstr("nothing was compared"));
    EXPECT_EQ(lodbench({"compare", path("other"), other, "--matters", "-1"}).status, 2);
}

}  // namespace
}  // namespace lodbench::test
