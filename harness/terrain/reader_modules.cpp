// The readers, and the writer, that stand in modules of their own.

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "api/error.h"
#include "base/modules.h"
#include "terrain/raster_reader.h"
#include "terrain/raster_route.h"
#include "terrain/raster_writer.h"

namespace lodbench::terrain {

namespace fs = std::filesystem;

namespace {

using OpenRaster = RasterReader* (*)(const fs::path&);
using WriteExr = void (*)(const FloatRaster&, const fs::path&);

template <typename Function>
Function load_function(const fs::path& file, const char* name, const char* function,
                       const char* what, const char* option) {
    void* symbol = nullptr;
    try {
        symbol = base::find_in_module(name, function);
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
    return reinterpret_cast<Function>(symbol);
}

/// Where a file is written until it is whole.
fs::path pending_of(fs::path file) {
    file += fmt::format(".{}.part", getpid());
    return file;
}

}  // namespace

std::unique_ptr<RasterReader> open_with_gdal(const fs::path& file) {
    const auto open =
        load_function<OpenRaster>(file, module_of(RasterRoute::gdal), "lodbench_open_raster",
                                  "elevation models are read through GDAL", "LODBENCH_WITH_GDAL");
    return std::unique_ptr<RasterReader>(open(file));
}

std::unique_ptr<RasterReader> open_with_oiio(const fs::path& file) {
    const auto open =
        load_function<OpenRaster>(file, module_of(RasterRoute::oiio), "lodbench_open_raster",
                                  "images are read through OpenImageIO", "LODBENCH_WITH_OIIO");
    return std::unique_ptr<RasterReader>(open(file));
}

void require_exr_output(const fs::path& file) {
    if (file.extension() != ".exr") {
        throw InputError(
            fmt::format("{}: rasters of floats are written as .exr; give a name that "
                        "ends so",
                        file.string()));
    }
    const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (!fs::is_directory(folder)) {
        throw InputError(fmt::format("{}: the folder {} does not exist; make it first",
                                     file.string(), folder.string()));
    }
    // Permissions do not say all (file systems are read-only, or none that keeps files): try it.
    const fs::path pending = pending_of(file);
    std::FILE* stream = std::fopen(pending.c_str(), "wb");
    if (stream == nullptr) {
        throw EnvironmentError(
            fmt::format("{}: the folder {} takes no file: {}; choose one that may be written to",
                        file.string(), folder.string(), std::strerror(errno)));
    }
    std::fclose(stream);
    std::error_code ignored;
    fs::remove(pending, ignored);
}

void write_exr(const FloatRaster& raster, const fs::path& file) {
    require_exr_output(file);
    const auto write =
        load_function<WriteExr>(file, module_of(RasterRoute::oiio), "lodbench_write_exr",
                                "EXR is written through OpenImageIO", "LODBENCH_WITH_OIIO");
    const fs::path pending = pending_of(file);
    std::error_code error;
    try {
        write(raster, pending);
    } catch (...) {
        fs::remove(pending, error);
        throw;
    }
    fs::rename(pending, file, error);
    if (error) {
        std::error_code ignored;
        fs::remove(pending, ignored);
        throw EnvironmentError(
            fmt::format("{}: cannot be renamed: {}", file.string(), error.message()));
    }
}

}  // namespace lodbench::terrain
