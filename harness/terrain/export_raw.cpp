#include "terrain/export_raw.h"

#include <fmt/format.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

#include "api/error.h"
#include "terrain/sidecar.h"

namespace lodbench::terrain {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const char* action, int error) {
    throw EnvironmentError(
        fmt::format("{}: cannot {}: {}", file.string(), action, std::strerror(error)));
}

/// A file beside its place until `publish`; gone if that is never called.
class PendingFile {
public:
    explicit PendingFile(std::filesystem::path file) : file_(std::move(file)), pending_(file_) {
        pending_ += fmt::format(".{}.part", getpid());
        stream_ = std::fopen(pending_.c_str(), "wb");
        if (stream_ == nullptr) refuse(pending_, "be created", errno);
    }
    ~PendingFile() {
        if (stream_ != nullptr) std::fclose(stream_);
        if (!published_) std::remove(pending_.c_str());
    }
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;

    void write(const void* data, std::size_t bytes) {
        if (std::fwrite(data, 1, bytes, stream_) != bytes) refuse(file_, "be written", errno);
    }

    /// All bytes are on the disk when this returns.
    void finish() {
        if (std::fflush(stream_) != 0 || fsync(fileno(stream_)) != 0) {
            refuse(file_, "be written", errno);
        }
        const int closed = std::fclose(stream_);
        stream_ = nullptr;
        if (closed != 0) refuse(file_, "be written", errno);
    }

    void publish() {
        if (std::rename(pending_.c_str(), file_.c_str()) != 0) refuse(file_, "be renamed", errno);
        published_ = true;
    }

private:
    std::filesystem::path file_;
    std::filesystem::path pending_;
    std::FILE* stream_ = nullptr;
    bool published_ = false;
};

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
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (!std::filesystem::is_directory(folder)) {
        throw InputError(fmt::format("{}: the folder {} does not exist; make it first",
                                     file.string(), folder.string()));
    }
    const std::filesystem::path toml = sidecar_path(file);
    PendingFile samples(file);
    PendingFile words(toml);
    std::vector<unsigned char> bytes(std::size_t(field.info().columns) * 4);
    const auto columns = std::size_t(field.info().columns);
    for (std::size_t first = 0; first < field.samples().size(); first += columns) {
        for (std::size_t column = 0; column < columns; ++column) {
            const auto bits = std::bit_cast<std::uint32_t>(field.samples()[first + column]);
            for (std::size_t byte = 0; byte < 4; ++byte) {
                bytes[column * 4 + byte] = static_cast<unsigned char>(bits >> (8 * byte));
            }
        }
        samples.write(bytes.data(), bytes.size());
    }
    const std::string text = sidecar_text(sidecar_of(field.info()));
    words.write(text.data(), text.size());
    samples.finish();
    words.finish();
    if (std::remove(toml.c_str()) != 0 && errno != ENOENT) refuse(toml, "be replaced", errno);
    samples.publish();
    words.publish();
}

}  // namespace lodbench::terrain
