// Each of many misbehaving methods loses its own cell, or is warned of in it, and nothing else: the
// methods that fly beside it measure what they measure alone, and no process and no file of anyone
// else's is touched.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/prctl.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>

#include "base/process_tree.h"
#include "run/plugin_library.h"
#include "sanitizers/sanitizers.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::Contains;
using testing::StartsWith;

constexpr std::size_t kFewestMisbehaviours = 54;

struct Expectation {
    const char* method;
    const char* status;
    const char* words;  ///< begins the reason, or of a cell that is ok a warning; "" for none
};

constexpr Expectation kAnswers[] = {
    {"creates-nothing", "failed",
     "create of plugin misbehaves_answers.so threw: create gave no method and no reason"},
    {"counts-nan", "ok", ""},
    {"counts-without-end", "ok", ""},
    {"counts-with-a-huge-name", "ok", ""},
    {"counts-with-bytes-for-names", "ok", ""},
    {"counts-thousands", "ok", ""},
};

constexpr Expectation kEndings[] = {
    {"exits-from-select", "crashed",
     "the process exited with status 0 in select of plugin misbehaves_endings.so, frame 0 of the "
     "timing replay before its result was written"},
    {"exits-from-create", "crashed", "the process exited with status 0 in create"},
    {"exits-from-destroy", "crashed", "the process exited with status 0 in destroy"},
    {"leaves-without-handlers", "crashed", "the process exited with status 0 in select"},
    {"quits-quickly", "crashed", "the process exited with status 0 in select"},
    {"terminates", "crashed", "aborted (signal 6) in select"},
    {"throws-a-number", "failed",
     "select of plugin misbehaves_endings.so threw something that is not a std::exception"},
    {"throws-while-it-is-destroyed", "crashed", "aborted (signal 6) in destroy"},
    {"throws-much-text", "failed", "select of plugin misbehaves_endings.so threw: aaaaaaaa"},
    {"throws-bytes", "failed", "select of plugin misbehaves_endings.so threw: "},
    {"throws-nothing-to-read", "failed", "select of plugin misbehaves_endings.so threw: "},
    {"throws-a-full-disk", "failed",
     "draw of plugin misbehaves_endings.so threw: cannot write x: No space left on device"},
    {"throws-bad-input", "failed",
     "draw of plugin misbehaves_endings.so threw: --out: somewhere else"},
    {"asks-for-too-much-memory", "failed",
     "select of plugin misbehaves_endings.so threw: std::bad_alloc"},
    {"recurses-without-end", "crashed", "segmentation fault (signal 11) in select"},
    {"divides-by-zero", "crashed", "floating point exception (signal 8) in select"},
    {"runs-into-a-trap", "crashed", "trace/breakpoint trap (signal 5) in select"},
    {"kills-itself", "crashed", "killed (signal 9) in select"},
    {"stops-itself", "timeout", "no sign of life for "},
    {"loops-deaf-to-signals", "timeout", "no sign of life for "},
    {"deadlocks-in-pause", "timeout", "no sign of life for "},
    {"hangs-in-counters", "timeout", "no sign of life for "},
    {"crashes-at-exit", "ok", "after the result was written: aborted (signal 6)"},
    {"crashes-in-a-static-destructor", "ok",
     "after the result was written: segmentation fault (signal 11)"},
    {"crashes-in-a-thread-at-exit", "ok",
     "after the result was written: segmentation fault (signal 11)"},
    {"exits-otherwise-at-exit", "ok",
     "after the result was written: the process exited with status 9"},
    {"works-on-when-destroyed", "ok", ""},
};

constexpr Expectation kEnvironment[] = {
    {"sets-a-variable", "ok", "left the environment (LODBENCH_MISBEHAVES) changed in select"},
    {"clears-the-environment", "ok", "left the environment ("},
    {"changes-directory", "ok", "left the working directory changed in select"},
    {"changes-umask", "ok", "left the umask changed in select"},
    {"changes-locale", "ok", "left the locale changed in select"},
    {"changes-the-threads-locale", "ok", "left the locale changed in select"},
    {"rounds-upwards", "ok", "left the floating-point rounding mode changed in select"},
    {"rounds-towards-zero-in-draw", "ok", "left the floating-point rounding mode changed in draw"},
#if defined(__SSE2__)
    {"flushes-to-zero", "ok", "left flush-to-zero changed in select"},
    {"takes-denormals-for-zero", "ok", "left denormals-are-zero changed in select"},
    {"traps-invalid-operations", "ok", "left the floating-point traps changed in select"},
#else
    {"flushes-to-zero", "ok", ""},
    {"takes-denormals-for-zero", "ok", ""},
    {"traps-invalid-operations", "ok", ""},
#endif
    {"handles-segmentation-faults", "ok", "left signal handlers changed in select"},
    {"ignores-its-children", "ok", "left signal handlers changed in select"},
    {"blocks-signals", "ok", "left the signal mask changed in select"},
    {"gives-way", "ok", "left the scheduling priority changed in select"},
    {"pins-its-thread", "ok", "left the processors that it runs on changed in select"},
    {"closes-standard-streams", "ok", "left descriptors 0 to 2 changed in select"},
    {"sends-its-output-elsewhere", "ok", "left descriptors 0 to 2 changed in select"},
    {"lowers-the-limit-of-open-files", "failed",
     "select of plugin misbehaves_environment.so lowered a limit of its process: open files: 64"},
    {"lowers-the-limit-of-file-sizes", "failed",
     "select of plugin misbehaves_environment.so lowered a limit of its process: bytes of a file: "
     "0"},
    {"lowers-the-limit-of-memory", "failed",
     "pause_background of plugin misbehaves_environment.so lowered a limit of its process: bytes "
     "of "
     "address space: 67108864"},
    {"closes-the-result", "crashed",
     "the process exited with status 1 after the last call of plugin misbehaves_environment.so"},
    {"exchanges-the-result", "crashed",
     "the process exited with status 1 after the last call of plugin misbehaves_environment.so"},
    {"closes-all-it-did-not-open", "crashed", "the process exited with status 1 after the last"},
    {"prints-garbage", "ok", ""},
};

constexpr Expectation kLeaks[] = {
    {"leaks-memory", "ok", ""},
    {"leaks-mappings", "ok", ""},
    {"leaks-textures", "ok", ""},
    {"leaks-buffers", "ok", ""},
    {"leaks-vertex-arrays", "ok", ""},
    {"leaks-threads", "ok", ""},
    {"leaks-a-descriptor-a-frame", "ok", ""},
    {"leaks-temporary-files", "ok", ""},
    {"leaks-shared-memory", "ok", ""},
    {"leaks-semaphores", "ok", ""},
    {"leaks-timer-descriptors", "ok", ""},
    {"leaves-an-alarm", "crashed", "alarm clock (signal 14)"},
    {"leaks-children", "ok", "left 4 processes behind, which were ended: lodbench, lodbench"},
};

constexpr Expectation kProcesses[] = {
    {"starts-a-session", "ok", "left 1 process behind, which was ended: misbehaves"},
    {"starts-a-daemon", "ok", "left 1 process behind, which was ended: misbehaves"},
    {"starts-many", "ok", "left 20 processes behind, which were ended: lodbench, lodbench"},
    {"fills-memory-elsewhere", "failed", "exceeded the memory limit of 700 MiB in select"},
    {"comes-back-twice", "ok", "1 copy of the process came back from a call (fork) and was ended"},
    {"ends-its-parent", "crashed", "killed (signal 9) "},
    {"kills-its-group", "crashed", "killed (signal 9) in select"},
};

constexpr Expectation kLoading[] = {
#if defined(__SSE2__)
    {"flushes-when-loaded", "ok",
     "left flush-to-zero changed in a constructor that runs while it is loaded"},
#else
    {"flushes-when-loaded", "ok", ""},
#endif
};

struct Theme {
    const char* plugin;
    std::span<const Expectation> expectations;
};
void PrintTo(const Theme& theme, std::ostream* stream) {
    *stream << theme.plugin;
}

const Theme kThemes[] = {
    {"misbehaves_answers", kAnswers},         {"misbehaves_endings", kEndings},
    {"misbehaves_environment", kEnvironment}, {"misbehaves_leaks", kLeaks},
    {"misbehaves_processes", kProcesses},     {"flushes_when_loaded", kLoading},
};

/// Fields of a cell that say how fast the machine was, or that follow from the seed that the plan
/// gave the cell: the hash is of a frame that the seed chooses.
bool is_of_the_moment(const std::string& field) {
    static const std::set<std::string> kFields = {
        "began",          "cell_s",         "fps",
        "jank_ms",        "frame_ms",       "select_ms",
        "submit_ms",      "gpu_ms",         "cpu_ms",
        "prepare_s",      "prepare_cpu_s",  "upload_s",
        "first_frame_ms", "peak_rss_bytes", "frames_checksum",
        "timer_verdict",  "seed",           "depth_hash"};
    return kFields.contains(field);
}

/// The cells of a run by their method.
std::map<std::string, Json::Value> cells_by_method(const fs::path& out) {
    std::map<std::string, Json::Value> cells;
    for (const Json::Value& cell : cells_of(out)) cells[cell["method"].asString()] = cell;
    return cells;
}

void expect_same_figures(const Json::Value& alone, const Json::Value& beside) {
    for (const std::string& field : alone.getMemberNames()) {
        if (is_of_the_moment(field)) continue;
        EXPECT_EQ(alone[field], beside[field]) << alone["method"] << ": " << field;
    }
}

void expect_cell(const Expectation& expected, const Json::Value& cell) {
    SCOPED_TRACE(expected.method);
    EXPECT_EQ(cell["status"].asString(), expected.status) << cell["reason"];
    if (cell["status"] != "ok") {
        EXPECT_THAT(cell["reason"].asString(), StartsWith(expected.words));
        EXPECT_LE(cell["reason"].asString().size(), 1200U);
        return;
    }
    EXPECT_EQ(cell["frames"].asInt(), 2);
    if (*expected.words == '\0') return;
    std::vector<std::string> warnings;
    for (const Json::Value& warning : cell["warnings"]) warnings.push_back(warning.asString());
    EXPECT_THAT(warnings, Contains(StartsWith(expected.words)));
}

int processors() {
    cpu_set_t set;
    CPU_ZERO(&set);
    sched_getaffinity(0, sizeof set, &set);
    return CPU_COUNT(&set);
}

class MisbehavingPlugins : public testing::TestWithParam<Theme> {
protected:
    MisbehavingPlugins() {
        // What a run leaves without a parent becomes a child of this process, and is seen.
        prctl(PR_SET_CHILD_SUBREAPER, 1);
    }

    /// Flies the two good methods and `more`.
    Finished fly(const fs::path& out, const std::vector<std::string>& more) const {
        std::vector<std::string> arguments = {"run",          scenario_.string(),
                                              "--out",        out.string(),
                                              "--method",     "healthy",
                                              "--method",     "template",
                                              "--plugin-dir", broken_plugin_folder("healthy")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_lodbench(arguments, folder_.path(), leave_signals_to_the_system);
    }

    const ScratchFolder folder_;
    const fs::path scenario_ = tiny_scenario(
        folder_.path(), std::string("repetitions = 1\nmemory_limit_mib = 700\n") +
                            "frame_time_limit_s = " + (kSlowness == 1 ? "3" : "20") + "\n");
};

TEST_P(MisbehavingPlugins, lose_their_own_cell_and_nothing_else) {
    const Theme& theme = GetParam();
    const std::string foreign = "not lodbench's\n";
    std::ofstream(folder_.path() / "notes.txt") << foreign;
    ASSERT_EQ(fly(folder_.path() / "alone", {}).status, 0);

    std::vector<std::string> arguments = {"--plugin-dir", broken_plugin_folder(theme.plugin)};
    bool all_well = true;
    for (const Expectation& expected : theme.expectations) {
        arguments.insert(arguments.end(), {"--method", expected.method});
        all_well &= std::string(expected.status) == "ok";
    }
    const fs::path out = folder_.path() / "beside";
    const Finished finished = fly(out, arguments);
    EXPECT_EQ(finished.status, all_well ? 0 : 3) << finished.output.substr(0, 20000);
    EXPECT_EQ(finished.output.find('\x1b'), std::string::npos) << "a terminal was steered";

    auto cells = cells_by_method(out);
    EXPECT_EQ(cells.size(), theme.expectations.size() + 2);
    for (const Expectation& expected : theme.expectations) {
        if (std::string(expected.method) == "pins-its-thread" && processors() == 1) continue;
        expect_cell(expected, cells[expected.method]);
        EXPECT_TRUE(
            fs::exists(out / "frames" / (cells[expected.method]["cell"].asString() + ".csv")));
    }
    auto alone = cells_by_method(folder_.path() / "alone");
    for (const char* good : {"healthy", "template"}) {
        EXPECT_EQ(cells[good]["status"], "ok") << cells[good]["reason"];
        expect_same_figures(alone[good], cells[good]);
    }
    for (const char* file : {"run.json", "cells.jsonl", "summary.md"}) {
        EXPECT_TRUE(fs::is_regular_file(out / file)) << file;
    }
    EXPECT_EQ(run_lodbench({"report", out.string(), "--out", (folder_.path() / "r.html").string()},
                           folder_.path())
                  .status,
              0)
        << "the folder is whole";
    EXPECT_EQ(text_of(folder_.path() / "notes.txt"), foreign);
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
        names.insert(entry.path().filename().string());
    }
    EXPECT_THAT(names, testing::UnorderedElementsAre("alone", "beside", "lodbench.log", "notes.txt",
                                                     "r.html", "tiny.toml"));
    EXPECT_THAT(base::children_of(getpid()), testing::IsEmpty()) << "a process is left";
}

INSTANTIATE_TEST_SUITE_P(each, MisbehavingPlugins, testing::ValuesIn(kThemes),
                         [](const auto& theme) { return std::string(theme.param.plugin); });

/// The plugins in the folders of broken ones that keep every promise: the neighbour, and those of
/// other tests.
bool is_not_broken(const std::string& name) {
    static const std::set<std::string> kGood = {"healthy", "duplicate", "lags", "reads_tiles",
                                                "tessellates"};
    return kGood.contains(name);
}

TEST(MisbehavingPluginsAll, are_as_many_as_promised_and_each_is_expected_of) {
    std::set<std::string> expected;
    for (const Theme& theme : kThemes) {
        for (const Expectation& expectation : theme.expectations) {
            expected.insert(expectation.method);
        }
    }
    std::size_t misbehaviours = 0;
    std::set<std::string> themed;
    for (const auto& folder : fs::directory_iterator(broken_plugin_folder(""))) {
        const std::string name = folder.path().filename().string();
        if (is_not_broken(name)) continue;
        const run::PluginListing plugin =
            run::list_plugin(folder.path() / (name + ".so"), std::chrono::seconds(3));
        // One that is refused is a misbehaviour itself.
        misbehaviours += std::max<std::size_t>(plugin.methods.size(), 1);
        const bool is_theme = std::ranges::find(kThemes, name, &Theme::plugin) != std::end(kThemes);
        for (const run::MethodInfo& method : plugin.methods) {
            if (is_theme) themed.insert(method.id);
        }
    }
    EXPECT_EQ(themed, expected);
    EXPECT_GE(misbehaviours, kFewestMisbehaviours);
}

}  // namespace
}  // namespace lodbench::test
