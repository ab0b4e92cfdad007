#pragma once
// The one symbol of a reader module. GDAL and OpenImageIO bring some 260 shared libraries with
// them; each stands in a module of its own, so that a process pays for them when it reads such a
// file and not before.

#include <filesystem>

#include "terrain/raster_reader.h"

/// A new reader, owned by the caller; throws InputError.
extern "C" __attribute__((visibility("default"))) lodbench::terrain::RasterReader*
lodbench_open_raster(const std::filesystem::path& file);
