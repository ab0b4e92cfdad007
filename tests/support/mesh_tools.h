#pragma once
// Running `lodbench mesh` and the independent check of what it wrote.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace lodbench::test {

struct Outcome {
    int status = -1;
    std::string output;  ///< both streams
};

inline Outcome run_command(const std::string& command) {
    Outcome outcome;
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    if (pipe == nullptr) return outcome;
    std::array<char, 4096> part{};
    while (const std::size_t count = fread(part.data(), 1, part.size(), pipe)) {
        outcome.output.append(part.data(), count);
    }
    const int status = pclose(pipe);
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return outcome;
}

/// The arguments as they come after "lodbench ".
inline Outcome lodbench(const std::string& arguments) {
    return run_command(std::string(LODBENCH_BINARY) + " " + arguments);
}

/// numpy is Debian's, so that the interpreter is too.
inline const char* kPython = "/usr/bin/python3 ";

inline bool has_numpy() {
    return run_command(std::string(kPython) + "-c 'import numpy'").status == 0;
}

inline Outcome check_mesh(const std::string& arguments) {
    return run_command(std::string(kPython) + LODBENCH_SOURCE_DIR "/tests/support/check_mesh.py " +
                       arguments);
}

inline std::string read_bytes(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

/// A folder of its own for each test, removed afterwards.
class MeshTest : public testing::Test {
protected:
    void SetUp() override {
        std::string pattern = testing::TempDir() + "lodbench-mesh-XXXXXX";
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    /// A flight of three frames over the terrain table's terrain; keyframes are lists of TOML as
    /// positions.
    std::string scenario(const std::string& terrain, const std::string& from, const std::string& to,
                         int pitch = -35, const std::string& more = "") {
        const auto path = folder_ / "scenario.toml";
        write_bytes(path, "[terrain]\n" + terrain +
                              "\n[viewport]\nwidth = 320\nheight = 240\n"
                              "[flight]\nkind = \"spline\"\nframes = 3\nwarmup_frames = 0\n"
                              "[[flight.keyframe]]\nposition = " +
                              from + "\nheading = 30\npitch = " + std::to_string(pitch) +
                              "\n[[flight.keyframe]]\nposition = " + to +
                              "\nheading = 40\npitch = " + std::to_string(pitch) + "\n" + more);
        return path.string();
    }
    [[nodiscard]] std::string file(const std::string& name) const {
        return (folder_ / name).string();
    }

    std::filesystem::path folder_;
};

}  // namespace lodbench::test
