#include "terrain/raster.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <json/reader.h>
#include <json/writer.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <memory>

#include "api/error.h"
#include "base/child_process.h"
#include "base/isolated.h"
#include "base/modules.h"
#include "terrain/memory.h"
#include "terrain/raster_route.h"
#include "terrain/raster_rows.h"

namespace lodbench::terrain {
namespace {

constexpr double kDay = 86400;                         // slow disks are waited for
constexpr std::size_t kChunk = std::size_t{4} << 20U;  // heights

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
    return {info, {}, rows.provenance(), rows.all_void()};
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

// JSON has no numbers that are not finite: a file's nonsense is to be told where it is looked at.
Json::Value bits_of(double value) {
    return Json::UInt64(std::bit_cast<std::uint64_t>(value));
}
double number_of(const Json::Value& bits) {
    return std::bit_cast<double>(std::uint64_t(bits.asUInt64()));
}

std::string write_description(const Raster& raster) {
    Json::Value json;
    json["name"] = raster.info.name;
    json["rows"] = raster.info.rows;
    json["columns"] = raster.info.columns;
    json["spacing_x"] = bits_of(raster.info.spacing.x);
    json["spacing_y"] = bits_of(raster.info.spacing.y);
    json["origin_x"] = bits_of(raster.info.origin.x);
    json["origin_y"] = bits_of(raster.info.origin.y);
    json["void_count"] = Json::UInt64(raster.info.void_count);
    json["kind"] = raster.provenance.kind;
    json["spacing_assumed"] = raster.provenance.spacing_assumed;
    json["reference"] = raster.provenance.reference;
    json["warnings"] = Json::arrayValue;
    for (const std::string& text : raster.provenance.warnings) json["warnings"].append(text);
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
    raster.info.spacing = {number_of(json["spacing_x"]), number_of(json["spacing_y"])};
    raster.info.origin = {number_of(json["origin_x"]), number_of(json["origin_y"])};
    raster.info.void_count = json["void_count"].asUInt64();
    raster.provenance.kind = json["kind"].asString();
    raster.provenance.spacing_assumed = json["spacing_assumed"].asBool();
    raster.provenance.reference = json["reference"].asString();
    for (const Json::Value& warning : json["warnings"]) {
        raster.provenance.warnings.push_back(warning.asString());
    }
    raster.all_void = json["all_void"].asString();
    return raster;
}

/// Takes `count` heights out of the file piece by piece: there may be no room for two of it.
std::vector<float> move_out(const base::FileDescriptor& file, std::size_t count) {
    std::vector<float> heights;
    heights.reserve(count);  // touched as they come
    while (heights.size() < count) {
        const std::size_t begin = heights.size();
        heights.resize(std::min(count, begin + kChunk));
        const auto offset = off_t(begin * sizeof(float));
        const std::size_t size = (heights.size() - begin) * sizeof(float);
        base::read_exactly(file, offset, &heights[begin], size);
        // Where this is refused the memory is given back a little later.
        (void)fallocate(file.number(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, offset,
                        off_t(size));
    }
    return heights;
}

Raster read_isolated(const TerrainSource& source) {
    const std::string name = source.file.string();
    const base::FileDescriptor file = base::memory_file("lodbench: heights");
    const base::Answer answer = base::run_isolated(kDay, [&] {
        std::signal(SIGXFSZ, SIG_IGN);  // a limit of files' sizes holds for memory too: in words
        return write_description(read_rows(
            source, [](const TerrainInfo&) {},
            [&](const std::vector<float>& row) {
                const std::string_view bytes(reinterpret_cast<const char*>(row.data()),
                                             row.size() * sizeof(float));
                if (base::write_all(file.number(), bytes)) return;
                throw EnvironmentError(fmt::format("{}: its heights cannot be held in memory: {}",
                                                   name, std::strerror(errno)));
            }));
    });
    switch (answer.ending) {
        case base::Ending::answered: break;
        case base::Ending::refused: throw InputError(answer.text);
        case base::Ending::environment_error: throw EnvironmentError(answer.text);
        case base::Ending::threw:
            throw InputError(fmt::format("{}: reading it failed: {}; the file may be damaged", name,
                                         answer.text));
        case base::Ending::died:
            if (answer.signal != SIGKILL) {
                throw InputError(
                    fmt::format("{}: the process that reads it {}; the file may be damaged", name,
                                answer.text));
            }
            [[fallthrough]];
        case base::Ending::timed_out:
            throw EnvironmentError(fmt::format(
                "{}: the process that reads it {}; is there memory enough?", name, answer.text));
    }
    Raster raster = read_description(answer.text);
    raster.heights =
        move_out(file, std::size_t(raster.info.rows) * std::size_t(raster.info.columns));
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
