#include "persistent_grid/clip_windows.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace lodbench::persistent_grid {
namespace {

using common::LevelRect;
using common::ToroidalWindow;
using common::WindowPiece;

double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

}  // namespace

ClipWindows::ClipWindows(const MeanPyramid& pyramid, const ClipOptions& options)
    : pyramid_(pyramid),
      tiles_(pyramid.tiles()),
      options_(options),
      shelf_(pyramid, options.loader_threads) {
    const int levels = pyramid.level_count();
    texture_size_ = texture_size(levels, options.texels);
    const int columns = texture_size_.x / options.texels;
    for (int level = 0; level < levels; ++level) {
        windows_.emplace_back(options.texels,
                              options.texels * glm::ivec2(level % columns, level / columns));
    }
    wanted_.resize(windows_.size());
}

glm::ivec2 ClipWindows::corner(int level) const {
    return windows_[std::size_t(level)].texel(glm::ivec2(0));
}

bool ClipWindows::holds_all(int level) const {
    const glm::ivec2 size = level_size(pyramid_.info(), level);
    return std::max(size.x, size.y) <= options_.texels;
}

void ClipWindows::move_to(const glm::dvec2& place) {
    for (int level = 0; level < level_count(); ++level) {
        // The texels beside the viewpoint are the two in the middle. See Level for where they
        // stand.
        const glm::dvec2 texel = (place + 0.5) / std::exp2(level) - 0.5;
        const glm::dvec2 most = glm::max(level_size(pyramid_.info(), level) - options_.texels, 0);
        const glm::dvec2 origin = glm::floor(texel) + 1.0 - options_.texels / 2.0;
        windows_[std::size_t(level)].move_to(glm::ivec2(glm::clamp(origin, glm::dvec2(0), most)));
    }
}

ClipWindows::TileRange ClipWindows::tiles_under(int level, const LevelRect& texels) const {
    const glm::ivec2 end = level_size(pyramid_.info(), level) - 1;
    const glm::ivec2 last_tile(tiles_.columns(level) - 1, tiles_.rows(level) - 1);
    const glm::ivec2 low = glm::clamp(texels.low, glm::ivec2(0), end);
    const glm::ivec2 high = glm::clamp(texels.high - 1, glm::ivec2(0), end);
    return {glm::min(low / kTileCells, last_tile), glm::min(high / kTileCells, last_tile)};
}

void ClipWindows::want(bool whole_levels) {
    std::vector<TileRange> under(windows_.size());
    for (int level = 0; level < tiles_.levels(); ++level) {
        // A whole level is written once, and never again but by entire updates.
        if (holds_all(level) && !whole_levels && !options_.entire) continue;
        if (!holds_all(level) && whole_levels) continue;
        under[std::size_t(level)] = tiles_under(level, target(level));
    }
    if (under == wanted_) return;
    wanted_ = under;
    std::vector<TileId> wishes;
    for (const int ring : {0, 1}) {
        for (int level = tiles_.levels() - 1; level >= 0; --level) {
            const TileRange& range = under[std::size_t(level)];
            if (range.last.x < 0) continue;
            const glm::ivec2 first = glm::max(range.first - ring, 0);
            const glm::ivec2 last = glm::min(
                range.last + ring, glm::ivec2(tiles_.columns(level), tiles_.rows(level)) - 1);
            for (int row = first.y; row <= last.y; ++row) {
                for (int column = first.x; column <= last.x; ++column) {
                    wishes.push_back({level, row, column});
                }
            }
        }
    }
    shelf_.want(wishes);
}

bool ClipWindows::is_here(int level, const LevelRect& texels) const {
    if (level >= tiles_.levels()) return true;
    const TileRange range = tiles_under(level, texels);
    for (int row = range.first.y; row <= range.last.y; ++row) {
        for (int column = range.first.x; column <= range.last.x; ++column) {
            if (shelf_.find({level, row, column}) == nullptr) return false;
        }
    }
    return true;
}

std::vector<float> ClipWindows::gather(int level, const LevelRect& texels) const {
    const glm::ivec2 end = level_size(pyramid_.info(), level) - 1;
    std::vector<float> heights;
    heights.reserve(std::size_t(texels.area()));
    for (int y = texels.low.y; y < texels.high.y; ++y) {
        const int row = std::clamp(y, 0, end.y);
        if (level >= tiles_.levels()) {
            const Level& small = pyramid_.small(level);
            for (int x = texels.low.x; x < texels.high.x; ++x) {
                heights.push_back(small.at(row, std::clamp(x, 0, end.x)));
            }
            continue;
        }
        const int tile_row = std::min(row / kTileCells, tiles_.rows(level) - 1);
        for (int x = texels.low.x; x < texels.high.x;) {
            const int column = std::clamp(x, 0, end.x);
            const int tile_column = std::min(column / kTileCells, tiles_.columns(level) - 1);
            const std::vector<float>& tile = *shelf_.find({level, tile_row, tile_column});
            const int in_tile = column - tile_column * kTileCells;
            // To the tile's end, which beyond the level's edge repeats its heights.
            const int run = std::min(texels.high.x - x, std::max(1, kTileSamples - in_tile));
            const auto begin =
                tile.begin() + std::ptrdiff_t(row - tile_row * kTileCells) * kTileSamples + in_tile;
            heights.insert(heights.end(), begin, begin + run);
            x += run;
        }
    }
    return heights;
}

int ClipWindows::fill_level(int level, int most_lines, const Write& write) {
    ToroidalWindow& window = windows_[std::size_t(level)];
    int lines = 0;
    while (lines < most_lines) {
        std::optional<LevelRect> strip = window.next_strip(most_lines - lines);
        // Where only a part of it has been read, a narrower strip may do.
        while (strip && !is_here(level, *strip)) {
            const int fewer = window.lines_of(*strip) / 2;
            strip = fewer > 0 ? window.next_strip(fewer) : std::nullopt;
        }
        if (!strip) break;
        for (const WindowPiece& piece : window.pieces(*strip)) {
            const std::vector<float> heights = gather(level, piece.samples);
            const double begin = now_s();
            write(piece.texel, piece.samples.size(), heights);
            counts_.writing_s += now_s() - begin;
        }
        counts_.texels += strip->area();
        lines += window.lines_of(*strip);
        window.fill(*strip);
    }
    return lines;
}

void ClipWindows::fill(int most_lines, const Write& write) {
    if (options_.entire) {
        for (ToroidalWindow& window : windows_) window.forget();
        most_lines = ToroidalWindow::kAllLines;
    }
    int lines = 0;
    for (int level = level_count() - 1; level >= 0 && lines < most_lines; --level) {
        lines += fill_level(level, most_lines - lines, write);
    }
    counts_.lines = lines;
    for (const ToroidalWindow& window : windows_) {
        counts_.missing += window.target().area() - window.held().area();
        counts_.windows_behind += window.complete() ? 0 : 1;
    }
}

void ClipWindows::start(const Write& write) {
    move_to(glm::dvec2(0));
    want(true);
    shelf_.wait();
    for (int level = level_count() - 1; level >= 0; --level) {
        if (holds_all(level)) fill_level(level, ToroidalWindow::kAllLines, write);
    }
}

void ClipWindows::update(const glm::dvec2& place, const Write& write) {
    counts_ = {};
    const double begin = now_s();
    move_to(place);
    want(false);
    shelf_.take();
    fill(options_.lines_per_frame, write);
    counts_.seconds = now_s() - begin;
}

void ClipWindows::load(const glm::dvec2& place, const Write& write) {
    counts_ = {};
    const double begin = now_s();
    move_to(place);
    want(false);
    shelf_.wait();
    fill(ToroidalWindow::kAllLines, write);
    counts_.seconds = now_s() - begin;
}

}  // namespace lodbench::persistent_grid
