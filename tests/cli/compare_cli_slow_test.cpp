// A slow-down suspected, flown again by turns, and called one; and where that cannot be done
// honestly.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;

TEST(CompareConfirm, flies_suspects_again_by_turns_and_refuses_other_plugins) {
    const ScratchFolder folder;
    const auto path = [&](const char* name) { return (folder.path() / name).string(); };
    const auto put_plugin = [&](const char* name, const std::string& build) {
        fs::create_directory(path(name));
        fs::copy_file(broken_plugin_folder(build) + "/" + build + ".so", path(name) + "/steady.so",
                      fs::copy_options::overwrite_existing);
    };
    const auto lodbench = [&](const std::vector<std::string>& arguments) {
        return run_lodbench(arguments, folder.path());
    };
    // One after the other, as two CI jobs would.
    const std::string scenario = tiny_scenario(folder.path(), "repetitions = 9\n").string();
    for (const auto& [name, build] :
         {std::pair("base", "steady"), std::pair("new", "steady_slow")}) {
        const std::string plugins = std::string("plugins-") + name;
        put_plugin(plugins.c_str(), build);
        const Finished flown = lodbench({"run", scenario, "--plugin-dir", path(plugins.c_str()),
                                         "--method", "steady", "--set", "steady.work=2000",
                                         "--frames", "20", "--no-truth", "--out", path(name)});
        ASSERT_EQ(flown.status, 0) << flown.output;
    }
    const Finished suspected = lodbench({"compare", path("base"), path("new"), "--gate"});
    EXPECT_EQ(suspected.status, 0) << suspected.output;
    EXPECT_THAT(suspected.output, HasSubstr("slower"));
    EXPECT_THAT(suspected.output, HasSubstr("times are advice, no gate"));

    const Finished confirmed =
        lodbench({"compare", path("base"), path("new"), "--gate", "--confirm", path("again")});
    EXPECT_EQ(confirmed.status, 1) << confirmed.output;
    EXPECT_THAT(confirmed.output, HasSubstr("changed   steady, tiny: slower: "));
    EXPECT_THAT(confirmed.output, HasSubstr("flown by turns"));
    EXPECT_TRUE(fs::exists(folder.path() / "again/000/base-009/cells.jsonl"));

    const std::string used = path("again");
    const Finished taken = lodbench({"compare", path("base"), path("new"), "--confirm", used});
    EXPECT_EQ(taken.status, 2);
    EXPECT_THAT(taken.output, HasSubstr("this folder is not empty"));

    put_plugin("plugins-base", "steady_slow");
    const Finished rebuilt =
        lodbench({"compare", path("base"), path("new"), "--confirm", path("again2")});
    EXPECT_EQ(rebuilt.status, 2);
    EXPECT_THAT(rebuilt.output, HasSubstr("is not the one that base was flown with"));
    EXPECT_THAT(rebuilt.output, HasSubstr("scripts/compare-commits"));
    fs::remove(folder.path() / "plugins-base/steady.so");
    const Finished gone =
        lodbench({"compare", path("base"), path("new"), "--confirm", path("again3")});
    EXPECT_EQ(gone.status, 2);
    EXPECT_THAT(gone.output, HasSubstr("is no longer there"));
}

}  // namespace
}  // namespace lodbench::test
