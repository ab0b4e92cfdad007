// The sensors of the GPU that draws: what they say, what is null, and never those of another.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "run/gpu_sensors.h"
#include "support/fake_sensors.h"

namespace lodbench::test {
namespace {

using platform::GpuIdentity;
using run::find_gpu_sensors;
using run::FoundGpu;
using run::GpuReading;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kUuid = "11111111-2222-3333-4444-555555555555";  // of the fake's first

GpuIdentity nvidia(const std::string& node, const std::string& uuid) {
    return {node, uuid, "NVIDIA Corporation", false};
}

void expect_nothing(const GpuReading& reading) {
    EXPECT_EQ(reading.mhz, std::nullopt);
    EXPECT_EQ(reading.c, std::nullopt);
    EXPECT_EQ(reading.w, std::nullopt);
    EXPECT_EQ(reading.throttle, std::nullopt);
}

TEST(Nvml, says_clock_temperature_power_and_why_it_throttles) {
    FakeSensors fake;
    fake.places.nvml = fake_nvml();
    nvml_answers("clock=1980 max_clock=2100 temperature=61 threshold=90 power=350500 reasons=0x44");
    const FoundGpu gpu = find_gpu_sensors(nvidia("", kUuid), fake.places);
    ASSERT_NE(gpu.sensors, nullptr) << gpu.why_none;
    EXPECT_EQ(gpu.sensors->facts().name, "Fake GPU 1");
    EXPECT_EQ(gpu.sensors->facts().source, "NVML 580.82");
    EXPECT_EQ(gpu.sensors->facts().max_mhz, 2100);
    EXPECT_EQ(gpu.sensors->facts().limit_c, 90);
    const GpuReading reading = gpu.sensors->read();
    EXPECT_EQ(reading.mhz, 1980);
    EXPECT_EQ(reading.c, 61);
    EXPECT_EQ(reading.w, 350.5);
    ASSERT_TRUE(reading.throttle);
    EXPECT_THAT(*reading.throttle, ElementsAre("sw_power_cap", "hw_thermal_slowdown"));
}

TEST(Nvml, idle_and_clocks_that_somebody_set_are_no_throttling) {
    FakeSensors fake;
    fake.places.nvml = fake_nvml();
    nvml_answers("reasons=0x103");
    const GpuReading reading = find_gpu_sensors(nvidia("", kUuid), fake.places).sensors->read();
    ASSERT_TRUE(reading.throttle);
    EXPECT_THAT(*reading.throttle, IsEmpty());
}

TEST(Nvml, sensors_that_fail_or_say_0_are_null) {
    FakeSensors fake;
    fake.places.nvml = fake_nvml();
    nvml_answers("");
    FoundGpu gpu = find_gpu_sensors(nvidia("", kUuid), fake.places);
    ASSERT_NE(gpu.sensors, nullptr);
    expect_nothing(gpu.sensors->read());
    EXPECT_EQ(gpu.sensors->facts().max_mhz, std::nullopt);
    EXPECT_EQ(gpu.sensors->facts().limit_c, std::nullopt);
    nvml_answers("clock=0 power=0");
    expect_nothing(gpu.sensors->read());
}

TEST(Nvml, functions_that_an_older_library_lacks_are_null_or_have_their_older_name) {
    FakeSensors fake;
    fake.places.nvml = fake_nvml("_old");
    nvml_answers("clock=1500 power=100 reasons=0x20");
    const FoundGpu gpu = find_gpu_sensors(nvidia("", kUuid), fake.places);
    ASSERT_NE(gpu.sensors, nullptr) << gpu.why_none;
    EXPECT_EQ(gpu.sensors->facts().source, "NVML");
    const GpuReading reading = gpu.sensors->read();
    EXPECT_EQ(reading.mhz, 1500);
    EXPECT_EQ(reading.w, std::nullopt);
    ASSERT_TRUE(reading.throttle);
    EXPECT_THAT(*reading.throttle, ElementsAre("sw_thermal_slowdown"));
}

TEST(Nvml, that_refuses_or_is_not_there_says_so) {
    FakeSensors fake;
    EXPECT_THAT(find_gpu_sensors(nvidia("", kUuid), fake.places).why_none,
                HasSubstr("NVML does not load: "));
    fake.places.nvml = fake_nvml();
    nvml_answers("init=9");
    const FoundGpu gpu = find_gpu_sensors(nvidia("", kUuid), fake.places);
    EXPECT_EQ(gpu.sensors, nullptr);
    EXPECT_EQ(gpu.why_none, "NVML refuses: Driver Not Loaded (error 9)");
    fake.places.nvml = "libm.so.6";
    EXPECT_THAT(find_gpu_sensors(nvidia("", kUuid), fake.places).why_none,
                HasSubstr("libm.so.6 has no nvmlInit"));
}

TEST(Nvml, is_asked_for_the_gpu_that_draws_and_for_no_other) {
    FakeSensors fake;
    fake.places.nvml = fake_nvml();
    nvml_answers("count=2 temperature=50");
    fake.add_card("card0", "0000:01:00.0", "nvidia");
    fake.add_card("card1", "0000:02:00.0", "nvidia");
    fake.add_card("card2", "0000:07:00.0", "nvidia");
    EXPECT_EQ(find_gpu_sensors(nvidia("card0", ""), fake.places).sensors->read().c, 50);
    EXPECT_EQ(find_gpu_sensors(nvidia("card1", ""), fake.places).sensors->read().c, 99);
    EXPECT_EQ(find_gpu_sensors(nvidia("card1", ""), fake.places).sensors->facts().pci,
              "0000:02:00.0");
    const std::string second = "2" + kUuid.substr(1);
    EXPECT_EQ(find_gpu_sensors(nvidia("", second), fake.places).sensors->read().c, 99);
    const FoundGpu untold = find_gpu_sensors(nvidia("", ""), fake.places);
    EXPECT_EQ(untold.sensors, nullptr);
    EXPECT_EQ(untold.why_none,
              "NVML knows 2 GPUs, and OpenGL's driver does not say which of them it draws on");
    nvml_answers("count=1 temperature=50");
    EXPECT_EQ(find_gpu_sensors(nvidia("", ""), fake.places).sensors->read().c, 50);
    const FoundGpu other = find_gpu_sensors(nvidia("card2", ""), fake.places);
    EXPECT_EQ(other.sensors, nullptr) << "the only one that NVML knows is another";
    EXPECT_EQ(other.why_none, "NVML knows 1 GPUs, and none by 0000:07:00.0");
}

TEST(GpuSensors, of_software_and_of_what_nobody_knows_are_none) {
    FakeSensors fake;
    fake.add_card("card0", "0000:01:00.0", "virtio-pci");
    EXPECT_EQ(find_gpu_sensors({"", "", "Mesa", true}, fake.places).why_none, "drawn in software");
    EXPECT_EQ(find_gpu_sensors({"", "", "Mesa", false}, fake.places).why_none,
              "OpenGL's driver (Mesa) does not say which GPU it draws on");
    EXPECT_EQ(find_gpu_sensors({"card9", "", "Mesa", false}, fake.places).why_none,
              "OpenGL's driver (Mesa) does not say which GPU it draws on");
    EXPECT_EQ(find_gpu_sensors({"card0", "", "Mesa", false}, fake.places).why_none,
              "driver virtio-pci of 0000:01:00.0 has no sensors that are known here");
}

/// gpu_metrics_v1_3 with this status.
std::string amd_metrics(std::uint64_t status) {
    std::string table(120, '\0');
    table[0] = 120;
    table[2] = 1;
    table[3] = 3;
    std::memcpy(table.data() + 112, &status, sizeof status);
    return table;
}

TEST(AmdSensors, are_those_of_its_monitor) {
    FakeSensors fake;
    const fs::path device = fake.add_card("card1", "0000:03:00.0", "amdgpu");
    fake.add_card("card0", "0000:02:00.0", "amdgpu");
    fake.write(device / "hwmon/hwmon5/freq1_input", "2105000000\n");
    fake.write(device / "hwmon/hwmon5/temp1_input", "61500\n");
    fake.write(device / "hwmon/hwmon5/temp1_crit", "100000\n");
    fake.write(device / "hwmon/hwmon5/power1_average", "210000000\n");
    fake.write(device / "pp_dpm_sclk", "0: 500Mhz\n1: 2105Mhz *\n2: 2545Mhz\n");
    fake.write(device / "gpu_metrics", amd_metrics(0));
    const FoundGpu gpu = find_gpu_sensors({"card1", "", "AMD", false}, fake.places);
    ASSERT_NE(gpu.sensors, nullptr) << gpu.why_none;
    EXPECT_EQ(gpu.sensors->facts().name, "amdgpu 0x1002:0x744c");
    EXPECT_EQ(gpu.sensors->facts().pci, "0000:03:00.0");
    EXPECT_EQ(gpu.sensors->facts().max_mhz, 2545);
    EXPECT_EQ(gpu.sensors->facts().limit_c, 100);
    GpuReading reading = gpu.sensors->read();
    EXPECT_EQ(reading.mhz, 2105);
    EXPECT_EQ(reading.c, 61.5);
    EXPECT_EQ(reading.w, 210);
    ASSERT_TRUE(reading.throttle);
    EXPECT_THAT(*reading.throttle, IsEmpty());
    fake.write(device / "gpu_metrics", amd_metrics(1ULL << 36 | 1));  // hot spot, PPT0
    EXPECT_THAT(*gpu.sensors->read().throttle, ElementsAre("power", "temperature"));
    expect_nothing(find_gpu_sensors({"card0", "", "AMD", false}, fake.places).sensors->read());
}

TEST(AmdSensors, clock_is_that_of_the_level_in_use_where_the_monitor_has_none) {
    FakeSensors fake;
    const fs::path device = fake.add_card("card0", "0000:03:00.0", "amdgpu");
    fake.write(device / "pp_dpm_sclk", "0: 300Mhz\n1: 1000Mhz *\n2: garbage\n3: -5Mhz *\n");
    const FoundGpu gpu = find_gpu_sensors({"card0", "", "AMD", false}, fake.places);
    EXPECT_EQ(gpu.sensors->read().mhz, 1000);
    EXPECT_EQ(gpu.sensors->facts().max_mhz, 1000);
}

TEST(AmdSensors, garbage_in_a_file_is_null) {
    FakeSensors fake;
    const fs::path device = fake.add_card("card0", "0000:03:00.0", "amdgpu");
    for (const char* garbage : {"", "\n", "hot", "12 13", "-5000", "nan", "inf", "1e300", "0x10"}) {
        fake.write(device / "hwmon/hwmon0/freq1_input", garbage);
        fake.write(device / "hwmon/hwmon0/temp1_input", garbage);
        fake.write(device / "hwmon/hwmon0/power1_average", garbage);
        fake.write(device / "pp_dpm_sclk", garbage);
        fake.write(device / "gpu_metrics", garbage);
        SCOPED_TRACE(garbage);
        expect_nothing(find_gpu_sensors({"card0", "", "AMD", false}, fake.places).sensors->read());
    }
    std::string other = amd_metrics(1);
    other[3] = 4;
    fake.write(device / "gpu_metrics", other);
    EXPECT_EQ(find_gpu_sensors({"card0", "", "AMD", false}, fake.places).sensors->read().throttle,
              std::nullopt)
        << "a table of another layout";
}

TEST(IntelSensors, of_i915_and_of_xe_are_the_clock_that_it_runs_at_and_why_it_throttles) {
    FakeSensors fake;
    const fs::path old = fake.add_card("card0", "0000:00:02.0", "i915") / "drm/card0";
    fake.write(old / "gt_act_freq_mhz", "1150\n");
    fake.write(old / "gt_cur_freq_mhz", "1300\n");
    const FoundGpu i915 = find_gpu_sensors({"card0", "", "Intel", false}, fake.places);
    EXPECT_EQ(i915.sensors->read().mhz, 1150);
    EXPECT_EQ(i915.sensors->read().throttle, std::nullopt) << "no file says it";
    fake.write(old / "gt_act_freq_mhz", "0\n");
    EXPECT_EQ(i915.sensors->read().mhz, std::nullopt) << "it sleeps: no clock, and not 0";
    fake.write(old / "gt/gt0/rps_act_freq_mhz", "900\n");
    fake.write(old / "gt/gt0/throttle_reason_status", "1\n");
    fake.write(old / "gt/gt0/throttle_reason_thermal", "1\n");
    fake.write(old / "gt/gt0/throttle_reason_pl1", "0\n");
    EXPECT_EQ(i915.sensors->read().mhz, 900);
    EXPECT_THAT(*i915.sensors->read().throttle, ElementsAre("thermal"));

    const fs::path gt = fake.add_card("card1", "0000:03:00.0", "xe") / "tile0/gt0/freq0";
    fake.write(gt / "act_freq", "2000\n");
    fake.write(gt / "rp0_freq", "2400\n");
    fake.write(gt / "throttle/reason_pl1", "1\n");
    fake.write(gt / "throttle/reason_pl2", "what\n");
    const FoundGpu xe = find_gpu_sensors({"card1", "", "Intel", false}, fake.places);
    EXPECT_EQ(xe.sensors->facts().max_mhz, 2400);
    EXPECT_EQ(xe.sensors->read().mhz, 2000);
    EXPECT_THAT(*xe.sensors->read().throttle, ElementsAre("pl1"));
    fake.add_card("renderD130", "0000:05:00.0", "xe");
    expect_nothing(
        find_gpu_sensors({"renderD130", "", "Intel", false}, fake.places).sensors->read());
}

}  // namespace
}  // namespace lodbench::test
