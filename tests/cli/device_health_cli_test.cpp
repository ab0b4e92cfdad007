// The health of GPU and CPU in a run's results, and pauses between its cells.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;
using Clock = std::chrono::steady_clock;

Json::Value run_of(const fs::path& out) {
    return results::parse_json(text_of(out / "run.json"), "run.json");
}

class HealthCli : public testing::Test {
protected:
    void write(const fs::path& file, const std::string& text) const {
        fs::create_directories((sysfs / file).parent_path());
        std::ofstream(sysfs / file) << text;
    }
    /// With the fake sysfs, and without NVML.
    [[nodiscard]] Finished run(std::vector<std::string> words) const {
        for (const char* plugin : {"healthy", "sleeps"}) {
            words.insert(words.end(), {"--plugin-dir", broken_plugin_folder(plugin)});
        }
        return run_lodbench(words, scratch.path(), [this] {
            setenv("LODBENCH_SYSFS", sysfs.c_str(), 1);
            setenv("LODBENCH_NVML", "/nowhere/libnvidia-ml.so.1", 1);
        });
    }
    ScratchFolder scratch;
    const fs::path sysfs = scratch.path() / "sys";
    const std::string out = (scratch.path() / "out").string();
    const std::string scenario = tiny_scenario(scratch.path(), "").string();
};

TEST_F(HealthCli, without_sensors_all_is_null_and_nothing_is_said) {
    const Finished finished = run({"run", scenario, "--method", "healthy", "--out", out});
    ASSERT_EQ(finished.status, 0) << finished.output;
    const Json::Value health = run_of(out)["health"];
    for (const char* name : {"gpu", "cpu_governor", "cpu_max_mhz"}) {
        EXPECT_TRUE(health.isMember(name) && health[name].isNull()) << health;
    }
    EXPECT_EQ(health["gpu_absent"], "drawn in software");
    for (const Json::Value& warning : run_of(out)["warnings"]) {
        EXPECT_THAT(warning.asString(), HasSubstr("the flight of 'tiny': "));
    }
    for (const Json::Value& cell : cells_of(out)) {
        EXPECT_TRUE(cell.isMember("health"));
        for (const char* name : {"gpu_mhz", "gpu_c", "gpu_w", "gpu_throttle", "gpu_limit_c",
                                 "cpu_mhz", "cpu_throttles", "cgroup_held_s"}) {
            EXPECT_TRUE(results::member_of(cell, "health", name).isNull()) << name;
        }
    }
    EXPECT_THAT(text_of(fs::path(out) / "summary.md"), Not(HasSubstr("while it was timed")));
    const std::string page = (scratch.path() / "page.html").string();
    ASSERT_EQ(run_lodbench({"report", out, "-o", page}, scratch.path()).status, 0);
    EXPECT_THAT(text_of(page), HasSubstr("<dd>drawn in software</dd>"));
}

TEST_F(HealthCli, what_sysfs_says_of_the_cpu_stands_in_the_results) {
    for (int core = 0; core < 128; ++core) {
        const fs::path folder = "devices/system/cpu/cpu" + std::to_string(core);
        write(folder / "cpufreq/scaling_governor", "powersave\n");
        write(folder / "cpufreq/scaling_cur_freq", "3100000\n");
        write(folder / "cpufreq/cpuinfo_max_freq", "not a number\n");
    }
    const Finished finished = run({"run", scenario, "--method", "sleeps", "--out", out});
    ASSERT_EQ(finished.status, 0) << finished.output;
    EXPECT_EQ(run_of(out)["health"]["cpu_governor"], "powersave");
    EXPECT_TRUE(run_of(out)["health"]["cpu_max_mhz"].isNull());
    const Json::Value health = cells_of(out).at(0)["health"];
    ASSERT_TRUE(health.isObject());
    EXPECT_EQ(health["cpu_mhz"]["begin"].asDouble(), 3100);
    EXPECT_EQ(health["cpu_mhz"]["end"].asDouble(), 3100);
    EXPECT_GE(health["samples"].asInt(), 1);
    EXPECT_GE(health["cores"].asInt(), 1);
    EXPECT_GT(health["seconds"].asDouble(), 0);
    EXPECT_TRUE(health["gpu_mhz"].isNull());
    EXPECT_TRUE(health["cpu_throttles"].isNull());
}

TEST_F(HealthCli, cool_down_waits_between_cells_and_goes_on_as_it_began) {
    const auto begin = Clock::now();
    const Finished finished = run({"run", scenario, "--method", "healthy", "--repeat", "2",
                                   "--cool-down", "6.5", "--out", out});
    double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    ASSERT_EQ(finished.status, 0) << finished.output;
    EXPECT_EQ(run_of(out)["cool_down_s"], 6.5);
    for (const Json::Value& cell : cells_of(out)) seconds -= cell["cell_s"].asDouble();
    EXPECT_GE(seconds, 6.5) << "before the second, and of no cell's own time";
    EXPECT_EQ(run({"run", "--resume", "--out", out}).status, 0);
    const Finished other = run({"run", "--resume", "--out", out, "--cool-down", "9"});
    EXPECT_EQ(other.status, 2);
    EXPECT_THAT(other.output, HasSubstr("the run began with --cool-down 6.5, and 9 is asked for"));
}

TEST_F(HealthCli, cool_down_can_be_interrupted) {
    const fs::path log = scratch.path() / "interrupted.log";
    const pid_t child =
        start_lodbench({"run", scenario, "--method", "healthy", "--repeat", "2", "--plugin-dir",
                        broken_plugin_folder("healthy"), "--cool-down", "3000", "--out", out},
                       log);
    const auto patience = Clock::now() + 60s;
    while (Clock::now() < patience && text_of(fs::path(out) / "cells.jsonl").empty()) {
        std::this_thread::sleep_for(20ms);
    }
    std::this_thread::sleep_for(3s);  // the second cell would be over
    const auto begin = Clock::now();
    kill(child, SIGINT);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_LT(Clock::now() - begin, 30s);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 3);
    EXPECT_THAT(text_of(log), HasSubstr("interrupted; 1 finished cell is kept"));
}

TEST_F(HealthCli, a_cool_down_that_is_none_is_refused) {
    for (const char* value : {"-1", "nan", "inf", "-inf", "1e9", "3600.5", "soon", ""}) {
        for (const char* command : {"run", "sweep", "match", "economy", "plan"}) {
            const Finished finished = run({command, scenario, "--cool-down", value});
            EXPECT_NE(finished.status, 0) << command << value;
            EXPECT_THAT(finished.output, HasSubstr("--cool-down: ")) << command << " " << value;
            EXPECT_THAT(finished.output, HasSubstr("expected seconds, from 0 to 3600")) << value;
        }
    }
}

TEST_F(HealthCli, cool_down_is_in_the_time_that_plan_expects) {
    ASSERT_EQ(run({"run", scenario, "--method", "healthy", "--repeat", "4", "--out", out}).status,
              0);
    const auto plan = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = {"plan",     scenario, "--method", "healthy",
                                          "--repeat", "4",      "--from",   out,
                                          "--shards", "3",      "--json"};
        words.insert(words.end(), more.begin(), more.end());
        const Finished finished = run(words);
        EXPECT_EQ(finished.status, 0) << finished.output;
        return results::parse_json(finished.output, "plan");
    };
    const Json::Value without = plan({});
    const Json::Value with = plan({"--cool-down", "100"});
    // Four cells in three shards: the first of a shard waits for nothing.
    EXPECT_NEAR(with["expected_s"].asDouble() - without["expected_s"].asDouble(), 100, 1e-6);
    EXPECT_NEAR(
        with["shards"][0]["expected_s"].asDouble() - without["shards"][0]["expected_s"].asDouble(),
        100, 1e-6);
    EXPECT_EQ(with["shards"][1]["expected_s"], without["shards"][1]["expected_s"]);
}

}  // namespace
}  // namespace lodbench::test
