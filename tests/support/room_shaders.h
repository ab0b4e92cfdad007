#pragma once
// A method's shaders from its folder, for tests that look into a room without its plugin.

#include <filesystem>
#include <fstream>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "gl/program.h"

namespace lodbench::test {

class RoomShaders {
public:
    /// `room`: a folder of methods/.
    explicit RoomShaders(const std::string& room) {
        const std::set<std::string> kinds = {".glsl", ".vert", ".tesc", ".tese", ".frag", ".comp"};
        for (const auto& file : std::filesystem::directory_iterator(
                 std::filesystem::path(LODBENCH_SOURCE_DIR) / "methods" / room)) {
            if (!kinds.contains(file.path().extension().string())) continue;
            std::ostringstream text;
            text << std::ifstream(file.path()).rdbuf();
            files_.emplace_back(file.path().filename().string(), text.str());
        }
        for (const auto& [name, text] : files_) sources_.push_back({name.c_str(), text.c_str()});
    }
    RoomShaders(const RoomShaders&) = delete;
    RoomShaders& operator=(const RoomShaders&) = delete;
    [[nodiscard]] std::span<const gl::ShaderSource> get() const { return sources_; }

private:
    std::vector<std::pair<std::string, std::string>> files_;  ///< name, text
    std::vector<gl::ShaderSource> sources_;
};

}  // namespace lodbench::test
