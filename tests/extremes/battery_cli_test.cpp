// The command as a person types it: what it flies, writes and refuses.

#include <gmock/gmock.h>

#include <fstream>

#include "compare/extremes.h"
#include "results/extremes.h"
#include "results/json.h"
#include "support/run_lodbench.h"

namespace lodbench {
namespace {

using testing::HasSubstr;

class ExtremesCommand : public testing::Test {
protected:
    test::Finished push(const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {"extremes", "--quick", "--out",
                                              (folder_.path() / "out").string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::run_lodbench(arguments, folder_.path());
    }
    results::ExtremesMatrix matrix() {
        return results::read_extremes_folder(folder_.path() / "out");
    }
    test::ScratchFolder folder_;
};

TEST_F(ExtremesCommand, writes_the_matrix_in_three_forms_and_takes_up_what_was_interrupted) {
    const test::Finished flown =
        push({"--method", "every-sample", "--axis", "origin", "--axis", "tolerance"});
    EXPECT_EQ(flown.status, 0) << flown.output;
    EXPECT_THAT(flown.output, HasSubstr("stable 1/1"));
    const results::ExtremesMatrix first = matrix();
    ASSERT_EQ(first.cells.size(), 2U);
    EXPECT_EQ(first.find("every-sample", "origin")->steps.front().figures->moved_m, 0);
    // Nothing to turn: said, and no failure.
    EXPECT_EQ(first.find("every-sample", "tolerance")->grade, "not-flown");
    EXPECT_THAT(test::text_of(folder_.path() / "out/extremes.md"), HasSubstr("## Far from the"));
    EXPECT_THAT(test::text_of(folder_.path() / "out/extremes.html"), HasSubstr("stable 1/1"));

    const std::string steps = test::text_of(folder_.path() / "out/steps.jsonl");
    EXPECT_EQ(push({"--method", "every-sample"}).status, 2) << "the folder holds a battery";
    // A line that a killed writer left, and the last step missing.
    const std::size_t cut = steps.rfind('\n', steps.size() - 2);
    std::ofstream(folder_.path() / "out/steps.jsonl") << steps.substr(0, cut + 10);
    const test::Finished again =
        push({"--method", "every-sample", "--axis", "origin", "--axis", "tolerance", "--resume"});
    EXPECT_EQ(again.status, 0) << again.output;
    results::ExtremesMatrix second = matrix();
    EXPECT_TRUE(compare::compare_extremes(first, second).changes.empty());
    EXPECT_FALSE(first.device.empty());
    EXPECT_EQ(second.device, first.device);
    EXPECT_EQ(second.terrain_checksum, first.terrain_checksum);
    EXPECT_EQ(second.find("every-sample", "origin")->steps.front().seconds,
              first.find("every-sample", "origin")->steps.front().seconds)
        << "was flown again";
}

TEST_F(ExtremesCommand, exits_with_1_for_a_failure_that_nobody_has_explained) {
    const test::Finished flown = push({"--method", "float-world", "--plugin-dir",
                                       test::broken_plugin_folder("unstable"), "--axis", "origin"});
    EXPECT_EQ(flown.status, 1) << flown.output;
    EXPECT_THAT(flown.output,
                HasSubstr("float-world origin, 1e7 m: moved: the surface lies up to"));
    EXPECT_THAT(flown.output, HasSubstr("0 failures explained as inherent"));
}

TEST_F(ExtremesCommand, a_plugin_that_dies_or_sends_what_is_no_number_costs_its_own_step) {
    const auto outcome = [&](const char* plugin, const char* method) {
        std::filesystem::remove_all(folder_.path() / "out");
        const test::Finished flown = push({"--method", method, "--plugin-dir",
                                           test::broken_plugin_folder(plugin), "--axis", "origin"});
        EXPECT_EQ(flown.status, 1) << flown.output;
        const results::ExtremesStep step = matrix().cells.front().steps.front();
        return step.outcome + " " + step.faults.front().what + " " + step.faults.front().words;
    };
    EXPECT_THAT(outcome("segfaults", "segfaults"), HasSubstr("dead crash"));
    EXPECT_THAT(outcome("segfaults", "segfaults"), HasSubstr("signal 11"));
    EXPECT_THAT(outcome("draws_nan", "draws-nan"), HasSubstr("broken not-finite"));
    EXPECT_THAT(outcome("throws_in_select", "throws-in-select"), HasSubstr("broken failed select"));
}

TEST_F(ExtremesCommand, names_what_there_is_where_an_axis_or_a_step_is_not) {
    const test::Finished axis = push({"--axis", "taste"});
    EXPECT_EQ(axis.status, 2);
    EXPECT_THAT(axis.output, HasSubstr("there is no axis 'taste'; known: origin, "));
    const test::Finished step = push({"--axis", "origin", "--step", "1e99 m"});
    EXPECT_EQ(step.status, 2);
    EXPECT_THAT(step.output, HasSubstr("--step 1e99 m: no axis that is flown has this step"));
}

TEST_F(ExtremesCommand, a_battery_with_a_mistake_is_refused_with_file_and_line) {
    const std::filesystem::path battery = folder_.path() / "battery";
    std::filesystem::copy(LODBENCH_SOURCE_DIR "/scenarios/extremes", battery);
    const auto refusal = [&](const char* file, const std::string& text) {
        const std::filesystem::path path = battery / file;
        const std::string before = test::text_of(path);
        std::ofstream(path) << before << text;
        const test::Finished refused = push({"--list", "--battery", battery.string()});
        std::ofstream(path) << before;
        EXPECT_EQ(refused.status, 2) << text;
        return refused.output;
    };
    EXPECT_THAT(refusal("origin.toml", "\n[[step]]\nname = \"0 m\"\n"),
                HasSubstr("a step before it has this name"));
    EXPECT_THAT(refusal("origin.toml", "\n[[step]]\nname = \"x\"\nscale = -2\n"),
                HasSubstr("scale = -2: out of range"));
    EXPECT_THAT(refusal("origin.toml", "\n[[step]]\nname = \"x\"\ntaste = 1\n"),
                HasSubstr("origin.toml:"));
    EXPECT_THAT(refusal("inherent.toml",
                        "\n[[inherent]]\nmethod = \"m\"\naxis = \"origin\"\n"
                        "steps = [\"none\"]\nwhy = \"w\"\n"),
                HasSubstr("axis origin has no step"));
}

results::ExtremesMatrix matrix_of(const char* outcome, const char* fault) {
    results::ExtremesMatrix made;
    made.form = "quick";
    made.methods = {"one"};
    made.axes = {{"lens", "Lens", "fields of view", {"90"}}};
    results::ExtremesCell& cell = made.cells.emplace_back();
    cell.method = "one";
    cell.axis = "lens";
    results::ExtremesStep& step = cell.steps.emplace_back();
    step.step = "90";
    step.outcome = outcome;
    if (*fault != 0) step.faults.push_back({fault, "", {}, {}, "", "in words", ""});
    results::sum_up(cell);
    return made;
}

TEST(ExtremesComparison, the_command_compares_the_folders_of_two_batteries) {
    const test::ScratchFolder folder;
    const auto write = [&](const char* name, const results::ExtremesMatrix& made) {
        std::filesystem::create_directory(folder.path() / name);
        std::ofstream(folder.path() / name / "extremes.json")
            << results::to_text(results::to_json(made));
    };
    write("base", matrix_of("good", ""));
    write("now", matrix_of("broken", "not-finite"));
    std::filesystem::create_directory(folder.path() / "other");
    const auto compare = [&](std::vector<std::string> arguments) {
        for (std::string& word : arguments) {
            if (!word.starts_with('-')) word = (folder.path() / word).string();
        }
        arguments.insert(arguments.begin(), "compare");
        return test::run_lodbench(arguments, folder.path());
    };
    const test::Finished gated = compare({"base", "now", "--gate"});
    EXPECT_EQ(gated.status, 1);
    EXPECT_THAT(gated.output, HasSubstr("90: good -> broken: not-finite"));
    EXPECT_EQ(compare({"base", "now"}).status, 0);
    const test::Finished refused = compare({"base", "other"});
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.output, HasSubstr("lodbench extremes"));
}

}  // namespace
}  // namespace lodbench
