#include "terrain/open_terrain.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <string>
#include <vector>

#include "api/error.h"
#include "terrain/load_terrain.h"
#include "terrain/memory.h"
#include "terrain/tile_store.h"
#include "terrain/upsample.h"

namespace lodbench::terrain {
namespace {

void check_overrides(const TerrainSource& source) {
    const auto check = [](const char* name, const std::optional<double>& value, bool positive) {
        if (value && (!std::isfinite(*value) || (positive && !(*value > 0)))) {
            throw InputError(fmt::format("terrain: {} = {}; it must be {}", name, *value,
                                         positive ? "positive and finite" : "finite"));
        }
    };
    check("spacing (x)", source.spacing_x, true);
    check("spacing (y)", source.spacing_y, true);
    check("vertical scale", source.vertical_scale, false);
    check("vertical offset", source.vertical_offset, false);
    check("origin (x)", source.origin_x, false);
    check("origin (y)", source.origin_y, false);
}

/// A store's heights are what they are, and so is where they stand.
void check_store(const TerrainSource& source) {
    const auto refuse = [&](const char* name, bool given) {
        if (!given) return;
        throw InputError(
            fmt::format("{}: {} is given, but a tiled store says that itself; leave it out, or "
                        "import its original file with it",
                        source.file.string(), name));
    };
    refuse("spacing", source.spacing_x || source.spacing_y);
    refuse("vertical scale", source.vertical_scale.has_value());
    refuse("vertical offset", source.vertical_offset.has_value());
    refuse("origin", source.origin_x || source.origin_y);
    refuse("no-data", source.no_data.has_value());
}

}  // namespace

void check_source(const TerrainSource& source) {
    if (source.file.empty() == source.synthetic.empty()) {
        throw InputError(source.file.empty()
                             ? "terrain: neither a file nor a synthetic form is named"
                             : "terrain: both a file and a synthetic form are named; name one");
    }
    check_overrides(source);
    if (source.upsampling) check_upsampling(*source.upsampling);
    const bool stored = !source.file.empty() && is_store(source.file);
    if (stored) check_store(source);
    for (const auto& [name, set] :
         {std::pair{"cold", source.cold}, {"out_of_core", source.out_of_core}}) {
        if (!set) continue;
        if (source.upsampling) {
            throw InputError(
                fmt::format("{}: {} is set, but what is upsampled lies in memory; leave it out, or "
                            "make a larger store with `lodbench terrain upsample`",
                            source.file.empty() ? source.synthetic : source.file.string(), name));
        }
        if (stored) continue;
        throw InputError(fmt::format(
            "{}: {} is set, but only a tiled store (.tiles) stays on disk; leave it out, or make "
            "it one with `lodbench terrain import`",
            source.file.empty() ? source.synthetic : source.file.string(), name));
    }
}

std::unique_ptr<Terrain> open_terrain(const TerrainSource& source) {
    return open_terrain_with_provenance(source).terrain;
}

OpenTerrain open_terrain_with_provenance(const TerrainSource& source) {
    if (source.file.empty() || !is_store(source.file) || source.upsampling) {
        LoadedTerrain loaded = load_terrain_with_provenance(source);
        return {std::move(loaded.field), std::move(loaded.provenance)};
    }
    try {
        check_source(source);
        auto store = std::make_unique<StoredTerrain>(source.file, source.cold);
        Provenance provenance = provenance_of(*store);
        return {std::move(store), std::move(provenance)};
    } catch (const InputError& error) {
        if (source.where.empty()) throw;
        throw InputError(fmt::format("{}: {}", source.where, error.what()));
    }
}

void require_room_for_whole(const TerrainInfo& info) {
    check_field_size(
        fmt::format("terrain '{}' as a whole", info.name), info.rows, info.columns,
        "leave it on disk (out_of_core = true), or fly without what needs the whole (--no-truth)");
}

std::shared_ptr<const HeightField> whole_field(const std::shared_ptr<const Terrain>& terrain) {
    if (auto field = std::dynamic_pointer_cast<const HeightField>(terrain)) return field;
    return whole_field(*terrain);
}

std::unique_ptr<HeightField> whole_field(const Terrain& terrain) {
    const TerrainInfo& info = terrain.info();
    require_room_for_whole(info);
    const std::size_t columns = std::size_t(info.columns);
    std::vector<float> heights(std::size_t(info.rows) * columns);
    tbb::parallel_for(0, terrain.tiles().rows(0), [&](int tile_row) {
        read_row_of_tiles(
            terrain, tile_row,
            std::span(heights).subspan(std::size_t(tile_row) * kTileCells * columns,
                                       std::size_t(rows_of_tiles(info, tile_row)) * columns));
    });
    auto field = std::make_unique<HeightField>(info, std::move(heights));
    require_checksum(field->info(), info.checksum);
    return field;
}

}  // namespace lodbench::terrain
