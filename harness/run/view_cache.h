#pragma once
// What a camera sees of the true terrain, kept from the first method that a campaign measures for
// all others. Its files are this program's own, and are believed only where their checksum says so.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "measure/reference_view.h"

namespace lodbench::run {

class ViewCache {
public:
    /// Files take no more than that together; views beyond it are found anew each time.
    static constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30U;

    /// Keeps nothing.
    ViewCache() = default;
    /// `scenario` begins the files' names. `terrain` and `device` say what a view depends on beside
    /// the camera: the checksum of the heights, and the driver.
    ViewCache(std::filesystem::path folder, std::string scenario, const std::string& terrain,
              const std::string& device);

    /// Whether what is kept is kept.
    [[nodiscard]] bool keeps() const { return !folder_.empty(); }
    /// What is kept of the scenario's frame; nothing where the file is damaged or of another
    /// camera.
    [[nodiscard]] std::optional<measure::ReferenceView> find(int frame, const Camera& camera) const;
    /// Does nothing where there is no room: none of what the results may need is taken.
    void keep(int frame, const Camera& camera, const measure::ReferenceView& view);

private:
    [[nodiscard]] std::filesystem::path file_of(int frame) const;
    [[nodiscard]] std::uint64_t key_of(const Camera& camera) const;

    std::filesystem::path folder_;
    std::string scenario_;
    std::uint64_t base_ = 0;              ///< hash of what all keys depend on
    std::optional<std::uint64_t> bytes_;  ///< of the folder's files, once they were counted
};

}  // namespace lodbench::run
