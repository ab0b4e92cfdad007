#include "run/flight_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "measure/box_in_view.h"
#include "scenario/flight_path.h"
#include "terrain/void_fill.h"

namespace lodbench::run {

namespace {

constexpr double kSlack = 1e-9;  // of the distance, for the rounding of boxes in view
// Of a frame, tiles in view whose cells are looked at one by one before it is taken that one is
// seen.
constexpr int kMaxTilesRead = 256;

/// Of `cells` x `cells` cells from sample (row, column) on, cut off at the grid's end.
glm::dvec3 corner(const TerrainInfo& info, int row, int column, double height) {
    return {info.position(std::min(row, info.rows - 1), std::min(column, info.columns - 1)),
            height};
}

bool tile_in_view(const Terrain& terrain, const TileId& tile, const measure::BoxInView& in_view) {
    const TileSummary summary = terrain.tile_summary(tile);
    const int cells = kTileCells << tile.level;
    const int north = tile.row * cells, west = tile.column * cells;
    return in_view(corner(terrain.info(), north + cells, west, double(summary.min_height)),
                   corner(terrain.info(), north, west + cells, double(summary.max_height)));
}

/// `samples`: of a tile of level 0.
bool cell_in_view(const TerrainInfo& info, const TileId& tile, const std::vector<float>& samples,
                  const measure::BoxInView& in_view) {
    const int north = tile.row * kTileCells, west = tile.column * kTileCells;
    const int rows = std::min(kTileCells, info.rows - 1 - north);
    const int columns = std::min(kTileCells, info.columns - 1 - west);
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const float* const first = &samples[std::size_t(row * kTileSamples + column)];
            const auto [low, high] =
                std::minmax({first[0], first[1], first[kTileSamples], first[kTileSamples + 1]});
            if (in_view(corner(info, north + row + 1, west + column, double(low)),
                        corner(info, north + row, west + column + 1, double(high)))) {
                return true;
            }
        }
    }
    return false;
}

}  // namespace

std::string FlightCheck::Frames::words(int frames) const {
    if (count == frames)
        return frames == 1 ? "its one frame" : fmt::format("all {} frames", frames);
    return fmt::format("{} of {} frames, the first of them frame {}", count, frames, first);
}

void FlightCheck::add(const Camera& camera) {
    if (!sees_terrain(camera)) blind_.add(frames_);
    const double below = depth_below_ground(camera.position);
    if (below > 0) below_.add(frames_);
    if (below > deepest_) {
        deepest_ = below;
        deepest_frame_ = frames_;
    }
    if (before_ && before_->position == camera.position &&
        before_->orientation == camera.orientation) {
        standing_.add(frames_);
    }
    before_ = camera;
    ++frames_;
}

double FlightCheck::depth_below_ground(const glm::dvec3& position) const {
    const TerrainInfo& info = terrain_.info();
    const glm::dvec2 low = info.extent_min(), high = info.extent_max();
    const bool over =
        position.x >= low.x && position.x <= high.x && position.y >= low.y && position.y <= high.y;
    if (!over || position.z >= double(info.max_height)) return 0;
    // The ground of a terrain on disk is read where the tile does not rule it out.
    const glm::dvec2 cells = (glm::dvec2(position) - low) / info.spacing;
    const int row = std::clamp(info.rows - 2 - int(cells.y), 0, info.rows - 2);
    const int column = std::clamp(int(cells.x), 0, info.columns - 2);
    const TileSummary tile = terrain_.tile_summary({0, row / kTileCells, column / kTileCells});
    if (position.z >= double(tile.max_height)) return 0;
    return scenario::ground_height(terrain_, glm::dvec2(position)) - position.z;
}

bool FlightCheck::sees_terrain(const Camera& camera) {
    const measure::BoxInView in_view(camera, kSlack);
    const TilePyramid pyramid = terrain_.tiles();
    int read = 0;
    const auto sees = [&](const auto& self, const TileId& tile) -> bool {
        if (!tile_in_view(terrain_, tile, in_view)) return false;
        if (tile.level == 0) {
            if (held_ != tile) {
                if (++read > kMaxTilesRead) return true;
                samples_.resize(kTileSampleCount);
                terrain_.read_tile(tile, samples_);
                held_ = tile;
            }
            if (!cell_in_view(terrain_.info(), tile, samples_, in_view)) return false;
            seen_ = tile;
            return true;
        }
        for (int i = 0; i < 4; ++i) {
            const TileId child{tile.level - 1, 2 * tile.row + i / 2, 2 * tile.column + i % 2};
            if (pyramid.contains(child) && self(self, child)) return true;
        }
        return false;
    };
    return sees(sees, seen_) || sees(sees, pyramid.root());
}

std::vector<std::string> FlightCheck::warnings(const std::string& name) const {
    std::vector<std::string> texts;
    const auto warn = [&](const std::string& text) {
        texts.push_back(fmt::format("the flight of '{}': {}", name, text));
    };
    const TerrainInfo& info = terrain_.info();
    if (blind_.count > 0) {
        warn(fmt::format(
            "no terrain is in view in {}, whatever a method draws: its {:g} x {:g} m lie "
            "{:g} to {:g} m high; move the cameras or turn them to it",
            blind_.words(frames_), info.spacing.x * (info.columns - 1),
            info.spacing.y * (info.rows - 1), double(info.min_height), double(info.max_height)));
    }
    if (below_.count > 0) {
        warn(
            fmt::format("the camera is below the ground in {}, by up to {:.4g} m in frame {}: it "
                        "sees the surface from below; fly higher, or above_ground = true",
                        below_.words(frames_), deepest_, deepest_frame_));
    }
    if (frames_ > 1 && standing_.count >= kLongStand * (frames_ - 1)) {
        warn(
            fmt::format("the camera stands still: {} of {} frames repeat the view of the frame "
                        "before, and show neither popping nor what moving on costs",
                        standing_.count, frames_));
    }
    if (std::string voids = terrain::warning_of_voids(info); !voids.empty()) {
        texts.push_back(std::move(voids));
    }
    return texts;
}

}  // namespace lodbench::run
