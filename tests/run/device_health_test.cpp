// What a cell's watch sees of GPU and CPU, with sensors of every kind of ill will.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>

#include <atomic>
#include <future>
#include <thread>

#include "run/device_health.h"
#include "run/shared_signs.h"
#include "support/fake_sensors.h"

namespace lodbench::test {
namespace {

using namespace std::chrono_literals;
using results::HealthFigures;
using run::CpuSensors;
using run::DeviceHealth;
using run::Replay;
using run::VitalSigns;
using testing::Each;
using testing::ElementsAre;

constexpr int kFrames = 10;

/// A cell that tells of its flight, watched as the supervisor does it.
class FakeCell {
public:
    explicit FakeCell(DeviceHealth& health) : health_(health) {
        signs_->gpu.write(
            {"", "11111111-2222-3333-4444-555555555555", "NVIDIA Corporation", false});
        signs_->gpu_told = 1;
        health_.watch(*signs_);
    }
    void fly() {
        signs_->frames_of_replay = kFrames;
        signs_->frame = 0;
        signs_->replay = Replay::timing;
        for (int frame = 0; frame < kFrames; ++frame) {
            signs_->frame = frame;
            watch_for(10ms);
        }
    }
    void fly_on() {
        signs_->replay = Replay::lockstep;
        watch_for(10ms);
    }

private:
    void watch_for(std::chrono::milliseconds time) {
        for (auto end = std::chrono::steady_clock::now() + time;
             std::chrono::steady_clock::now() < end;) {
            health_.watch(*signs_);
            std::this_thread::sleep_for(1ms);
        }
    }
    DeviceHealth& health_;
    std::shared_ptr<VitalSigns> signs_ = run::map_signs();
};

DeviceHealth::Setup setup_of(const run::SensorPlaces& places,
                             std::chrono::milliseconds interval = 1000ms) {
    return {[places](const platform::GpuIdentity& gpu) { return find_gpu_sensors(gpu, places); },
            CpuSensors(places, {0, 1}), interval, 2000ms};
}

TEST(DeviceHealth, sees_the_clock_fall_and_the_throttling_of_the_timing_replay) {
    FakeSensors fake;
    fake.places.nvml = fake_nvml();
    nvml_answers(
        "clock=1980,1980,1188 temperature=70,80,92 threshold=90 power=300000,400000 "
        "reasons=0,0x40,0");
    DeviceHealth health(setup_of(fake.places, 15ms));
    EXPECT_FALSE(health.context().gpu) << "before a cell has drawn";
    FakeCell cell(health);
    cell.fly();
    cell.fly_on();
    const std::optional<HealthFigures> figures = health.finish();
    ASSERT_TRUE(figures);
    EXPECT_GE(figures->samples, 3);
    ASSERT_TRUE(figures->gpu_mhz && figures->gpu_c && figures->gpu_w);
    EXPECT_EQ(figures->gpu_mhz->begin, 1980);
    EXPECT_EQ(figures->gpu_mhz->end, 1188);
    EXPECT_EQ(figures->gpu_mhz->min, 1188);
    EXPECT_EQ(figures->gpu_mhz->max, 1980);
    EXPECT_NEAR(*figures->gpu_fall, 0.4, 1e-12);
    EXPECT_EQ(figures->gpu_c->max, 92);
    EXPECT_EQ(figures->gpu_limit_c, 90);
    EXPECT_EQ(figures->gpu_w->begin, 300);
    EXPECT_THAT(figures->gpu_throttle, testing::Optional(ElementsAre("hw_thermal_slowdown")));
    EXPECT_EQ(health.context().gpu.value().name, "Fake GPU 1");
    EXPECT_EQ(health.context().gpu_absent, "");
}

TEST(DeviceHealth, reads_seldom_and_once_more_near_the_end) {
    FakeSensors fake;
    fake.places.nvml = fake_nvml();
    nvml_answers("clock=1000,2000");
    DeviceHealth health(setup_of(fake.places));  // each second; the flight takes a tenth of it
    for (int again = 0; again < 2; ++again) {
        FakeCell cell(health);
        cell.fly();
        cell.fly_on();
        const std::optional<HealthFigures> figures = health.finish();
        ASSERT_TRUE(figures);
        EXPECT_EQ(figures->samples, 2);
        EXPECT_EQ(figures->gpu_mhz->begin, again == 0 ? 1000 : 2000);
        EXPECT_EQ(figures->gpu_fall, 0.0) << "it rose";
    }
}

TEST(DeviceHealth, is_null_where_the_replay_was_never_seen_and_there_where_it_was_not_finished) {
    FakeSensors fake;
    DeviceHealth health(setup_of(fake.places));
    {
        FakeCell cell(health);
        cell.fly_on();
        EXPECT_EQ(health.finish(), std::nullopt);
    }
    FakeCell cell(health);
    cell.fly();
    EXPECT_TRUE(health.finish());
}

TEST(DeviceHealth, without_sensors_is_null_and_says_why) {
    FakeSensors fake;
    DeviceHealth health(setup_of(fake.places));
    FakeCell cell(health);
    cell.fly();
    cell.fly_on();
    const std::optional<HealthFigures> figures = health.finish();
    ASSERT_TRUE(figures);
    Json::Value json = results::encode(*figures);
    for (const char* known : {"samples", "seconds", "cores"}) json.removeMember(known);
    for (const std::string& name : json.getMemberNames()) {
        EXPECT_TRUE(json[name].isNull()) << name << json[name];
    }
    const results::HealthContext context = health.context();
    EXPECT_FALSE(context.gpu);
    EXPECT_EQ(context.cpu_governor, "");
    EXPECT_FALSE(context.cpu_max_mhz);
    EXPECT_THAT(context.gpu_absent, testing::HasSubstr("NVML does not load"));
}

class Stuck final : public run::GpuSensors {
public:
    explicit Stuck(std::shared_future<void> until) : until_(std::move(until)) {}
    [[nodiscard]] const run::GpuFacts& facts() const override { return facts_; }
    [[nodiscard]] run::GpuReading read() override {
        until_.wait();
        return {};
    }

private:
    const run::GpuFacts facts_{"stuck", "a driver", "", {}, {}};
    const std::shared_future<void> until_;
};

TEST(DeviceHealth, a_driver_that_does_not_answer_holds_nobody_up) {
    std::promise<void> answer;
    const std::shared_future<void> answered = answer.get_future().share();
    FakeSensors fake;
    const auto begin = std::chrono::steady_clock::now();
    {
        DeviceHealth::Setup setup = setup_of(fake.places, 5ms);
        setup.find_gpu = [answered](const platform::GpuIdentity&) {
            return run::FoundGpu{std::make_unique<Stuck>(answered), ""};
        };
        setup.patience = 50ms;
        DeviceHealth health(std::move(setup));
        for (int cells = 0; cells < 2; ++cells) {
            FakeCell cell(health);
            cell.fly();
            cell.fly_on();
            EXPECT_EQ(health.finish(), std::nullopt);
        }
        EXPECT_EQ(health.context().gpu_absent, "its sensors stopped to answer");
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s);
    answer.set_value();  // its thread ends
}

TEST(GpuNote, gives_back_names_and_uuids_and_nothing_else) {
    run::GpuNote note;
    note.write({"renderD128", "11111111-2222-3333-4444-555555555555", "NVIDIA Corporation", true});
    platform::GpuIdentity read = note.read();
    EXPECT_EQ(read.node, "renderD128");
    EXPECT_EQ(read.uuid, "11111111-2222-3333-4444-555555555555");
    EXPECT_EQ(read.vendor, "NVIDIA Corporation");
    EXPECT_TRUE(read.software);
    note.write({"../../etc", "../x", "\x1b[31m", false});  // what a plugin may have scribbled there
    read = note.read();
    EXPECT_EQ(read.node + read.uuid + read.vendor, "");
    note.write({std::string(100, 'c'), "", "", false});
    EXPECT_EQ(note.read().node, std::string(31, 'c')) << "cut, and ended";
}

TEST(CpuSensors, are_the_governor_the_fastest_core_and_what_slowed_them_down) {
    FakeSensors fake;
    const fs::path cpu = "sys/devices/system/cpu";
    fake.write(cpu / "cpu0/cpufreq/scaling_cur_freq", "3100000\n");
    fake.write(cpu / "cpu1/cpufreq/scaling_cur_freq", "1200000\n");
    fake.write(cpu / "cpu2/cpufreq/scaling_cur_freq", "5000000\n");
    fake.write(cpu / "cpu0/cpufreq/cpuinfo_max_freq", "3900000\n");
    fake.write(cpu / "cpu0/cpufreq/scaling_governor", "powersave\n");
    fake.write(cpu / "cpu1/cpufreq/scaling_governor", "performance\n");
    for (const char* core : {"cpu0", "cpu1"}) {
        fake.write(cpu / core / "thermal_throttle/core_throttle_count", "3\n");
        fake.write(cpu / core / "thermal_throttle/package_throttle_count", "10\n");
        fake.write(cpu / core / "topology/physical_package_id", "0\n");
    }
    fake.write("proc/loadavg", "1.50 1.00 0.50 3/120 99\n");
    fake.write("proc/stat",
               "cpu  9 9 9 9 9 9 9 9 0 0\ncpu0 100 10 20 300 5 0 1 2 0 0\n"
               "cpu1 100 10 20 300 5 0 1 2 0 0\ncpu2 999 9 9 9 9 9 9 9 0 0\n");
    fake.write("proc/self/cgroup", "0::/job/task\n");
    fake.write("sys/fs/cgroup/job/cpu.stat",
               "usage_usec 5\nnr_throttled 2\nthrottled_usec 250000\n");
    fake.write("sys/fs/cgroup/job/task/cpu.stat", "usage_usec 5\nthrottled_usec 500000\n");
    const CpuSensors sensors(fake.places, {0, 1});
    while (std::clock() < CLOCKS_PER_SEC / 20) {  // its own time is counted in ticks
    }
    EXPECT_EQ(sensors.governor(), "performance, powersave");
    EXPECT_EQ(sensors.max_mhz(), 3900);
    const run::CpuReading reading = sensors.read();
    EXPECT_EQ(reading.mhz, 3100) << "a core that may not be used is no matter";
    EXPECT_EQ(reading.load_average, 1.5);
    EXPECT_EQ(reading.throttles, 16U) << "that of the package once";
    EXPECT_EQ(reading.held_s, 0.75);
    const double tick = 1.0 / double(sysconf(_SC_CLK_TCK));
    EXPECT_DOUBLE_EQ(*reading.busy_s, 2 * 133 * tick);
    EXPECT_DOUBLE_EQ(*reading.idle_s, 2 * 305 * tick);
    EXPECT_GT(reading.own_s, 0);
}

TEST(CpuSensors, garbage_and_missing_files_are_null) {
    FakeSensors fake;
    const CpuSensors sensors(fake.places, {0});
    const auto expect_nothing = [&] {
        const run::CpuReading reading = sensors.read();
        EXPECT_EQ(reading.mhz, std::nullopt);
        EXPECT_EQ(reading.load_average, std::nullopt);
        EXPECT_EQ(reading.throttles, std::nullopt);
        EXPECT_EQ(reading.held_s, std::nullopt);
        EXPECT_EQ(reading.busy_s, std::nullopt);
        EXPECT_EQ(reading.idle_s, std::nullopt);
        EXPECT_EQ(sensors.max_mhz(), std::nullopt);
    };
    expect_nothing();
    EXPECT_EQ(sensors.governor(), "");
    for (const char* file : {"sys/devices/system/cpu/cpu0/cpufreq/scaling_cur_freq",
                             "sys/devices/system/cpu/cpu0/cpufreq/cpuinfo_max_freq",
                             "sys/devices/system/cpu/cpu0/thermal_throttle/core_throttle_count",
                             "proc/loadavg", "proc/self/cgroup", "sys/fs/cgroup/cpu.stat"}) {
        fake.write(file, "<unknown>\n");
    }
    fake.write("proc/stat", "cpu0 one two\ncpu0\ncpux 1 2 3 4\n");
    expect_nothing();
}

TEST(HealthFigures, count_from_the_first_sample_to_the_closing_one) {
    std::vector<run::HealthSample> samples(2);
    samples[1].time = samples[0].time + 10s;
    samples[1].drawing = false;
    samples[1].gpu.mhz = 300;  // idle again: not of the replay
    samples[0].gpu.mhz = 1900;
    for (auto [sample, busy, idle, own, held] :
         {std::tuple{0, 100.0, 50.0, 20.0, 1.0}, std::tuple{1, 115.0, 55.0, 28.0, 1.5}}) {
        samples[std::size_t(sample)].cpu.busy_s = busy;
        samples[std::size_t(sample)].cpu.idle_s = idle;
        samples[std::size_t(sample)].cpu.own_s = own;
        samples[std::size_t(sample)].cpu.held_s = held;
    }
    const auto figures = run::health_figures(samples, {});
    ASSERT_TRUE(figures);
    EXPECT_EQ(figures->samples, 1);
    EXPECT_EQ(figures->seconds, 10);
    EXPECT_EQ(figures->gpu_mhz->min, 1900);
    EXPECT_EQ(figures->gpu_fall, 0.0);
    EXPECT_DOUBLE_EQ(*figures->others_cores, 0.7);
    EXPECT_DOUBLE_EQ(*figures->idle_cores, 0.5);
    EXPECT_DOUBLE_EQ(*figures->cgroup_held_s, 0.5);
    samples[1].time = samples[0].time + 100ms;
    EXPECT_EQ(run::health_figures(samples, {})->others_cores, std::nullopt) << "too short to tell";
    samples[1].cpu.held_s = 0.5;
    EXPECT_EQ(run::health_figures(samples, {})->cgroup_held_s, std::nullopt) << "was set back";
    samples.pop_back();
    EXPECT_EQ(run::health_figures(samples, {}), std::nullopt);
}

}  // namespace
}  // namespace lodbench::test
