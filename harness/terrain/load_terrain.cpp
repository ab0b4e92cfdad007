#include "terrain/load_terrain.h"

#include <fmt/format.h>

#include <new>
#include <span>
#include <vector>

#include "api/error.h"
#include "terrain/memory.h"
#include "terrain/open_terrain.h"
#include "terrain/raster.h"
#include "terrain/synthetic.h"
#include "terrain/terrain_rows.h"
#include "terrain/tile_store.h"
#include "terrain/upsample.h"
#include "terrain/void_fill.h"

namespace lodbench::terrain {
namespace {

LoadedTerrain load_raster(const TerrainSource& source) {
    Raster raster = read_raster(source);
    TerrainInfo& info = raster.info;
    const std::uint64_t voids = fill_voids(raster.heights, info.rows, info.columns, info.spacing);
    if (voids == raster.heights.size()) throw InputError(raster.all_void);
    info.void_count += voids;
    return {std::make_unique<HeightField>(info, std::move(raster.heights)),
            std::move(raster.provenance)};
}

LoadedTerrain load_store(const TerrainSource& source) {
    const StoredTerrain store(source.file, source.cold);
    return {whole_field(store), provenance_of(store)};
}

LoadedTerrain load_synthetic(const TerrainSource& source) {
    if (source.vertical_scale || source.vertical_offset || source.no_data) {
        throw InputError(
            fmt::format("synthetic terrain '{}': vertical scale, vertical offset and "
                        "no-data belong to files; use the form's own parameters",
                        source.synthetic));
    }
    check_field_size(fmt::format("synthetic terrain '{}'", source.synthetic), source.rows,
                     source.columns);
    TerrainInfo info;
    info.name = source.synthetic;
    info.rows = source.rows;
    info.columns = source.columns;
    info.spacing = {source.spacing_x.value_or(kSyntheticSpacing),
                    source.spacing_y.value_or(kSyntheticSpacing)};
    info.origin = {source.origin_x.value_or(0), source.origin_y.value_or(0)};
    std::vector<float> heights = make_synthetic(source, info);
    return {std::make_unique<HeightField>(info, std::move(heights)), {.kind = "synthetic"}};
}

/// Loaded before, not passed over: so the library that reads a raster stays out of this process.
LoadedTerrain load_upsampled(const TerrainSource& source) {
    TerrainSource smaller = source;
    smaller.upsampling.reset();
    LoadedTerrain result;
    with_loaded_rows(smaller, [&](TerrainRows& rows) {
        const TerrainInfo info = upsampled(rows.info(), *source.upsampling);
        check_field_size(fmt::format("terrain '{}'", info.name), info.rows, info.columns,
                         "take a smaller factor, or make a store (.tiles) with `lodbench terrain "
                         "upsample`");
        std::vector<float> heights;
        heights.reserve(std::size_t(info.rows) * std::size_t(info.columns));
        upsample(rows, *source.upsampling, [&](std::span<const float> row) {
            heights.insert(heights.end(), row.begin(), row.end());
        });
        result.field = std::make_unique<HeightField>(info, std::move(heights));
        result.provenance = rows.provenance();
    });
    result.provenance.kind += fmt::format(", upsampled by {}", source.upsampling->factor);
    return result;
}

}  // namespace

void check_raster_size(const std::filesystem::path& file, std::int64_t rows, std::int64_t columns) {
    check_grid_size(file.string(), rows, columns);
}

LoadedTerrain load_terrain_with_provenance(const TerrainSource& source) {
    try {
        check_source(source);
        if (source.upsampling) return load_upsampled(source);
        if (source.file.empty()) return load_synthetic(source);
        return is_store(source.file) ? load_store(source) : load_raster(source);
    } catch (const InputError& error) {
        if (source.where.empty()) throw;
        throw InputError(fmt::format("{}: {}", source.where, error.what()));
    } catch (const std::bad_alloc&) {
        const std::string name = source.file.empty() ? source.synthetic : source.file.string();
        throw EnvironmentError(fmt::format("{}: not enough memory to hold it", name));
    }
}

std::unique_ptr<HeightField> load_terrain(const TerrainSource& source) {
    return load_terrain_with_provenance(source).field;
}

}  // namespace lodbench::terrain
