#pragma once
// Which reader a file goes to.

#include <filesystem>

namespace lodbench::terrain {

enum class RasterRoute { gdal, oiio, raw, pgm };

/// The rule, by the extension in lower case:
/// - hgt, asc, dem, dt0, dt1, dt2, img, bil, flt: GDAL;
/// - tif, tiff: GDAL where the TIFF carries a tag of GeoTIFF or GDAL (33550, 33922, 34264, 34735,
///   42112, 42113) or a second directory (a mask), or where a world file, a mask (.msk) or metadata
///   (.aux.xml) lie beside it, else OpenImageIO;
/// - png, exr: OpenImageIO;
/// - pgm: read here;
/// - raw, r16, bin: read here, as the sidecar says.
/// Throws InputError for any other extension (listing the known ones) and for a missing file.
[[nodiscard]] RasterRoute raster_route(const std::filesystem::path& file);

/// Name of the module that reads such files; nullptr where none is needed.
[[nodiscard]] const char* module_of(RasterRoute route);

}  // namespace lodbench::terrain
