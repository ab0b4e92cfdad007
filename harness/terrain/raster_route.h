#pragma once
// Which reader a file goes to.

#include <filesystem>

namespace lodbench::terrain {

enum class RasterRoute { gdal, oiio, raw, pgm };

/// By the extension, in any case of letters, as the table in raster_route.cpp has it: GDAL for
/// elevation models, OpenImageIO for images, `raw` and `pgm` are read here. A TIFF goes to GDAL
/// where it carries a tag of GeoTIFF or GDAL (33550, 33922, 34264, 34735, 42112, 42113) or a second
/// directory (a mask), or where a world file, a mask (.msk) or metadata (.aux.xml) lie beside it.
/// Throws InputError for any other extension (listing the known ones), for a missing file, and for
/// what begins as another kind of file does.
[[nodiscard]] RasterRoute raster_route(const std::filesystem::path& file);

/// Name of the module that reads such files; nullptr where none is needed.
[[nodiscard]] const char* module_of(RasterRoute route);

}  // namespace lodbench::terrain
