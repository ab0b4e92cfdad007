#include "run/context.h"

#include "run/commit.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/utsname.h>

#include <fstream>
#include <string>

#include "api/abi_tag.h"
#include "report/results.h"

namespace lodbench::run {

namespace {

/// The rest of the first line that starts with `key`, after `separator`; "" when there is none.
std::string line_after(const char* file, std::string_view key, char separator) {
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        if (!line.starts_with(key)) continue;
        std::string value = line.substr(line.find(separator) + 1);
        std::erase(value, '"');
        const std::size_t begin = value.find_first_not_of(" \t");
        return begin == value.npos ? "" : value.substr(begin);
    }
    return {};
}

Json::Value text_or_null(const std::string& text) {
    return text.empty() ? Json::Value::null : Json::Value(text);
}

}  // namespace

Json::Value machine_context() {
    Json::Value json;
    json["schema_version"] = report::kSchemaVersion;
    json["tool_version"] = LODBENCH_VERSION;
    json["commit"] = text_or_null(LODBENCH_COMMIT);
    json["build_type"] = text_or_null(LODBENCH_BUILD_TYPE);
    json["compiler"] = LODBENCH_COMPILER;
    json["abi_tag"] = kAbiTag;
    utsname system{};
    uname(&system);
    json["os"] = text_or_null(line_after("/etc/os-release", "PRETTY_NAME=", '='));
    json["kernel"] = fmt::format("{} {} {}", system.sysname, system.release, system.machine);
    json["cpu"] = text_or_null(line_after("/proc/cpuinfo", "model name", ':'));
    cpu_set_t cores;
    CPU_ZERO(&cores);
    // The cores that this process may use, which a container may have cut down.
    json["cores"] = sched_getaffinity(0, sizeof cores, &cores) == 0 ? Json::Value(CPU_COUNT(&cores))
                                                                    : Json::Value::null;
    return json;
}

Json::Value gl_context(const CellResult& result) {
    Json::Value json;
    json["vendor"] = result.gl_vendor;
    json["renderer"] = result.gl_renderer;
    json["version"] = result.gl_version;
    json["device"] = text_or_null(result.device_description);
    json["software"] = result.software;
    json["timer_verdict"] = text_or_null(result.timer_verdict);
    return json;
}

}  // namespace lodbench::run
