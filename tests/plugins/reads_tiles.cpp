// Reads a tile a frame, and can meet with an accident to the terrain's file: what a broken disk, or
// somebody else's hand, does to a method that streams.

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "quiet_method.h"

namespace {

/// The store that this process has open under the highest number: the method's own.
std::string own_descriptor() {
    std::string found;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
        std::error_code gone;
        const auto target = std::filesystem::read_symlink(entry.path(), gone);
        if (target.extension() != ".tiles") continue;
        if (found.empty() || std::stoi(entry.path().filename()) > std::stoi(found)) {
            found = entry.path().filename();
        }
    }
    return found;
}

/// "truncate": the file is cut to its header; "read_error": it can no more be read.
void meet(const std::string& accident) {
    const std::string descriptor = own_descriptor();
    if (accident == "truncate") {
        std::filesystem::resize_file(std::filesystem::read_symlink("/proc/self/fd/" + descriptor),
                                     2048);
    }
    if (accident == "read_error") {
        const int folder = open("/", O_RDONLY);
        dup2(folder, std::stoi(descriptor));
        close(folder);
    }
}

class ReadsTiles final : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void prepare(const lodbench::Terrain& terrain, lodbench::gl::Device&) override {
        terrain_ = &terrain;
        read();
    }
    void select(const lodbench::Camera&, const lodbench::Clock& clock) override {
        const char* const accident = std::getenv("LODBENCH_TEST_ACCIDENT");
        if (accident != nullptr && clock.frame == 1) meet(accident);
        read();
    }

private:
    void read() { terrain_->read_tile({0, 0, 1}, heights_); }
    const lodbench::Terrain* terrain_ = nullptr;
    std::vector<float> heights_ = std::vector<float>(lodbench::kTileSampleCount);
};

}  // namespace

QUIET_PLUGIN(ReadsTiles, "reads-tiles");
