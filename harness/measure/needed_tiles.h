#pragma once
// How much of a terrain a flight's views need: which tiles of its pyramid, whatever a method draws.
// What methods ask for, read and keep is compared with it.

#include <cstdint>
#include <functional>
#include <vector>

#include "api/camera.h"
#include "api/terrain.h"

namespace lodbench::measure {

/// What the views of a flight need at one greatest screen error.
struct TileNeed {
    double target_px = 0;
    std::uint64_t tiles = 0;            ///< of any of the frames, each counted once
    std::uint64_t most_in_a_frame = 0;  ///< tiles
    [[nodiscard]] std::uint64_t samples() const { return tiles * kTileSampleCount; }
};

/// Per frame the tiles in view at the coarsest level that keeps a target error, and their union
/// over the frames. Nothing but tiles' summaries is read.
///
/// A tile's heights lie within the sum, over the finer levels, of the greatest midpoint error of a
/// tile below it: the triangulations of the levels are nested. On screen that is at most lambda
/// times sum / depth times the greatest |(up_x - X up_z, up_y - Y up_z)| over the tangents (X, Y)
/// in view, up being the world's in the camera's frame and depth the least of the tile's box, or
/// the near plane's. So each tile keeps the target, by an upper bound; fewer may do.
class NeededTiles {
public:
    /// `targets_px`: positive and rising. The terrain must outlive it.
    NeededTiles(const Terrain& terrain, const std::vector<double>& targets_px);

    void add(const Camera& camera);
    /// Calls `visit` for each tile that a camera needs for the error `target_px`.
    void visit_needed(const Camera& camera, double target_px,
                      const std::function<void(const TileId&)>& visit) const;

    /// Of each target. Frames that need different levels make some unions larger than those of a
    /// finer target, which keep the coarser one too: then theirs is the need.
    [[nodiscard]] std::vector<TileNeed> needs() const;

private:
    struct Union {
        TileNeed need;
        std::vector<bool> holds;  ///< of each tile of the pyramid
    };
    const Terrain& terrain_;
    TilePyramid pyramid_;
    std::vector<float> lacking_;  ///< metres: bound of what a tile lacks of the full resolution
    std::vector<Union> unions_;   ///< of each target
};

}  // namespace lodbench::measure
