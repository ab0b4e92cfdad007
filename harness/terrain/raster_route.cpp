#include "terrain/raster_route.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "api/error.h"
#include "terrain/raster_reader.h"
#include "terrain/world_file.h"

namespace lodbench::terrain {
namespace {

/// The tags of a TIFF's first directory (TIFF 6.0 section 2; BigTIFF). Both libraries pass over a
/// tag whose data lies beyond the end of a truncated file, and with it over the georeference, so
/// that is refused here. What cannot be followed otherwise counts as no tag: the library that gets
/// the file says why.
class TiffTags {
public:
    explicit TiffTags(const std::filesystem::path& file)
        : file_(file),
          stream_(file, std::ios::binary),
          file_bytes_(std::filesystem::file_size(file)) {}

    /// Whether it has a tag of GeoTIFF or GDAL, or a second directory: a mask, or more rasters.
    bool ask_for_gdal() {
        std::array<char, 2> order{};
        stream_.read(order.data(), 2);
        if (!stream_ || order[0] != order[1] || (order[0] != 'I' && order[0] != 'M')) return false;
        big_endian_ = order[0] == 'M';
        const bool big_tiff = number(2) == 43;
        if (big_tiff) stream_.seekg(8);
        const int word = big_tiff ? 8 : 4;
        const std::uint64_t directory = number(word);
        if (directory >= file_bytes_) refuse_truncated("its directory");
        stream_.seekg(std::streamoff(directory));
        const std::uint64_t count = std::min<std::uint64_t>(number(big_tiff ? 8 : 2), 65535);
        bool found = false;
        for (std::uint64_t i = 0; i < count; ++i) {
            const std::uint64_t tag = number(2);
            const std::uint64_t size = bytes_of(number(2));
            const std::uint64_t values = number(word);
            const std::uint64_t data = number(word);
            if (!stream_) refuse_truncated("its directory");
            const bool inside = values <= std::uint64_t(word) / size ||
                                (data <= file_bytes_ && values <= (file_bytes_ - data) / size);
            if (!inside) refuse_truncated(fmt::format("the data of tag {}", tag));
            found = found || std::ranges::find(kTags, tag) != kTags.end();
        }
        const std::uint64_t second = number(word);
        return found || (stream_ && second != 0);
    }

private:
    static constexpr std::array<std::uint64_t, 6> kTags = {33550, 33922, 34264,
                                                           34735, 42112, 42113};

    [[noreturn]] void refuse_truncated(const std::string& what) const {
        throw InputError(
            fmt::format("{}: {} lies beyond its end, at byte {}; it is truncated, fetch it "
                        "anew",
                        file_.string(), what, file_bytes_));
    }

    /// Bytes of one value of a TIFF type; 1 for those unknown.
    static std::uint64_t bytes_of(std::uint64_t type) {
        static constexpr std::array<std::uint64_t, 19> kBytes = {1, 1, 1, 2, 4, 8, 1, 1, 2, 4,
                                                                 8, 4, 8, 4, 1, 1, 8, 8, 8};
        return type < kBytes.size() ? kBytes[type] : 1;
    }

    std::uint64_t number(int size) {
        std::array<unsigned char, 8> bytes{};
        stream_.read(reinterpret_cast<char*>(bytes.data()), size);
        std::uint64_t value = 0;
        for (int i = 0; i < size; ++i) {
            value = value << 8 | bytes[std::size_t(big_endian_ ? i : size - 1 - i)];
        }
        return value;
    }
    const std::filesystem::path& file_;
    std::ifstream stream_;
    std::uint64_t file_bytes_;
    bool big_endian_ = false;
};

/// Whether files beside a TIFF, which GDAL reads with it, say where it lies or mask it.
bool says_more_beside(const std::filesystem::path& file) {
    std::error_code error;
    for (const char* ending : {".aux.xml", ".msk"}) {
        if (std::filesystem::exists(file.string() + ending, error)) return true;
    }
    return find_world_file(file).has_value();
}

/// What lies under a raster's name where fetching it went wrong, by its first bytes.
void refuse_other_content(const std::filesystem::path& file) {
    struct Content {
        std::string_view begin;
        const char* words;
    };
    static constexpr std::array kContents = {
        Content{"version https://git-lfs",
                "a pointer of Git LFS, not the raster itself; fetch that with `git lfs pull`"},
        Content{"<!doctype html", "a web page, not a raster; fetch it anew and look at the page"},
        Content{"<html", "a web page, not a raster; fetch it anew and look at the page"},
        Content{"\x1f\x8b", "compressed by gzip; unpack it first"},
        Content{"pk\x03\x04", "a zip archive; unpack it first"},
    };
    std::string begin(32, '\0');
    std::ifstream(file, std::ios::binary).read(begin.data(), std::streamsize(begin.size()));
    std::ranges::transform(begin, begin.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    for (const Content& content : kContents) {
        if (!begin.starts_with(content.begin)) continue;
        throw InputError(fmt::format("{}: is {}", file.string(), content.words));
    }
}

struct Format {
    std::string_view extension;  ///< in lower case, with its point
    RasterRoute route;
    /// Raw heights, which may begin with any bytes; else a file that begins as something else does
    /// is refused with words on what it is.
    bool any_bytes = false;
};

/// The one list of what is read. A TIFF is GDAL's where it says more than an image does.
constexpr std::array kFormats = {
    Format{".hgt", RasterRoute::gdal},       Format{".asc", RasterRoute::gdal},
    Format{".dem", RasterRoute::gdal},       Format{".dt0", RasterRoute::gdal},
    Format{".dt1", RasterRoute::gdal},       Format{".dt2", RasterRoute::gdal},
    Format{".img", RasterRoute::gdal},       Format{".bil", RasterRoute::gdal, true},
    Format{".flt", RasterRoute::gdal, true}, Format{".tif", RasterRoute::oiio},
    Format{".tiff", RasterRoute::oiio},      Format{".png", RasterRoute::oiio},
    Format{".exr", RasterRoute::oiio},       Format{".pgm", RasterRoute::pgm},
    Format{".raw", RasterRoute::raw, true},  Format{".r16", RasterRoute::raw, true},
    Format{".bin", RasterRoute::raw, true},
};

/// Throws InputError for an extension that is not in the list, and for other content.
const Format& format_of(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    const auto* const format = std::ranges::find(kFormats, extension, &Format::extension);
    if (format == kFormats.end() || !format->any_bytes) refuse_other_content(file);
    if (format != kFormats.end()) return *format;
    std::vector<std::string_view> known;
    for (const Format& each : kFormats) known.push_back(each.extension.substr(1));
    throw InputError(fmt::format("{}: unknown extension '{}'; known: {}", file.string(), extension,
                                 fmt::join(known, ", ")));
}

}  // namespace

RasterRoute raster_route(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) {
        throw InputError(fmt::format("{}: no such file", file.string()));
    }
    if (!std::filesystem::is_regular_file(status)) {
        throw InputError(fmt::format("{}: not a regular file", file.string()));
    }
    if (!std::ifstream(file, std::ios::binary).is_open()) {
        throw InputError(fmt::format("{}: cannot be opened for reading", file.string()));
    }
    const Format& format = format_of(file);
    const bool is_tiff = format.extension.starts_with(".tif");
    return is_tiff && (TiffTags(file).ask_for_gdal() || says_more_beside(file)) ? RasterRoute::gdal
                                                                                : format.route;
}

const char* module_of(RasterRoute route) {
    switch (route) {
        case RasterRoute::gdal: return "gdal";
        case RasterRoute::oiio: return "oiio";
        case RasterRoute::raw:
        case RasterRoute::pgm: break;
    }
    return nullptr;
}

std::unique_ptr<RasterReader> open_raster(const std::filesystem::path& file,
                                          const Sidecar& sidecar) {
    switch (raster_route(file)) {
        case RasterRoute::gdal: return open_with_gdal(file);
        case RasterRoute::oiio: return open_with_oiio(file);
        case RasterRoute::pgm: return open_pgm(file);
        case RasterRoute::raw: break;
    }
    return open_raw(file, sidecar);
}

}  // namespace lodbench::terrain
