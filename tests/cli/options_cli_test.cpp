// Options and words of the command line mean the same to every command.

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(CommandLine, names_the_word_that_is_no_command_and_the_commands) {
    const ScratchFolder folder;
    const Finished top = run_lodbench({"fly"}, folder.path());
    EXPECT_EQ(top.status, 2);
    EXPECT_THAT(top.output, HasSubstr("there is no command 'fly'; known: list, describe, run"));
    EXPECT_THAT(top.output, Not(HasSubstr("cell"))) << "the hidden command stays hidden";
    EXPECT_THAT(
        run_lodbench({"terrain", "fly"}, folder.path()).output,
        HasSubstr("there is no command 'fly'; known: info, import, synth, upsample, verify"));
}

TEST(CommandLine, a_repeatable_option_leaves_what_follows_its_value_alone) {
    const ScratchFolder folder;
    const std::string plugins = broken_plugin_folder("healthy");
    const Finished described =
        run_lodbench({"describe", "--plugin-dir", plugins, "every-sample"}, folder.path());
    EXPECT_EQ(described.status, 0) << described.output;
    const std::string out = (folder.path() / "m.ply").string();
    const Finished mesh =
        run_lodbench({"mesh", "--plugin-dir", plugins, "--set", "template.step=4", "template",
                      tiny_scenario(folder.path(), "").string(), "-o", out},
                     folder.path());
    EXPECT_EQ(mesh.status, 0) << mesh.output;
}

TEST(CommandLine, a_setting_without_a_method_is_of_the_one_that_is_asked_for) {
    const ScratchFolder folder;
    const std::string scenario = tiny_scenario(folder.path(), "repetitions = 1\n").string();
    const auto run = [&](const std::string& out, const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {
            "run", scenario, "--no-truth", "--out", folder.path() / out, "--set", "step=4"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_lodbench(arguments, folder.path());
    };
    const Finished one = run("one", {"--method", "template"});
    EXPECT_EQ(one.status, 0) << one.output;
    EXPECT_EQ(cells_of(folder.path() / "one").at(0)["cell"], "template__step=4__tiny__r0");
    for (const std::vector<std::string>& methods :
         {std::vector<std::string>{}, {"--method", "template", "--method", "every-sample"}}) {
        const Finished many = run("many", methods);
        EXPECT_EQ(many.status, 2);
        EXPECT_THAT(many.output, HasSubstr("--set step=4: of which method? Write METHOD.step=4"));
    }
}

TEST(CommandLine, an_unknown_method_is_refused_alike_by_every_command) {
    const ScratchFolder folder;
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"describe", "nope"},
          {"mesh", "nope", "-o", "m.ply"},
          {"run", "--method", "nope", "--out", (folder.path() / "out").string()}}) {
        const Finished finished = run_lodbench(arguments, folder.path());
        EXPECT_EQ(finished.status, 2);
        // Which methods there are is no business of this test.
        EXPECT_THAT(finished.output, HasSubstr("no method 'nope' was found; known: "));
        EXPECT_THAT(finished.output, HasSubstr("every-sample, "));
        EXPECT_THAT(finished.output, HasSubstr(", template"));
    }
}

TEST(CommandLine, values_that_no_measurement_can_use_are_refused_before_any_flight) {
    const ScratchFolder folder;
    const std::string scenario = tiny_scenario(folder.path(), "repetitions = 1\n").string();
    const std::string out = (folder.path() / "out").string();
    std::ofstream(folder.path() / "hill.asc")
        << "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n";
    const std::string hill = (folder.path() / "hill.asc").string();
    const std::string long_value = "strided.uncovered=0." + std::string(300, '0');
    struct {
        std::vector<std::string> arguments;
        const char* words;
    } const refused[] = {
        {{"terrain", "info", hill, "--vertical-scale", "0"}, "expected a finite number, not 0"},
        {{"match", scenario, "--error", "1px", "--tolerance", "nan", "--out", out},
         "expected a number of percent"},
        {{"validate", "--time-factor", "nan", "x.so"}, "expected a finite number"},
        {{"validate", "--time-limit", "inf", "x.so"}, "expected a finite number above 0"},
        {{"mesh", "strided", "--time-limit", "0", "--out", out},
         "expected a finite number above 0"},
        {{"run", scenario, "--repeat", "1001", "--out", out}, "1 to 1000"},
        {{"run", scenario, "--method", "strided", "--set", long_value, "--out", out},
         "write shorter values"},
    };
    for (const auto& [arguments, words] : refused) {
        const Finished finished = run_lodbench(arguments, folder.path());
        EXPECT_EQ(finished.status, 2) << finished.output;
        EXPECT_THAT(finished.output, HasSubstr(words));
        EXPECT_FALSE(fs::exists(out));
    }
    std::ofstream(hill + ".toml") << "vertical_scale = 0\n";
    const Finished sidecar = run_lodbench({"terrain", "info", hill}, folder.path());
    EXPECT_EQ(sidecar.status, 2) << sidecar.output;
    EXPECT_THAT(sidecar.output, HasSubstr("must not be 0"));
}

TEST(DefaultFolder, runs_that_start_together_get_one_each_and_a_refused_run_leaves_none) {
    const ScratchFolder folder;
    const std::string scenario = tiny_scenario(folder.path(), "repetitions = 1\n").string();
    const auto there = [&] { fs::current_path(folder.path()); };
    std::vector<pid_t> runs;
    for (const char* log : {"a", "b", "c"}) {
        runs.push_back(start_lodbench({"run", scenario, "--method", "template", "--no-truth"},
                                      folder.path() / log, there));
    }
    for (const pid_t run : runs) {
        int status = -1;
        waitpid(run, &status, 0);
        EXPECT_EQ(status, 0);
    }
    const auto count = [&] {
        return std::distance(fs::directory_iterator(folder.path() / "lodbench-results"), {});
    };
    EXPECT_EQ(count(), 3);
    EXPECT_EQ(run_lodbench({"run", "none.toml"}, folder.path(), there).status, 2);
    EXPECT_EQ(count(), 3);
}

TEST(Resume, refuses_arguments_that_contradict_the_run_and_takes_the_same_again) {
    const ScratchFolder folder;
    const std::string scenario = tiny_scenario(folder.path(), "repetitions = 1\n").string();
    const std::string out = (folder.path() / "out").string();
    const std::vector<std::string> began = {"run", scenario, "--method", "refined", "--out", out};
    ASSERT_EQ(run_lodbench(began, folder.path()).status, 0);
    const auto again = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = began;
        more.emplace_back("--resume");
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_lodbench(arguments, folder.path());
    };
    EXPECT_EQ(again({}).status, 0);
    for (const std::vector<std::string>& more : {std::vector<std::string>{"--frames", "1"},
                                                 {"--seed", "7"},
                                                 {"--method", "strided"},
                                                 {"--set", "refined.tau=100"},
                                                 {"--repeat", "2"},
                                                 {"--size", "8x8"}}) {
        const Finished finished = again(more);
        EXPECT_EQ(finished.status, 2) << more.front() << finished.output;
        EXPECT_THAT(finished.output,
                    HasSubstr("run.json; give --resume and --out alone, or as it began: "));
    }
    EXPECT_EQ(cells_of(out).size(), 1U) << "no cell was added";
}

TEST(OutputFile, a_missing_folder_is_named_and_what_is_no_regular_file_stays) {
    const ScratchFolder folder;
    const std::string scenario = tiny_scenario(folder.path(), "").string();
    const auto mesh = [&](const std::string& out) {
        return run_lodbench({"mesh", "every-sample", scenario, "-o", out}, folder.path());
    };
    const Finished missing = mesh((folder.path() / "none" / "m.ply").string());
    EXPECT_EQ(missing.status, 4);
    EXPECT_THAT(missing.output, HasSubstr("No such file or directory; does its folder exist?"));
    const std::string pipe = (folder.path() / "pipe").string();
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const Finished special = mesh(pipe);
    EXPECT_EQ(special.status, 4);
    EXPECT_THAT(special.output, HasSubstr("it is not a regular file"));
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(Options, numbers_that_make_no_sense_are_refused_before_anything_is_read) {
    const ScratchFolder folder;
    const std::vector<std::vector<std::string>> commands = {
        {"terrain", "info", "any.tif", "--vertical-scale", "0"},
        {"terrain", "info", "any.tif", "--vertical-scale", "nan"},
        {"match", "--error", "1", "--tolerance", "nan"},
        {"run", "--repeat", "1001"}};
    for (const auto& command : commands) {
        const Finished finished = run_lodbench(command, folder.path());
        EXPECT_EQ(finished.status, 2) << finished.output;
        EXPECT_NE(finished.output.find(command[command.size() - 2]), std::string::npos)
            << finished.output;
    }
}

TEST(Options, devices_of_a_system_without_drivers_are_said_to_be_missing) {
    const ScratchFolder folder;
    const Finished finished = run_lodbench({"list", "--devices"}, folder.path(), [&] {
        setenv("__EGL_VENDOR_LIBRARY_DIRS", folder.path().c_str(), 1);
    });
    EXPECT_EQ(finished.status, 4);
    EXPECT_NE(finished.output.find("EGL names no device"), std::string::npos) << finished.output;
}

}  // namespace
}  // namespace lodbench::test
