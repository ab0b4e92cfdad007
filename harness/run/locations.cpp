#include "run/locations.h"

#include <fmt/format.h>

#include "api/error.h"

namespace lodbench::run {

namespace fs = std::filesystem;

namespace {

fs::path prefix_of(const fs::path& program) {
    return program.parent_path().parent_path();
}

/// Whether it was built there: a prefix below the build folder is an installation like any other.
bool in_build_tree(const fs::path& program) {
    std::error_code ignored;
    const fs::path build = fs::canonical(LODBENCH_BUILD_DIR, ignored);
    if (build.empty() || prefix_of(program) != build) return false;
    const fs::path folder = program.parent_path().filename();
    return folder == "bin" || folder == "tests" || folder == "benchmarks";
}

}  // namespace

fs::path executable_path() {
    std::error_code error;
    fs::path path = fs::read_symlink("/proc/self/exe", error);
    if (error) {
        throw EnvironmentError(
            fmt::format("cannot read /proc/self/exe: {}; is /proc mounted?", error.message()));
    }
    return path;
}

fs::path default_plugin_folder() {
    const fs::path program = executable_path();
    if (in_build_tree(program)) return fs::path(LODBENCH_BUILD_DIR) / "plugins";
    return prefix_of(program) / LODBENCH_PLUGIN_SUBDIR;
}

fs::path scenario_folder() {
    const fs::path program = executable_path();
    if (in_build_tree(program)) return fs::path(LODBENCH_SOURCE_DIR) / "scenarios";
    return prefix_of(program) / LODBENCH_DATA_SUBDIR / "scenarios";
}

fs::path demo_scenario() {
    fs::path file = scenario_folder() / "demo.toml";
    if (!fs::exists(file)) {
        throw EnvironmentError(fmt::format(
            "the demo scenario {} is missing; install lodbench whole or name a scenario",
            file.string()));
    }
    return file;
}

}  // namespace lodbench::run
