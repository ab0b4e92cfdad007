#pragma once
// Runs lodbench as a user does, on a small scenario.

#include <fcntl.h>
#include <json/writer.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "results/json.h"

namespace lodbench::test {

namespace fs = std::filesystem;

/// A folder that is empty at first and gone at the end.
class ScratchFolder {
public:
    ScratchFolder() {
        std::string pattern = (fs::temp_directory_path() / "lodbench-test-XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~ScratchFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    [[nodiscard]] const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

inline std::string text_of(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

inline std::string broken_plugin_folder(const std::string& name) {
    return std::string(LODBENCH_BUILD_DIR) + "/broken-plugins/" + name;
}

/// What this program starts finds the methods of tests/plugins/stand_ins.cpp without being told.
inline const int kStandInsAreFound =
    setenv("LODBENCH_PLUGIN_PATH", broken_plugin_folder("stand_ins").c_str(), 1);

/// Starts lodbench with its output in `log`; `prepare` runs in the child before it becomes
/// lodbench.
inline pid_t start_lodbench(const std::vector<std::string>& arguments, const fs::path& log,
                            const std::function<void()>& prepare = {}) {
    const pid_t child = fork();
    if (child != 0) return child;
    const int output = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(output, 1);
    dup2(output, 2);
    std::vector<char*> argv = {const_cast<char*>(LODBENCH_BINARY)};
    for (const std::string& argument : arguments)
        argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    if (prepare) prepare();
    execv(LODBENCH_BINARY, argv.data());
    _exit(127);
}

struct Finished {
    int status = -1;  ///< exit status; 1000 + the signal where one ended it
    std::string output;
};

inline Finished run_lodbench(const std::vector<std::string>& arguments, const fs::path& folder,
                             const std::function<void()>& prepare = {}) {
    const fs::path log = folder / "lodbench.log";
    const pid_t child = start_lodbench(arguments, log, prepare);
    int status = 0;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), text_of(log)};
}

/// A ramp of 17 x 17 samples, 2 frames of 32 x 24 pixels; `run` is more text for its table [run].
inline fs::path tiny_scenario(const fs::path& folder, const std::string& run) {
    const fs::path file = folder / "tiny.toml";
    std::ofstream(file) << R"(name = "tiny"
[terrain]
synthetic = "ramp"
rows = 17
columns = 17
spacing = 10
[viewport]
width = 32
height = 24
[flight]
kind = "line"
frames = 2
warmup_frames = 0
start = [20, 20, 300]
end = [100, 100, 300]
[measure]
shots = [0]
[run]
)" << run;
    return file;
}

/// The objects of cells.jsonl by their id; throws when a line is no JSON or is damaged.
inline std::vector<Json::Value> cells_of(const fs::path& out) {
    std::vector<Json::Value> cells;
    std::ifstream stream(out / "cells.jsonl");
    for (std::string line; std::getline(stream, line);) {
        cells.push_back(results::parse_sealed(line, "cells.jsonl"));
    }
    return cells;
}

}  // namespace lodbench::test
