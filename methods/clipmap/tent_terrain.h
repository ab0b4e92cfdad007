#pragma once
// A terrain of which the coarser levels are filtered instead of decimated.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "api/terrain.h"

namespace lodbench::clipmap {

/// Row by row, row 0 in the north.
struct HeightGrid {
    int columns = 0, rows = 0;
    std::vector<float> heights;

    [[nodiscard]] std::span<const float> row(int index) const {
        return std::span(heights).subspan(std::size_t(index) * std::size_t(columns),
                                          std::size_t(columns));
    }
    /// Where (x, y) lies beyond the grid the nearest sample.
    [[nodiscard]] float nearest(int x, int y) const;
};

/// Index of the last sample along an edge of `samples` at a level: the first one that is not before
/// the edge's end. Where 2^level does not divide the edge it stands beyond it and has the height of
/// what lies nearest.
[[nodiscard]] constexpr int last_sample(int samples, int level) {
    return int((std::int64_t(samples) - 2 + (std::int64_t(1) << level)) >> level);
}

/// The next coarser level: of every second row and column the mean of 3 x 3 samples with weights
/// [1 2 1]^2 / 16, or that sample itself. Beyond the grid its edge goes on.
[[nodiscard]] HeightGrid coarser_by_tent(const HeightGrid& fine);
[[nodiscard]] HeightGrid coarser_by_decimation(const HeightGrid& fine);

/// Serves tiles of level 0 as the terrain does, and those of all coarser levels from a pyramid by
/// `coarser_by_tent`, which is built in one pass over the rows: kept in memory up to 64 MiB, else
/// in a file without a name, of a third of the terrain's size, in the folder for temporary files.
/// The terrain outlives it. As with any terrain, tiles may be read from several threads at once.
class TentTerrain final : public Terrain {
public:
    /// Throws what reading throws, and EnvironmentError where the file cannot be made or has no
    /// room.
    explicit TentTerrain(const Terrain& terrain, std::size_t most_bytes_in_memory = 64U << 20U);
    ~TentTerrain() override;

    [[nodiscard]] std::uint64_t bytes_read() const override { return terrain_.bytes_read(); }
    /// Of the pyramid.
    [[nodiscard]] std::size_t bytes() const;

private:
    class Storage;
    class Builder;
    void copy_samples(const SampleRect& rect, std::span<float> heights) const override;
    void copy_tile(const TileId& tile, std::span<float> heights) const override;
    [[nodiscard]] TileSummary find_summary(const TileId& tile) const override;

    const Terrain& terrain_;
    TilePyramid pyramid_;
    std::unique_ptr<Storage> storage_;
};

}  // namespace lodbench::clipmap
