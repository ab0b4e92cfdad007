#include "terrain/raster.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <json/reader.h>
#include <json/writer.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <new>

#include "api/error.h"
#include "base/child_process.h"
#include "base/isolated.h"
#include "base/modules.h"
#include "terrain/memory.h"
#include "terrain/raster_route.h"
#include "terrain/raster_rows.h"

namespace lodbench::terrain {
namespace {

constexpr double kDay = 86400;  // slow disks are waited for
constexpr std::size_t kChunk = std::size_t{16} << 20U;

/// Gives each row to `take`, and what is known of the raster back, but for its heights.
Raster read_rows(const TerrainSource& source, const auto& begin, const auto& take) {
    RasterRows rows(source);
    const TerrainInfo& info = rows.info();
    check_field_size(source.file.string(), info.rows, info.columns);
    begin(info);
    std::vector<float> heights(std::size_t(info.columns));
    for (int row = 0; row < info.rows; ++row) {
        rows.next(heights);
        take(heights);
    }
    return {info, {}, rows.kind(), rows.spacing_assumed(), rows.all_void()};
}

Raster read_here(const TerrainSource& source) {
    // Memory is touched as rows come: a small file that claims to be huge ends before it costs any.
    std::vector<float> heights;
    Raster raster = read_rows(
        source,
        [&](const TerrainInfo& info) {
            heights.reserve(std::size_t(info.rows) * std::size_t(info.columns));
        },
        [&](const std::vector<float>& row) {
            heights.insert(heights.end(), row.begin(), row.end());
        });
    raster.heights = std::move(heights);
    return raster;
}

std::string write_description(const Raster& raster) {
    Json::Value json;
    json["name"] = raster.info.name;
    json["rows"] = raster.info.rows;
    json["columns"] = raster.info.columns;
    json["spacing_x"] = raster.info.spacing.x;
    json["spacing_y"] = raster.info.spacing.y;
    json["origin_x"] = raster.info.origin.x;
    json["origin_y"] = raster.info.origin.y;
    json["void_count"] = Json::UInt64(raster.info.void_count);
    json["kind"] = raster.kind;
    json["spacing_assumed"] = raster.spacing_assumed;
    json["all_void"] = raster.all_void;
    Json::StreamWriterBuilder builder;
    builder["emitUTF8"] = true;  // names are bytes, whatever they spell
    return Json::writeString(builder, json);
}

Raster read_description(const std::string& text) {
    Json::Value json;
    const std::unique_ptr<Json::CharReader> reader(Json::CharReaderBuilder().newCharReader());
    if (!reader->parse(text.data(), text.data() + text.size(), &json, nullptr)) {
        throw EnvironmentError("what came from the reader of a raster is damaged");
    }
    Raster raster;
    raster.info.name = json["name"].asString();
    raster.info.rows = json["rows"].asInt();
    raster.info.columns = json["columns"].asInt();
    raster.info.spacing = {json["spacing_x"].asDouble(), json["spacing_y"].asDouble()};
    raster.info.origin = {json["origin_x"].asDouble(), json["origin_y"].asDouble()};
    raster.info.void_count = json["void_count"].asUInt64();
    raster.kind = json["kind"].asString();
    raster.spacing_assumed = json["spacing_assumed"].asBool();
    raster.all_void = json["all_void"].asString();
    return raster;
}

/// Takes the file's content out of it piece by piece: there is never room for two of it.
void move_out(const base::FileDescriptor& file, std::vector<float>& heights) {
    const std::size_t size = heights.size() * sizeof(float);
    auto* const bytes = reinterpret_cast<char*>(heights.data());
    for (std::size_t at = 0; at < size;) {
        const std::size_t wanted = std::min(kChunk, size - at);
        const ssize_t count = pread(file.number(), bytes + at, wanted, off_t(at));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) {
            throw EnvironmentError(fmt::format("a raster's heights cannot be read from memory: {}",
                                               count < 0 ? std::strerror(errno) : "they end"));
        }
        // Where this is refused the memory is given back a little later.
        (void)fallocate(file.number(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, off_t(at),
                        off_t(count));
        at += std::size_t(count);
    }
}

Raster read_isolated(const TerrainSource& source) {
    const base::FileDescriptor file = base::memory_file("lodbench: heights");
    const base::Answer answer = base::run_isolated(kDay, [&] {
        try {
            return write_description(read_rows(
                source, [](const TerrainInfo&) {},
                [&](const std::vector<float>& row) {
                    const std::string_view bytes(reinterpret_cast<const char*>(row.data()),
                                                 row.size() * sizeof(float));
                    if (!base::write_all(file.number(), bytes)) throw std::bad_alloc();
                }));
        } catch (const std::bad_alloc&) {
            throw EnvironmentError(
                fmt::format("{}: not enough memory to hold it", source.file.string()));
        }
    });
    switch (answer.ending) {
        case base::Ending::answered: break;
        case base::Ending::refused: throw InputError(answer.text);
        case base::Ending::no_means: throw EnvironmentError(answer.text);
        case base::Ending::threw:
        case base::Ending::died:
        case base::Ending::timed_out:
            throw InputError(fmt::format("{}: what reads it {}; the file may be damaged",
                                         source.file.string(), answer.text));
    }
    Raster raster = read_description(answer.text);
    raster.heights.resize(std::size_t(raster.info.rows) * std::size_t(raster.info.columns));
    move_out(file, raster.heights);
    return raster;
}

}  // namespace

Raster read_raster(const TerrainSource& source) {
    const char* const module = module_of(raster_route(source.file));
    const bool here =
        module == nullptr || std::ranges::count(base::loaded_modules(), std::string(module)) > 0;
    return here ? read_here(source) : read_isolated(source);
}

}  // namespace lodbench::terrain
