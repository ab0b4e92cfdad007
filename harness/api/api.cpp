// What of the interface is not in its headers.

#include <fmt/format.h>

#include "api/error.h"
#include "api/params.h"
#include "api/terrain.h"

namespace lodbench {

void Terrain::read(const SampleRect& rect, std::span<float> heights) const {
    if (rect.row < 0 || rect.column < 0 || rect.rows < 0 || rect.columns < 0 ||
        rect.rows > info_.rows - rect.row || rect.columns > info_.columns - rect.column) {
        throw ContractError(fmt::format(
            "Terrain::read: rows {}+{}, columns {}+{} leave the grid of {} rows x {} columns",
            rect.row, rect.rows, rect.column, rect.columns, info_.rows, info_.columns));
    }
    const std::size_t count = std::size_t(rect.rows) * std::size_t(rect.columns);
    if (heights.size() != count) {
        throw ContractError(fmt::format("Terrain::read: expected room for {} samples, found {}",
                                        count, heights.size()));
    }
    copy_samples(rect, heights);
}

TilePyramid::TilePyramid(int rows, int columns) : rows_(rows), columns_(columns) {
    if (rows < 2 || columns < 2 || rows > 1 << 30 || columns > 1 << 30) {
        throw ContractError(
            fmt::format("TilePyramid: {} rows x {} columns, expected 2 to 2^30", rows, columns));
    }
    while (this->rows(levels_ - 1) > 1 || this->columns(levels_ - 1) > 1) ++levels_;
    for (int level = 0; level < levels_; ++level) {
        first_[std::size_t(level) + 1] =
            first_[std::size_t(level)] +
            std::size_t(this->rows(level)) * std::size_t(this->columns(level));
    }
}

bool TilePyramid::contains(const TileId& tile) const {
    return tile.level >= 0 && tile.level < levels_ && tile.row >= 0 && tile.column >= 0 &&
           tile.row < rows(tile.level) && tile.column < columns(tile.level);
}

void Terrain::require(const TileId& tile, const char* caller) const {
    const TilePyramid pyramid = tiles();
    if (pyramid.contains(tile)) return;
    throw ContractError(fmt::format(
        "Terrain::{}: no tile (level {}, row {}, column {}) in a pyramid of {} levels "
        "over {} rows x {} columns",
        caller, tile.level, tile.row, tile.column, pyramid.levels(), info_.rows, info_.columns));
}

void Terrain::read_tile(const TileId& tile, std::span<float> heights) const {
    require(tile, "read_tile");
    if (heights.size() != kTileSampleCount) {
        throw ContractError(
            fmt::format("Terrain::read_tile: expected room for {} samples, found {}",
                        kTileSampleCount, heights.size()));
    }
    copy_tile(tile, heights);
}

TileSummary Terrain::tile_summary(const TileId& tile) const {
    require(tile, "tile_summary");
    return find_summary(tile);
}

const ParamValue& Params::find(std::string_view name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) {
        throw ContractError(fmt::format("Params: no parameter named '{}' was declared", name));
    }
    return found->second;
}

namespace {
template <typename T>
const T& typed(const ParamValue& value, std::string_view name, const char* type) {
    if (const T* held = std::get_if<T>(&value)) return *held;
    throw ContractError(fmt::format("Params: parameter '{}' was not declared as {}", name, type));
}
}  // namespace

bool Params::boolean(std::string_view name) const {
    return typed<bool>(find(name), name, "boolean");
}
std::int64_t Params::integer(std::string_view name) const {
    return typed<std::int64_t>(find(name), name, "integer");
}
double Params::real(std::string_view name) const {
    return typed<double>(find(name), name, "real");
}
const std::string& Params::choice(std::string_view name) const {
    return typed<std::string>(find(name), name, "choice");
}

}  // namespace lodbench
