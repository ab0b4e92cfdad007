#include "terrain/export_raw.h"

#include <fmt/format.h>

#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <span>
#include <vector>

#include "api/error.h"
#include "terrain/pending_file.h"
#include "terrain/sidecar.h"

namespace lodbench::terrain {
namespace {

Sidecar sidecar_of(const TerrainInfo& info) {
    Sidecar sidecar;
    sidecar.name = info.name;
    sidecar.rows = info.rows;
    sidecar.columns = info.columns;
    sidecar.type = SampleType::float32;
    sidecar.big_endian = false;
    sidecar.spacing_x = info.spacing.x;
    sidecar.spacing_y = info.spacing.y;
    sidecar.origin_x = info.origin.x;
    sidecar.origin_y = info.origin.y;
    if (info.void_count > 0) sidecar.voids_filled = info.void_count;
    return sidecar;
}

}  // namespace

void write_raw(const HeightField& field, const std::filesystem::path& file) {
    if (file.extension() != ".raw") {
        throw InputError(fmt::format("{}: heights are written as .raw; give a name that ends so",
                                     file.string()));
    }
    const std::filesystem::path toml = sidecar_path(file);
    PendingFile samples(file);
    PendingFile words(toml);
    std::vector<std::byte> bytes(std::size_t(field.info().columns) * 4);
    const auto columns = std::size_t(field.info().columns);
    for (std::size_t first = 0; first < field.samples().size(); first += columns) {
        for (std::size_t column = 0; column < columns; ++column) {
            const auto bits = std::bit_cast<std::uint32_t>(field.samples()[first + column]);
            for (std::size_t byte = 0; byte < 4; ++byte) {
                bytes[column * 4 + byte] = static_cast<std::byte>(bits >> (8 * byte));
            }
        }
        samples.write(bytes);
    }
    const std::string text = sidecar_text(sidecar_of(field.info()));
    words.write(std::as_bytes(std::span(text)));
    samples.finish();
    words.finish();
    if (std::remove(toml.c_str()) != 0 && errno != ENOENT) {
        throw EnvironmentError(
            fmt::format("{}: cannot be replaced: {}", toml.string(), std::strerror(errno)));
    }
    samples.publish();
    words.publish();
}

}  // namespace lodbench::terrain
