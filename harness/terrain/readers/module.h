#pragma once
// The one symbol of a reader's module; see base/modules.h.

#include <filesystem>

#include "terrain/raster_reader.h"

/// A new reader, owned by the caller; throws InputError.
extern "C" __attribute__((visibility("default"))) lodbench::terrain::RasterReader*
lodbench_open_raster(const std::filesystem::path& file);
