// JUnit XML that a parser reads back, whatever cells are called and fail with.

#include "report/junit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "support/campaign_folders.h"
#include "support/run_lodbench.h"

namespace lodbench::report {
namespace {

using testing::HasSubstr;

/// What Python's parser finds: the names, classes and outcomes of the cases, one a line.
std::string parsed(const std::string& xml) {
    const test::ScratchFolder folder;
    test::FakeCampaign::put(folder.path() / "junit.xml", xml);
    test::FakeCampaign::put(folder.path() / "read.py", R"(import sys, xml.etree.ElementTree as tree
root = tree.parse(sys.argv[1]).getroot()
assert root.tag == "testsuites", root.tag
with open(sys.argv[2], "w") as out:
    for suite in root:
        for count, tags in (("tests", None), ("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
            cases = [case for case in suite if tags is None or case.find(tags) is not None]
            assert int(suite.get(count)) == len(cases), (suite.get("name"), count)
        for case in suite:
            outcome = [(child.tag, child.get("message"), child.text) for child in case]
            print(suite.get("name"), case.get("classname"), case.get("name"), outcome, file=out)
)");
    const std::string command =
        fmt::format("python3 {0}/read.py {0}/junit.xml {0}/out.txt", folder.path().string());
    EXPECT_EQ(std::system(command.c_str()), 0) << xml;
    return test::text_of(folder.path() / "out.txt");
}

results::CellRecord cell(const std::string& name, results::CellStatus status,
                         const std::string& reason) {
    results::CellRecord record;
    record.cell = name;
    record.method = "m";
    record.scenario = "s";
    record.status = status;
    record.reason = reason;
    return record;
}

TEST(Junit, of_a_campaign_has_a_case_for_each_cell_with_its_outcome) {
    using results::CellStatus;
    results::ResultFolder folder;
    folder.name = "run";
    folder.cells = {cell("fine", CellStatus::ok, ""), cell("bad", CellStatus::failed, "threw"),
                    cell("gone", CellStatus::crashed, "signal 11"),
                    cell("late", CellStatus::timeout, "10 s"),
                    cell("no", CellStatus::skipped, "no extension")};
    const std::string found = parsed(junit_of(folder));
    EXPECT_THAT(found, HasSubstr("s s.m fine []"));
    EXPECT_THAT(found, HasSubstr("s s.m bad [('failure', 'failed: threw', 'threw')]"));
    EXPECT_THAT(found, HasSubstr("s s.m gone [('error', 'crashed: signal 11', 'signal 11')]"));
    EXPECT_THAT(found, HasSubstr("s s.m late [('error', 'timeout: 10 s', '10 s')]"));
    EXPECT_THAT(found, HasSubstr("s s.m no [('skipped'"));
}

TEST(Junit, is_well_formed_for_any_name_and_any_reason) {
    std::string all;
    for (int byte = 1; byte < 256; ++byte) all += char(byte);
    const std::string hostile[] = {all,
                                   "]]></failure></testcase>",
                                   "<!-- \"quotes\" 'and' & &amp; &#0; -->",
                                   std::string("nul \0 here", 10),
                                   "\xEF\xBF\xBE \xEF\xBF\xBF \xED\xA0\x80 \xF4\x90\x80\x80",
                                   "line\nbreak\ttab\rreturn"};
    for (const std::string& text : hostile) {
        results::ResultFolder folder;
        folder.name = text;
        folder.cells = {cell(text, results::CellStatus::failed, text),
                        cell(text + "2", results::CellStatus::ok, "")};
        folder.cells[0].scenario = folder.cells[0].method = text;
        folder.cells[1].warnings = {text};
        EXPECT_THAT(parsed(junit_of(folder)), HasSubstr("'failure'"));
    }
    results::ResultFolder folder;
    folder.cells = {cell("<a> & \"b\"", results::CellStatus::failed, "first\nsecond")};
    const std::string found = parsed(junit_of(folder));
    EXPECT_THAT(found, HasSubstr("s s.m <a> & \"b\" [('failure', 'failed: first', "
                                 "'first\\nsecond')]"));
}

TEST(Junit, of_a_comparison_fails_what_the_gate_fails_and_skips_what_cannot_be_told) {
    compare::Comparison comparison;
    compare::SettingComparison& setting = comparison.settings.emplace_back();
    setting.scenario = "demo";
    setting.method = setting.label = "pgm";
    setting.frame_changes.push_back({"triangles", 7, "10", "11", 1, 25});
    compare::TimeComparison& slow = setting.times.emplace_back();
    slow.figure = "frame_ms.median";
    slow.verdict = compare::TimeVerdict::slower;
    slow.in_turn = true;
    setting.times.push_back(slow);
    setting.times.back().figure = "cpu_ms.median";
    setting.times.back().verdict = compare::TimeVerdict::cannot_tell;
    setting.times.back().runs_needed = 20;
    comparison.missing = {"fu, demo"};
    const std::string found = parsed(junit_of(comparison));
    EXPECT_THAT(found, HasSubstr("demo demo.pgm pgm: figures [('failure', 'frame 7: triangles 10 "
                                 "before, 11 after (in 1 of 25 frames)'"));
    EXPECT_THAT(found, HasSubstr("pgm: frame_ms.median [('failure', 'slower"));
    EXPECT_THAT(found, HasSubstr("pgm: cpu_ms.median [('skipped', 'cannot tell: 20 repetitions"));
    EXPECT_THAT(found, HasSubstr("missing missing fu, demo [('failure'"));
}

}  // namespace
}  // namespace lodbench::report
