#pragma once
// A terrain larger than memory, as what measures needs it.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "base/child_process.h"
#include "terrain/whole_terrain.h"

namespace lodbench::terrain {

/// All samples of another terrain in a scratch file, 4 bytes each, and mapped: the system holds
/// what is in use. Not for methods: mapped pages count as resident, and a disk that fails under
/// them raises a signal.
class MappedTerrain final : public WholeTerrain {
public:
    /// Bytes of samples that `forget` leaves resident, about: 1024 lines of 16385 samples twice.
    static constexpr std::int64_t kMostResident = std::int64_t{128} << 20;

    /// Copies the samples into a file without a name in `folder`, in parallel. Throws DiskFullError
    /// where there is no room, EnvironmentError where the disk refuses otherwise, TerrainError
    /// where a tile cannot be read or the grid is not that of the checksum.
    MappedTerrain(std::shared_ptr<const Terrain> terrain, const std::filesystem::path& folder,
                  std::int64_t most_resident = kMostResident);
    ~MappedTerrain() override;

    [[nodiscard]] std::span<const float> samples() const override;
    void forget() const override;
    [[nodiscard]] std::uint64_t bytes_read() const override { return terrain_->bytes_read(); }

private:
    void copy_samples(const SampleRect& rect, std::span<float> heights) const override;
    void copy_tile(const TileId& tile, std::span<float> heights) const override;
    [[nodiscard]] TileSummary find_summary(const TileId& tile) const override;
    [[nodiscard]] std::size_t bytes() const;

    std::shared_ptr<const Terrain> terrain_;
    std::int64_t most_resident_;
    base::FileDescriptor statm_;               ///< what this process holds
    void* pages_ = nullptr;                    ///< of the scratch file
    mutable std::atomic<std::int64_t> other_;  ///< bytes of other files that are resident
};

}  // namespace lodbench::terrain
