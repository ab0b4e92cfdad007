#include "terrain/tile_store_check.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>

#include "api/error.h"
#include "base/hash.h"
#include "terrain/tile_cutter.h"
#include "terrain/tile_summaries.h"

namespace lodbench::terrain {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr auto kStride = std::ptrdiff_t(kTileSamples);

bool same(float one, float other) {
    return std::bit_cast<std::uint32_t>(one) == std::bit_cast<std::uint32_t>(other);
}
/// Nothing is known where a damaged tile would say it.
bool agree(float built, float stored) {
    return std::isnan(built) || std::isnan(stored) || same(built, stored);
}

class Check {
public:
    Check(const StoredTerrain& store, std::size_t most)
        : store_(store),
          pyramid_(store.tiles()),
          most_(most),
          summaries_(pyramid_),
          doubtful_(pyramid_.count(), 0),
          faulty_(pyramid_.count(), 0),
          cutter_(store.info().rows, store.info().columns,
                  [this](const TileId& tile, std::span<const float> heights) {
                      compare(tile, heights);
                  }) {}

    StoreReport run() {
        const TerrainInfo& info = store_.info();
        base::Fnv1a checksum;
        checksum.add(std::uint32_t(info.rows));
        checksum.add(std::uint32_t(info.columns));
        const auto columns = std::size_t(pyramid_.columns(0));
        strip_.resize(columns * kTileSampleCount);
        south_.assign(columns * kTileSamples, kUnknown);
        std::vector<float> row(std::size_t(info.columns));
        for (int tile_row = 0; tile_row < pyramid_.rows(0); ++tile_row) {
            read_strip(tile_row);
            const bool last = tile_row + 1 == pyramid_.rows(0);
            const int rows = last ? info.rows - tile_row * kTileCells : kTileCells;
            for (int r = 0; r < rows; ++r) {
                assemble(r, row);
                for (const float height : row) checksum.add(std::bit_cast<std::uint32_t>(height));
                cutter_.push(row);
            }
        }
        cutter_.finish();
        if (report_.fault_count == 0 && checksum.hex() != info.checksum) {
            add_fault(fmt::format("the grid has the checksum {}, the header says {}",
                                  checksum.hex(), info.checksum));
        }
        report_.tiles = pyramid_.count();
        report_.bytes = pyramid_.count() * store_.layout().record_bytes();
        return std::move(report_);
    }

private:
    void add_fault(std::string text) {
        const std::lock_guard lock(mutex_);
        ++report_.fault_count;
        if (report_.faults.size() < most_) report_.faults.push_back(std::move(text));
    }
    void fault(const TileId& tile, const std::string& text) {
        char& known = faulty_[pyramid_.index(tile)];
        if (known != 0) return;
        known = 1;
        add_fault(fmt::format("{}: {}", name_of(tile), text));
    }
    /// False, and the fault noted, where the tile cannot be had.
    bool read(const TileId& tile, std::span<float> heights) {
        try {
            store_.read_tile(tile, heights);
            return true;
        } catch (const TerrainError& error) {
            // The message names the file, which is known, and the tile.
            const std::string text = error.what();
            const std::string name = name_of(tile) + ": ";
            const std::size_t place = text.find(name);
            fault(tile, place == std::string::npos ? text : text.substr(place + name.size()));
            return false;
        }
    }
    std::span<float> in_strip(int column) {
        return std::span(strip_).subspan(std::size_t(column) * kTileSampleCount, kTileSampleCount);
    }
    void read_strip(int tile_row);
    void check_borders(int tile_row);
    void assemble(int r, std::span<float> row);
    void compare(const TileId& tile, std::span<const float> built);
    void compare_summary(const TileId& tile);

    const StoredTerrain& store_;
    TilePyramid pyramid_;
    std::size_t most_;
    StoreReport report_;
    std::mutex mutex_;
    TileSummaries summaries_;
    std::vector<char> doubtful_;  ///< tiles of which the finer levels do not say all
    std::vector<char> faulty_;
    std::vector<float> strip_;  ///< a row of level-0 tiles, one after another; NaN where damaged
    std::vector<float> south_;  ///< the southern lines of the row of tiles before
    TileCutter cutter_;
};

void Check::read_strip(int tile_row) {
    tbb::parallel_for(0, pyramid_.columns(0), [&](int column) {
        const std::span<float> heights = in_strip(column);
        if (!read({0, tile_row, column}, heights)) std::ranges::fill(heights, kUnknown);
    });
    check_borders(tile_row);
    for (int column = 0; column < pyramid_.columns(0); ++column) {
        std::ranges::copy(in_strip(column).last(kTileSamples), south_.begin() + column * kStride);
    }
}

void Check::check_borders(int tile_row) {
    const TerrainInfo& info = store_.info();
    for (int column = 0; column < pyramid_.columns(0); ++column) {
        const TileId tile{0, tile_row, column};
        const std::span<float> heights = in_strip(column);
        const int last_row = std::min(kTileCells, info.rows - 1 - tile_row * kTileCells);
        const int last_column = std::min(kTileCells, info.columns - 1 - column * kTileCells);
        for (int i = 0; i < kTileSamples; ++i) {
            if (!agree(south_[std::size_t(column) * kTileSamples + std::size_t(i)],
                       heights[std::size_t(i)])) {
                fault(tile, "its northern border is not its neighbour's southern one");
            }
            if (column > 0 &&
                !agree(in_strip(column - 1)[std::size_t(i * kTileSamples + kTileCells)],
                       heights[std::size_t(i * kTileSamples)])) {
                fault(tile, "its western border is not its neighbour's eastern one");
            }
        }
        if (last_row == kTileCells && last_column == kTileCells) continue;
        for (int r = 0; r < kTileSamples; ++r) {
            for (int c = 0; c < kTileSamples; ++c) {
                const int inside = std::min(r, last_row) * kTileSamples + std::min(c, last_column);
                if (!agree(heights[std::size_t(inside)],
                           heights[std::size_t(r * kTileSamples + c)])) {
                    fault(tile, "beyond the grid it does not repeat the nearest sample");
                }
            }
        }
    }
}

void Check::assemble(int r, std::span<float> row) {
    for (int column = 0; column < pyramid_.columns(0); ++column) {
        const std::size_t first = std::size_t(column) * kTileCells;
        const std::size_t count = std::min<std::size_t>(kTileSamples, row.size() - first);
        std::ranges::copy(in_strip(column).subspan(std::size_t(r * kTileSamples), count),
                          row.begin() + std::ptrdiff_t(first));
    }
}

void Check::compare(const TileId& tile, std::span<const float> built) {
    bool doubtful = std::ranges::any_of(built, [](float height) { return std::isnan(height); });
    if (tile.level > 0) {
        std::vector<float> stored(kTileSampleCount);
        if (read(tile, stored) && !std::ranges::equal(built, stored, agree)) {
            fault(tile, "its heights are not those of the finer levels");
        }
        for (const int child : {0, 1, 2, 3}) {
            const TileId finer{tile.level - 1, 2 * tile.row + child / 2,
                               2 * tile.column + child % 2};
            if (pyramid_.contains(finer)) doubtful |= doubtful_[pyramid_.index(finer)] != 0;
        }
    }
    doubtful_[pyramid_.index(tile)] = doubtful ? 1 : 0;
    summaries_.add(tile, built);
    if (!doubtful) compare_summary(tile);
}

void Check::compare_summary(const TileId& tile) {
    const TileSummary& made = summaries_.at(tile);
    const TileSummary stored = store_.tile_summary(tile);
    if (same(made.min_height, stored.min_height) && same(made.max_height, stored.max_height) &&
        same(made.midpoint_error, stored.midpoint_error)) {
        return;
    }
    fault(tile, fmt::format("its summary says {} to {} m, midpoint error {} m, its samples say {} "
                            "to {} m, {} m",
                            stored.min_height, stored.max_height, stored.midpoint_error,
                            made.min_height, made.max_height, made.midpoint_error));
}

}  // namespace

StoreReport check_tiles(const StoredTerrain& store, std::size_t most) {
    return Check(store, most).run();
}

}  // namespace lodbench::terrain
