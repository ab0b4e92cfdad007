// Loads the reader modules: from readers/ beside the build tree's bin/, or from the installed
// folder.

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>

#include "api/error.h"
#include "terrain/raster_reader.h"

namespace lodbench::terrain {

namespace fs = std::filesystem;

namespace {

using OpenRaster = RasterReader* (*)(const fs::path&);

/// The module stays loaded: neither library can be unloaded and loaded again safely.
OpenRaster load_module(const fs::path& file, const char* name, const char* what,
                       const char* option) {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const fs::path base = program.parent_path().parent_path();
    const std::array places = {base / "readers" / name, base / LODBENCH_READER_SUBDIR / name};
    for (const fs::path& module : places) {
        if (!fs::exists(module, error)) continue;
        void* handle = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        void* symbol = handle != nullptr ? dlsym(handle, "lodbench_open_raster") : nullptr;
        if (symbol != nullptr) return reinterpret_cast<OpenRaster>(symbol);
        throw EnvironmentError(fmt::format("{}: the reader {} does not load: {}", file.string(),
                                           module.string(), dlerror()));
    }
    throw InputError(
        fmt::format("{}: {}, but the module for it is neither {} nor {}; build with "
                    "-D{}=ON, and install lodbench whole",
                    file.string(), what, places[0].string(), places[1].string(), option));
}

}  // namespace

std::unique_ptr<RasterReader> open_with_gdal(const fs::path& file) {
    const OpenRaster open = load_module(file, "gdal.so", "elevation models are read through GDAL",
                                        "LODBENCH_WITH_GDAL");
    return std::unique_ptr<RasterReader>(open(file));
}

std::unique_ptr<RasterReader> open_with_oiio(const fs::path& file) {
    const OpenRaster open =
        load_module(file, "oiio.so", "images are read through OpenImageIO", "LODBENCH_WITH_OIIO");
    return std::unique_ptr<RasterReader>(open(file));
}

}  // namespace lodbench::terrain
