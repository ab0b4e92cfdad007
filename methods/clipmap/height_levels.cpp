#include "clipmap/height_levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/error.h"

namespace lodbench::clipmap {

namespace {

/// All that windows of every level cover, twice: what is used in a frame never has to make room for
/// what else is.
int pool_size(const HeightLevelsOptions& options) {
    const int along = (options.window_samples + 2 * kTileCells - 1) / kTileCells + 1;
    return 2 * along * along * options.levels + 16;
}

/// Tiles that are read and not yet taken: of large windows many, or the frames would be what the
/// disk waits for; 17 KB each.
std::size_t most_ready(const HeightLevelsOptions& options) {
    return std::size_t(std::max(64, pool_size(options) / 4));
}

/// The finest level that is small enough to be held.
int first_held_level(const Terrain& terrain, const HeightLevelsOptions& options) {
    const int most = std::max(options.resident_samples, kTileSamples);
    const int longest = std::max(terrain.info().rows, terrain.info().columns);
    int level = 0;
    while (last_sample(longest, level) + 1 > most) ++level;
    return level;
}

}  // namespace

HeightLevels::HeightLevels(const Terrain& terrain, const HeightLevelsOptions& options)
    : terrain_(terrain),
      options_(options),
      pyramid_(terrain.tiles()),
      first_held_(std::min(first_held_level(terrain, options), options.levels - 1)),
      pool_(pool_size(options)),
      slots_(std::size_t(pool_size(options))),
      loader_(terrain, options.loader_threads, most_ready(options)) {
    hold_coarse_levels();
}

void HeightLevels::hold_coarse_levels() {
    const glm::ivec2 last = last_sample_of(first_held_);
    HeightGrid finest{last.x + 1, last.y + 1, {}};
    finest.heights.resize(std::size_t(finest.columns) * std::size_t(finest.rows));
    std::vector<float> tile(kTileSampleCount);
    for (int row = 0; row < pyramid_.rows(first_held_); ++row) {
        for (int column = 0; column < pyramid_.columns(first_held_); ++column) {
            terrain_.read_tile({first_held_, row, column}, tile);
            const int width = std::min(kTileSamples, finest.columns - column * kTileCells);
            for (int y = 0; y < std::min(kTileSamples, finest.rows - row * kTileCells); ++y) {
                std::copy_n(tile.begin() + std::ptrdiff_t(y) * kTileSamples, width,
                            finest.heights.begin() +
                                std::ptrdiff_t(row * kTileCells + y) * finest.columns +
                                std::ptrdiff_t(column) * kTileCells);
            }
        }
    }
    held_.push_back(std::move(finest));
    while (first_held_ + int(held_.size()) < options_.levels) {
        held_.push_back(options_.filtered ? coarser_by_tent(held_.back())
                                          : coarser_by_decimation(held_.back()));
    }
}

void HeightLevels::begin_frame() {
    ++frame_;
    missing_.clear();
    known_missing_.clear();
    for (common::LoadedTile& loaded : loader_.take(most_ready(options_))) store(std::move(loaded));
}

void HeightLevels::request_missing() {
    loader_.request(missing_);
}

void HeightLevels::wait_for_tiles() {
    waits_ = true;
    loader_.clear();
}

bool HeightLevels::store(common::LoadedTile&& loaded) {
    const std::size_t index = pyramid_.index(loaded.tile);
    ++tiles_read_;
    if (pool_.find(index)) return true;
    const std::optional<int> slot = pool_.place(index, frame_);
    if (!slot) return false;
    slots_[std::size_t(*slot)] = std::move(loaded.heights);
    return true;
}

const std::vector<float>* HeightLevels::find(const TileId& tile) {
    const std::optional<int> slot = pool_.find(pyramid_.index(tile));
    if (!slot) return nullptr;
    pool_.touch(*slot, frame_);
    return &slots_[std::size_t(*slot)];
}

bool HeightLevels::require_tile(const TileId& tile) {
    if (find(tile) != nullptr) return true;
    if (waits_) {
        common::LoadedTile loaded{tile, std::vector<float>(kTileSampleCount)};
        terrain_.read_tile(tile, loaded.heights);
        if (store(std::move(loaded))) return true;
        throw ContractError("HeightLevels: a frame needs more tiles than its windows cover");
    }
    if (known_missing_.insert(pyramid_.index(tile)).second) missing_.push_back(tile);
    return false;
}

glm::ivec2 HeightLevels::last_sample_of(int level) const {
    return {last_sample(terrain_.info().columns, level), last_sample(terrain_.info().rows, level)};
}

TileId HeightLevels::tile_at(int level, glm::ivec2 sample) const {
    return {level, std::min(sample.y / kTileCells, pyramid_.rows(level) - 1),
            std::min(sample.x / kTileCells, pyramid_.columns(level) - 1)};
}

template <typename Visit>
void HeightLevels::for_each_tile(int level, const common::LevelRect& samples, const Visit& visit) {
    if (samples.empty() || level >= first_held_) return;
    const glm::ivec2 last = last_sample_of(level);
    const TileId first_tile = tile_at(level, glm::clamp(samples.low, glm::ivec2(0), last));
    const TileId last_tile = tile_at(level, glm::clamp(samples.high - 1, glm::ivec2(0), last));
    for (int row = first_tile.row; row <= last_tile.row; ++row) {
        for (int column = first_tile.column; column <= last_tile.column; ++column) {
            visit(TileId{level, row, column});
        }
    }
}

bool HeightLevels::require(int level, const common::LevelRect& samples) {
    bool all = true;
    for_each_tile(level, samples, [&](const TileId& tile) { all = require_tile(tile) && all; });
    return all;
}

bool HeightLevels::there(int level, const common::LevelRect& samples) {
    bool all = true;
    for_each_tile(level, samples, [&](const TileId& tile) { all = all && find(tile) != nullptr; });
    return all;
}

std::span<const float> HeightLevels::from(int level, glm::ivec2 sample) {
    if (level >= first_held_) {
        return held_[std::size_t(level - first_held_)].row(sample.y).subspan(std::size_t(sample.x));
    }
    const TileId tile = tile_at(level, sample);
    const std::vector<float>* heights = find(tile);
    if (heights == nullptr) {
        throw ContractError(fmt::format(
            "HeightLevels: tile (level {}, row {}, column {}) is copied but not in memory",
            tile.level, tile.row, tile.column));
    }
    const glm::ivec2 within = sample - kTileCells * glm::ivec2(tile.column, tile.row);
    return std::span(*heights).subspan(std::size_t(within.y) * kTileSamples + std::size_t(within.x),
                                       std::size_t(kTileSamples - within.x));
}

void HeightLevels::copy(int level, const common::LevelRect& samples, std::vector<float>& heights) {
    heights.clear();
    heights.reserve(std::size_t(samples.area()));
    const glm::ivec2 last = last_sample_of(level);
    for (int row = samples.low.y; row < samples.high.y; ++row) {
        for (int column = samples.low.x; column < samples.high.x;) {
            const glm::ivec2 sample = glm::clamp({column, row}, glm::ivec2(0), last);
            const std::span<const float> run = from(level, sample);
            const int next = sample.x < column   ? samples.high.x
                             : sample.x > column ? 0
                                                 : last.x + 1;
            const int wanted = std::min(next, samples.high.x) - column;
            if (sample.x == column) {
                const int count = std::min(wanted, int(run.size()));
                heights.insert(heights.end(), run.begin(), run.begin() + count);
                column += count;
            } else {
                heights.insert(heights.end(), std::size_t(wanted), run.front());
                column += wanted;
            }
        }
    }
}

double HeightLevels::ground_height(const glm::dvec2& place) {
    for (int level = 0;; ++level) {
        const glm::dvec2 sample = place / double(std::int64_t(1) << level);
        const glm::ivec2 corner =
            glm::clamp(glm::ivec2(sample), glm::ivec2(0), last_sample_of(level) - 1);
        const common::LevelRect cell{corner, corner + 2};
        // A coarser tile stands in; that alone is no reason to read it.
        if (level == 0 ? !require(level, cell) : !there(level, cell)) continue;
        std::vector<float> z;
        copy(level, cell, z);
        const glm::dvec2 t = sample - glm::dvec2(corner);
        return std::lerp(std::lerp(double(z[0]), double(z[1]), t.x),
                         std::lerp(double(z[2]), double(z[3]), t.x), t.y);
    }
}

}  // namespace lodbench::clipmap
