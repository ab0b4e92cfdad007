#include "base/debugger.h"

#include <sys/prctl.h>

#include <chrono>
#include <fstream>
#include <string>
#include <string_view>
#include <thread>

#include "api/error.h"

namespace lodbench::base {

namespace {

bool is_traced() {
    constexpr std::string_view kKey = "TracerPid:";
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with(kKey)) return std::stol(line.substr(kKey.size())) != 0;
    }
    throw EnvironmentError("/proc/self/status has no TracerPid; is /proc mounted?");
}

}  // namespace

void await_debugger() {
    // Some systems (Yama's ptrace_scope 1) let only a parent attach. A debugger is none.
    prctl(PR_SET_PTRACER, PR_SET_PTRACER_ANY);
    while (!is_traced()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

}  // namespace lodbench::base
