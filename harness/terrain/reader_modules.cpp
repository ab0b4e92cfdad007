// The readers that stand in modules of their own.

#include <fmt/format.h>

#include "api/error.h"
#include "base/modules.h"
#include "terrain/raster_reader.h"

namespace lodbench::terrain {

namespace fs = std::filesystem;

namespace {

using OpenRaster = RasterReader* (*)(const fs::path&);

OpenRaster load_reader(const fs::path& file, const char* name, const char* what,
                       const char* option) {
    void* symbol = nullptr;
    try {
        symbol = base::find_in_module(name, "lodbench_open_raster");
    } catch (const EnvironmentError& error) {
        throw EnvironmentError(fmt::format("{}: {}, but {}", file.string(), what, error.what()));
    }
    if (symbol == nullptr) {
        const auto folders = base::module_folders();
        throw InputError(fmt::format(
            "{}: {}, but the module {}.so for it is neither in {} nor in {}; build "
            "with -D{}=ON, and install lodbench whole",
            file.string(), what, name, folders[0].string(), folders[1].string(), option));
    }
    return reinterpret_cast<OpenRaster>(symbol);
}

}  // namespace

std::unique_ptr<RasterReader> open_with_gdal(const fs::path& file) {
    const OpenRaster open =
        load_reader(file, "gdal", "elevation models are read through GDAL", "LODBENCH_WITH_GDAL");
    return std::unique_ptr<RasterReader>(open(file));
}

std::unique_ptr<RasterReader> open_with_oiio(const fs::path& file) {
    const OpenRaster open =
        load_reader(file, "oiio", "images are read through OpenImageIO", "LODBENCH_WITH_OIIO");
    return std::unique_ptr<RasterReader>(open(file));
}

}  // namespace lodbench::terrain
