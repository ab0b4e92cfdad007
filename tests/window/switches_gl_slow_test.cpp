// A thousand switches of the method: nothing stays behind, and nothing goes wrong.

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "window/session_flight.h"

namespace lodbench::test {
namespace {

/// Of a process, bytes.
std::uint64_t resident_bytes(pid_t process) {
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmRSS:")) return std::stoull(line.substr(6)) * 1024;
    }
    return 0;
}

TEST(Switches, a_thousand_leave_no_object_raise_no_error_and_keep_the_memory) {
    SessionFlight flight;
    const PictureRequest request = request_of(camera_of_frame(flight.file(), 0));
    constexpr const char* kMethods[] = {"lindstrom", "clipmap", "full-grid", "hybrid-patches"};
    constexpr int kSwitches = 1000, kWarm = 200;
    pid_t process = 0;
    std::uint64_t warm = 0;
    for (int i = 0; i < kSwitches; ++i) {
        const char* const method = kMethods[i % 4];
        // A GL error, a warning of the driver as one, or a method that leaves state changed fails.
        const Json::Value opened = flight.open(flight.own(method));
        ASSERT_FALSE(opened.isMember("refused") || opened.isMember("failed")) << i << opened;
        ASSERT_EQ(opened["leaks"].asString(), "") << i << " before " << method;
        ASSERT_GT(flight.picture(request).triangles, 0U) << i << " " << method;
        if (i == 0) process = flight.session().process();
        ASSERT_EQ(flight.session().process(), process) << i;
        if (i == kWarm) warm = resident_bytes(process);
    }
    EXPECT_EQ(flight.session().fallen(), "");
    const std::uint64_t end = resident_bytes(process);
    RecordProperty("warm_bytes", std::to_string(warm));
    RecordProperty("end_bytes", std::to_string(end));
    std::printf("resident after %d switches %.1f MiB, after %d %.1f MiB\n", kWarm,
                double(warm) / 1048576, kSwitches, double(end) / 1048576);
    ASSERT_GT(warm, 0U);
    // What a leak of one context or one method a switch would be many times over.
    EXPECT_LT(double(end), 1.25 * double(warm));
}

}  // namespace
}  // namespace lodbench::test
