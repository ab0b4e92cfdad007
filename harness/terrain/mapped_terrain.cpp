#include "terrain/mapped_terrain.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "api/error.h"
#include "base/files.h"

namespace lodbench::terrain {
namespace {

/// A file without a name, with room for so many bytes.
base::FileDescriptor scratch_file(const std::filesystem::path& folder, std::size_t bytes,
                                  const TerrainInfo& info) {
    const auto fail = [&](int error) {
        const std::string words = fmt::format(
            "{}: a scratch file of {} MiB for the samples of terrain '{}' cannot be made: {}; "
            "free the room, or do not measure (--no-truth)",
            folder.string(), bytes >> 20, info.name, std::strerror(error));
        if (error == ENOSPC || error == EDQUOT || error == EFBIG) throw base::DiskFullError(words);
        throw EnvironmentError(words);
    };
    std::string pattern = (folder / "samples-XXXXXX").string();
    base::FileDescriptor file(mkostemp(pattern.data(), O_CLOEXEC));
    if (!file) fail(errno);
    static_cast<void>(unlink(pattern.c_str()));
    // Now: a full disk under a mapped page would be a signal.
    if (const int error = posix_fallocate(file.number(), 0, off_t(bytes)); error != 0) fail(error);
    return file;
}

void write_at(int descriptor, std::size_t offset, std::span<const float> values) {
    std::span<const std::byte> bytes = std::as_bytes(values);
    while (!bytes.empty()) {
        const ssize_t done = pwrite(descriptor, bytes.data(), bytes.size(), off_t(offset));
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) {
            throw EnvironmentError(
                fmt::format("the scratch file of a terrain's samples cannot be written: {}",
                            std::strerror(errno)));
        }
        offset += std::size_t(done);
        bytes = bytes.subspan(std::size_t(done));
    }
}

/// Bytes of files that this process has resident, by /proc/self/statm; 0 where it does not say.
std::int64_t resident_of_files(const base::FileDescriptor& statm) {
    std::array<char, 128> text{};
    if (pread(statm.number(), text.data(), text.size() - 1, 0) <= 0) return 0;
    long long whole = 0, resident = 0, of_files = 0;
    if (std::sscanf(text.data(), "%lld %lld %lld", &whole, &resident, &of_files) != 3) return 0;
    return of_files * sysconf(_SC_PAGESIZE);
}

}  // namespace

MappedTerrain::MappedTerrain(std::shared_ptr<const Terrain> terrain,
                             const std::filesystem::path& folder, std::int64_t most_resident)
    : terrain_(std::move(terrain)),
      most_resident_(most_resident),
      statm_(open("/proc/self/statm", O_RDONLY | O_CLOEXEC)) {
    info_ = terrain_->info();
    const base::FileDescriptor file = scratch_file(folder, bytes(), info_);
    const std::size_t columns = std::size_t(info_.columns);
    tbb::parallel_for(0, tiles().rows(0), [&](int tile_row) {
        std::vector<float> rows(std::size_t(rows_of_tiles(info_, tile_row)) * columns);
        read_row_of_tiles(*terrain_, tile_row, rows);
        write_at(file.number(), std::size_t(tile_row) * kTileCells * columns * sizeof(float), rows);
    });
    void* const pages = mmap(nullptr, bytes(), PROT_READ, MAP_SHARED, file.number(), 0);
    if (pages == MAP_FAILED) {
        throw EnvironmentError(fmt::format("the samples of terrain '{}' cannot be mapped: {}",
                                           info_.name, std::strerror(errno)));
    }
    pages_ = pages;
    other_ = resident_of_files(statm_);
    try {
        info_.checksum = checksum_of(*this);
        require_checksum(info_, terrain_->info().checksum);
    } catch (...) {
        munmap(pages_, bytes());
        throw;
    }
}

MappedTerrain::~MappedTerrain() {
    munmap(pages_, bytes());
}

std::size_t MappedTerrain::bytes() const {
    return std::size_t(info_.rows) * std::size_t(info_.columns) * sizeof(float);
}

std::span<const float> MappedTerrain::samples() const {
    return {static_cast<const float*>(pages_), bytes() / sizeof(float)};
}

void MappedTerrain::forget() const {
    if (resident_of_files(statm_) - other_.load() < most_resident_) return;
    // Clean pages, or pages on their way to the file: read again they are the same.
    static_cast<void>(madvise(pages_, bytes(), MADV_DONTNEED));
    other_ = resident_of_files(statm_);
}

void MappedTerrain::copy_samples(const SampleRect& rect, std::span<float> heights) const {
    terrain_->read(rect, heights);
}

void MappedTerrain::copy_tile(const TileId& tile, std::span<float> heights) const {
    terrain_->read_tile(tile, heights);
}

TileSummary MappedTerrain::find_summary(const TileId& tile) const {
    return terrain_->tile_summary(tile);
}

}  // namespace lodbench::terrain
