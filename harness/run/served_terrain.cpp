#include "run/served_terrain.h"

namespace lodbench::run {

ServedTerrain::ServedTerrain(std::shared_ptr<const Terrain> terrain)
    : terrain_(std::move(terrain)) {
    info_ = terrain_->info();
}

void ServedTerrain::copy_samples(const SampleRect& rect, std::span<float> heights) const {
    terrain_->read(rect, heights);
    samples_served_ += heights.size();
}

void ServedTerrain::copy_tile(const TileId& tile, std::span<float> heights) const {
    terrain_->read_tile(tile, heights);
    samples_served_ += heights.size();
    ++tiles_served_;
}

TileSummary ServedTerrain::find_summary(const TileId& tile) const {
    return terrain_->tile_summary(tile);
}

}  // namespace lodbench::run
