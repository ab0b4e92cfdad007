#pragma once
// What stands between a terrain and a method.

#include <atomic>
#include <cstdint>
#include <memory>

#include "api/terrain.h"

namespace lodbench::run {

/// Serves another terrain and counts what is asked of it, so that what the harness itself reads is
/// not counted.
class ServedTerrain final : public Terrain {
public:
    explicit ServedTerrain(std::shared_ptr<const Terrain> terrain);

    /// Samples that `read` and `read_tile` have delivered so far.
    [[nodiscard]] std::uint64_t samples_served() const { return samples_served_.load(); }
    /// Of them, tiles that `read_tile` has delivered.
    [[nodiscard]] std::uint64_t tiles_served() const { return tiles_served_.load(); }
    [[nodiscard]] std::uint64_t bytes_read() const override { return terrain_->bytes_read(); }

private:
    void copy_samples(const SampleRect& rect, std::span<float> heights) const override;
    void copy_tile(const TileId& tile, std::span<float> heights) const override;
    [[nodiscard]] TileSummary find_summary(const TileId& tile) const override;

    std::shared_ptr<const Terrain> terrain_;
    mutable std::atomic<std::uint64_t> samples_served_{0};
    mutable std::atomic<std::uint64_t> tiles_served_{0};
};

}  // namespace lodbench::run
