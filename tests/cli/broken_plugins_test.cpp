// Plugins that are broken on purpose lose their own cells, with the exact status and reason, and
// nothing else.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "sanitizers/sanitizers.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;

struct Expectation {
    const char* plugin;  ///< its folder and file
    const char* method;
    const char* status;
    const char* reason;
};

constexpr Expectation kExpectations[] = {
    {"throws_in_create", "throws-in-create", "failed",
     "create of plugin throws_in_create.so threw: the moon is in the wrong house"},
    {"throws_in_select", "throws-in-select", "failed",
     "select of plugin throws_in_select.so threw: no tile left, frame 0 of the timing replay"},
    {"aborts", "aborts", "crashed",
     "aborted (signal 6) in draw of plugin aborts.so, frame 0 of the timing replay"},
    {"segfaults", "segfaults", "crashed",
     "segmentation fault (signal 11) in draw of plugin segfaults.so, frame 0 of the timing replay"},
    {"loops", "loops", "timeout",
     kSlowness == 1
         ? "no sign of life for 1.5 s in draw of plugin loops.so, frame 0 of the timing replay"
         : "no sign of life for 15 s in draw of plugin loops.so, frame 0 of the timing replay"},
    {"exits", "exits", "crashed",
     "the process exited with status 0 in draw of plugin exits.so, frame 0 of the timing replay "
     "before its "
     "result was written"},
    {"allocates", "allocates", "failed",
     "exceeded the memory limit of 700 MiB in draw of plugin allocates.so, frame 0 of the timing "
     "replay"},
    {"leaves_state", "leaves-state", "failed",
     "draw of plugin leaves_state.so left GL state changed: GL_DEPTH_TEST: expected enabled, found "
     "disabled"},
    {"raises_gl_error", "raises-gl-error", "failed",
     "draw of plugin raises_gl_error.so raised 1 GL error"},
    {"draws_nan", "draws-nan", "failed",
     "draw of plugin draws_nan.so sent 3 of 3 vertices that are not finite"},
    {"unsupported", "unsupported", "skipped",
     "method 'unsupported' cannot run here: no second moon in this sky"},
};

TEST(BrokenPlugins, lose_their_own_cell_only_with_status_and_reason) {
    const ScratchFolder folder;
    const fs::path scenario = tiny_scenario(
        folder.path(), std::string("repetitions = 1\nmemory_limit_mib = 700\n") +
                           "frame_time_limit_s = " + (kSlowness == 1 ? "1.5" : "15") + "\n");
    const fs::path out = folder.path() / "out";
    std::vector<std::string> arguments = {"run",      scenario.string(), "--out",    out.string(),
                                          "--method", "healthy",         "--method", "template"};
    arguments.insert(arguments.end(), {"--plugin-dir", broken_plugin_folder("healthy")});
    for (const Expectation& expected : kExpectations) {
        arguments.insert(arguments.end(), {"--method", expected.method, "--plugin-dir",
                                           broken_plugin_folder(expected.plugin)});
    }
    const Finished finished = run_lodbench(arguments, folder.path(), leave_signals_to_the_system);
    EXPECT_EQ(finished.status, 3) << finished.output;

    std::map<std::string, Json::Value> cells;
    for (const Json::Value& cell : cells_of(out)) cells[cell["method"].asString()] = cell;
    EXPECT_EQ(cells.size(), std::size(kExpectations) + 2);
    for (const char* good : {"healthy", "template"}) {
        EXPECT_EQ(cells[good]["status"].asString(), "ok") << cells[good]["reason"];
        EXPECT_EQ(cells[good]["frames"].asInt(), 2);
    }
    for (const Expectation& expected : kExpectations) {
        const Json::Value& cell = cells[expected.method];
        EXPECT_EQ(cell["status"].asString(), expected.status) << expected.method;
        EXPECT_THAT(cell["reason"].asString(), testing::StartsWith(expected.reason));
        EXPECT_TRUE(cell["fps"].isNull()) << "what was not measured is null";
        EXPECT_THAT(finished.output, HasSubstr(expected.reason));
    }
}

/// Flies two repetitions of the plugin and of a healthy one; the cells of each method.
std::map<std::string, std::vector<Json::Value>> beside_a_healthy_one(const std::string& plugin,
                                                                     const std::string& method,
                                                                     int status) {
    const ScratchFolder folder;
    const fs::path out = folder.path() / "out";
    const Finished finished = run_lodbench(
        {"run", tiny_scenario(folder.path(), "repetitions = 2\n").string(), "--out", out.string(),
         "--method", method, "--method", "healthy", "--plugin-dir", broken_plugin_folder(plugin),
         "--plugin-dir", broken_plugin_folder("healthy")},
        folder.path());
    EXPECT_EQ(finished.status, status) << finished.output;
    std::map<std::string, std::vector<Json::Value>> cells;
    for (const Json::Value& cell : cells_of(out)) cells[cell["method"].asString()].push_back(cell);
    EXPECT_EQ(cells["healthy"].size(), 2U);
    EXPECT_EQ(cells[method].size(), 2U);
    for (const Json::Value& cell : cells["healthy"]) EXPECT_EQ(cell["status"], "ok");
    return cells;
}

TEST(BrokenPlugins, that_use_up_or_lower_the_descriptors_of_their_process_fail_alone) {
    struct {
        const char *plugin, *method, *reason;
    } const faults[] = {
        {"lowers_limits", "lowers-limits", "lowered a limit of its process: open files: 0, was"},
        {"leaks_descriptors", "leaks-descriptors", "Too many open files"},
    };
    for (const auto& [plugin, method, reason] : faults) {
        auto cells = beside_a_healthy_one(plugin, method, 3);
        for (const Json::Value& cell : cells[method]) {
            if (cell["repetition"] != 0) continue;  // only the first opens files: its pictures
            EXPECT_EQ(cell["status"], "failed") << method;
            EXPECT_THAT(cell["reason"].asString(), testing::HasSubstr(reason));
        }
    }
}

TEST(BrokenPlugins, whose_file_vanishes_or_is_exchanged_lose_their_own_cells) {
    struct {
        const char *what, *reason;
    } const faults[] = {
        {"remove", "No such file or directory"},
        {"exchange", "cannot be used: the loader says '"},
        {"append", " changed while it was opened: its checksum was "},
    };
    for (const auto& [what, reason] : faults) {
        SCOPED_TRACE(what);
        const ScratchFolder folder;
        const fs::path plugins = folder.path() / "plugins";
        fs::create_directory(plugins);
        fs::copy(broken_plugin_folder("spoils_its_file") + "/spoils_its_file.so", plugins);
        const fs::path out = folder.path() / "out";
        const Finished finished = run_lodbench(
            {"run", tiny_scenario(folder.path(), "repetitions = 2\n").string(), "--out",
             out.string(), "--method", "spoils-its-file", "--method", "healthy", "--plugin-dir",
             plugins.string(), "--plugin-dir", broken_plugin_folder("healthy")},
            folder.path(), [what = what] { setenv("LODBENCH_TEST_SPOILS", what, 1); });
        EXPECT_EQ(finished.status, 3) << finished.output;
        const std::vector<Json::Value> cells = cells_of(out);
        EXPECT_EQ(cells.size(), 4U);
        for (const Json::Value& cell : cells) {
            const bool good = cell["method"] == "healthy";
            EXPECT_EQ(cell["status"], good ? "ok" : "failed");
            if (good) continue;
            EXPECT_THAT(cell["reason"].asString(), HasSubstr(reason));
        }
    }
}

TEST(BrokenPlugins, that_hang_in_an_exit_handler_keep_the_result_that_was_written) {
    auto cells = beside_a_healthy_one("hangs_at_exit", "hangs-at-exit", 0);
    for (const Json::Value& cell : cells["hangs-at-exit"]) {
        EXPECT_EQ(cell["status"], "ok") << cell["reason"];
        ASSERT_GE(cell["warnings"].size(), 1U);
        bool said = false;
        for (const Json::Value& warning : cell["warnings"]) {
            said |= warning.asString().find("after the result was written: ") == 0;
        }
        EXPECT_TRUE(said);
    }
}

TEST(BrokenPlugins, that_hang_cost_a_mesh_its_time_limit) {
    const ScratchFolder folder;
    const fs::path out = folder.path() / "loops.ply";
    const Finished finished =
        run_lodbench({"mesh", "loops", tiny_scenario(folder.path(), "").string(), "--plugin-dir",
                      broken_plugin_folder("loops"), "--out", out.string(), "--time-limit", "3"},
                     folder.path());
    EXPECT_EQ(finished.status, 3) << finished.output;
    EXPECT_THAT(finished.output, HasSubstr("gave no answer within 3 s, in draw"));
    EXPECT_FALSE(fs::exists(out));
}

TEST(BrokenPlugins, that_do_not_load_are_refused_with_a_warning_and_recorded) {
    const ScratchFolder folder;
    const fs::path out = folder.path() / "out";
    const Finished finished = run_lodbench(
        {"run", tiny_scenario(folder.path(), "repetitions = 1\n").string(), "--out", out.string(),
         "--method", "healthy", "--plugin-dir", broken_plugin_folder("healthy"), "--plugin-dir",
         broken_plugin_folder("wrong_abi"), "--plugin-dir",
         broken_plugin_folder("constructor_aborts")},
        folder.path());
    EXPECT_EQ(finished.status, 0) << finished.output;
    EXPECT_THAT(finished.output, HasSubstr("its interface number is 99, expected 1"));
    const std::string run = text_of(out / "run.json");
    EXPECT_THAT(run, HasSubstr("its interface number is 99, expected 1"));
    EXPECT_THAT(run, HasSubstr("aborted (signal 6) (its last words: 'out of luck')"));
}

TEST(BrokenPlugins, an_unknown_method_lists_the_refusals_before_anything_runs) {
    const ScratchFolder folder;
    const Finished finished =
        run_lodbench({"run", tiny_scenario(folder.path(), "repetitions = 1\n").string(), "--out",
                      (folder.path() / "out").string(), "--method", "wrong-tag", "--plugin-dir",
                      broken_plugin_folder("wrong_tag")},
                     folder.path());
    EXPECT_EQ(finished.status, 2);
    EXPECT_THAT(finished.output, HasSubstr("--method wrong-tag: no method 'wrong-tag' was found"));
    EXPECT_THAT(finished.output, HasSubstr("its ABI tag is 'another compiler', expected 'gcc"));
    EXPECT_FALSE(fs::exists(folder.path() / "out" / "run.json"));
}

}  // namespace
}  // namespace lodbench::test
