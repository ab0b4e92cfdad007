// What disturbs times is told in the terminal, in the results and beside every table of them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kWords = "its frames took ";
const std::string kRest = " ms of CPU time were spent on them: it waited for other programs";

TEST(NoiseCli, a_cell_that_waits_is_told_beside_its_figures) {
    const ScratchFolder scratch;
    const std::string out = (scratch.path() / "out").string();
    const Finished finished =
        run_lodbench({"run", tiny_scenario(scratch.path(), "").string(), "--method", "sleeps",
                      "--method", "healthy", "--plugin-dir", broken_plugin_folder("sleeps"),
                      "--plugin-dir", broken_plugin_folder("healthy"), "--out", out},
                     scratch.path());
    ASSERT_EQ(finished.status, 0) << finished.output;
    EXPECT_THAT(finished.output, HasSubstr("\nNoise\n  sleeps, tiny, repetition 0: " + kWords));
    EXPECT_THAT(finished.output, HasSubstr(kRest));
    EXPECT_THAT(finished.output, Not(HasSubstr("healthy, tiny, repetition 0: " + kWords)));
    const std::string summary = text_of(fs::path(out) / "summary.md");
    const std::size_t noise = summary.find("- Noise: sleeps, tiny, repetition 0: " + kWords);
    ASSERT_NE(noise, summary.npos) << summary;
    EXPECT_LT(noise, summary.find("<details>")) << "not folded away";
    for (const Json::Value& cell : cells_of(out)) {
        EXPECT_EQ(cell["noise"].isString(), cell["method"] == "sleeps") << cell["noise"];
    }
    const std::string page = (scratch.path() / "page.html").string();
    ASSERT_EQ(run_lodbench({"report", out, "-o", page}, scratch.path()).status, 0);
    EXPECT_THAT(text_of(page), HasSubstr("<li>noise: sleeps__tiny__r0: " + kWords));
    // A load above the cores is this machine's own matter: told where it is so.
    const Json::Value run = results::parse_json(text_of(fs::path(out) / "run.json"), "run.json");
    const bool loaded = run["load_average"].asDouble() > run["cores"].asDouble();
    EXPECT_EQ(finished.output.find("noise: the load average was ") != std::string::npos, loaded);
    EXPECT_EQ(summary.find("- Noise: the load average was ") != summary.npos, loaded);
    EXPECT_EQ(text_of(page).find("<li>noise: the load average was ") != std::string::npos, loaded);
}

}  // namespace
}  // namespace lodbench::test
