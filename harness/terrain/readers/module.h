#pragma once
// The symbols of a reader's module: gdal and oiio have the first, oiio has the second too; see
// base/modules.h.

#include <filesystem>

#include "terrain/raster_reader.h"
#include "terrain/raster_writer.h"

/// A new reader, owned by the caller; throws InputError.
extern "C" __attribute__((visibility("default"))) lodbench::terrain::RasterReader*
lodbench_open_raster(const std::filesystem::path& file);

/// Writes to exactly this path, an OpenEXR file whatever the name; throws EnvironmentError.
extern "C" __attribute__((visibility("default"))) void lodbench_write_exr(
    const lodbench::terrain::FloatRaster& raster, const std::filesystem::path& file);
