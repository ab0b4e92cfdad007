#include "terrain/terrain_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "api/error.h"
#include "terrain/load_terrain.h"
#include "terrain/memory.h"
#include "terrain/open_terrain.h"
#include "terrain/raster_rows.h"
#include "terrain/tile_store.h"

namespace lodbench::terrain {
namespace {

struct VoidMet {
    int row = 0;
};

class FileRows final : public TerrainRows {
public:
    explicit FileRows(const TerrainSource& source) : rows_(source) { info_ = rows_.info(); }
    [[nodiscard]] Provenance provenance() const override { return rows_.provenance(); }
    void next(std::span<float> heights) override {
        if (rows_.next(heights) > 0) throw VoidMet{row_};
        ++row_;
    }

private:
    RasterRows rows_;
    int row_ = 0;
};

/// Reads as many rows at once as a tile has cells: each tile of a store once.
class ServedRows final : public TerrainRows {
public:
    ServedRows(std::unique_ptr<const Terrain> terrain, Provenance provenance)
        : terrain_(std::move(terrain)), provenance_(std::move(provenance)) {
        info_ = terrain_->info();
    }
    [[nodiscard]] Provenance provenance() const override { return provenance_; }
    void next(std::span<float> heights) override {
        const auto columns = std::size_t(info_.columns);
        if (row_ % kTileCells == 0) {
            const int rows = std::min(kTileCells, info_.rows - row_);
            strip_.resize(std::size_t(rows) * columns);
            terrain_->read({row_, 0, rows, info_.columns}, strip_);
        }
        std::ranges::copy(
            std::span(strip_).subspan(std::size_t(row_ % kTileCells) * columns, columns),
            heights.begin());
        ++row_;
    }

private:
    std::unique_ptr<const Terrain> terrain_;
    Provenance provenance_;
    std::vector<float> strip_;
    int row_ = 0;
};

/// Nothing where the file was passed over to its end; else the row with the first void.
std::optional<int> give_raster(const TerrainSource& source,
                               const std::function<void(TerrainRows&)>& body) {
    try {
        FileRows rows(source);
        body(rows);
        return std::nullopt;
    } catch (const VoidMet& met) {
        return met.row;
    }
}

}  // namespace

void with_loaded_rows(const TerrainSource& source, const std::function<void(TerrainRows&)>& body) {
    LoadedTerrain loaded = load_terrain_with_provenance(source);
    ServedRows rows(std::move(loaded.field), std::move(loaded.provenance));
    body(rows);
}

void with_rows(const TerrainSource& source, const std::function<void(TerrainRows&)>& body) {
    check_source(source);
    if (source.file.empty() || source.upsampling) return with_loaded_rows(source, body);
    if (is_store(source.file)) {
        auto store = std::make_unique<StoredTerrain>(source.file, source.cold);
        Provenance provenance = provenance_of(*store);
        ServedRows rows(std::move(store), std::move(provenance));
        return body(rows);
    }
    const std::optional<int> row = give_raster(source, body);
    if (!row) return;
    try {
        with_loaded_rows(source, body);
    } catch (const InputError& error) {
        throw InputError(
            fmt::format("{} (row {} has samples without data, and filling them needs "
                        "the whole terrain in memory)",
                        error.what(), *row));
    }
}

}  // namespace lodbench::terrain
