// The paper as data, flown small: what does not depend on the machine comes out as it should.

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

TEST(Livny, quick_reproduction_judges_its_claims) {
    const ScratchFolder folder;
    const fs::path out = folder.path() / "out";
    const auto run = run_lodbench(
        {"reproduce", "livny", "--quick", "--plugin-dir", LODBENCH_PLUGINS, "--out", out},
        folder.path());
    ASSERT_EQ(run.status, 0) << run.output;
    const Json::Value json = results::parse_json(text_of(out / "verdicts.json"), "verdicts.json");
    std::map<std::string, std::string> verdicts;
    int asked = 0;  // claims of which some figure was measured
    for (const Json::Value& claim : json["papers"][0]["claims"]) {
        verdicts[claim["id"].asString()] = claim["verdict"].asString();
        asked += claim["verdict"] == "cannot be judged here" ? 0 : 1;
    }
    EXPECT_GE(asked, 20) << text_of(out / "reproduce.md");
    // Of counts and errors in lockstep, the same on every machine.
    for (const char* claim : {"table-1-triangles", "P4-texels", "P5", "P7", "P15", "P21-texels"}) {
        EXPECT_EQ(verdicts[claim], "holds") << claim << "\n" << text_of(out / "reproduce.md");
    }
    EXPECT_EQ(verdicts["P20"], "does not hold");
    EXPECT_EQ(verdicts["P24"], "cannot be judged here");
}

}  // namespace
}  // namespace lodbench::test
