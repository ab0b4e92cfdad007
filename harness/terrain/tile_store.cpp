#include "terrain/tile_store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "api/error.h"
#include "base/hash.h"
#include "terrain/memory.h"

namespace lodbench::terrain {
namespace {

/// Level-0 tiles that `read` keeps: what a column of rectangles as wide as two tiles needs, 16.9
/// kB each.
constexpr std::size_t kCachedTiles = 64;

enum class Ending { complete, end_of_file, error };

/// Fills `bytes`; where that fails errno says why.
Ending read_at(int descriptor, std::uint64_t offset, std::span<std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t got = pread(descriptor, bytes.data(), bytes.size(), off_t(offset));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return Ending::error;
        if (got == 0) return Ending::end_of_file;
        offset += std::uint64_t(got);
        bytes = bytes.subspan(std::size_t(got));
    }
    return Ending::complete;
}

}  // namespace

StoredTerrain::StoredTerrain(std::filesystem::path file, bool cold) : file_(std::move(file)) {
    open();
    if (cold) static_cast<void>(posix_fadvise(descriptor_.number(), 0, 0, POSIX_FADV_DONTNEED));
}

void StoredTerrain::open() {
    descriptor_ = base::FileDescriptor(::open(file_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (!descriptor_) {
        throw InputError(
            fmt::format("{}: cannot be opened for reading: {}; check its name and permissions",
                        file_.string(), std::strerror(errno)));
    }
    struct stat status {};
    if (fstat(descriptor_.number(), &status) != 0 || !S_ISREG(status.st_mode)) {
        throw InputError(fmt::format("{}: not a regular file; name a tiled store", file_.string()));
    }
    const auto file_bytes = std::uint64_t(status.st_size);
    if (file_bytes < kStoreHeaderBytes) {
        throw InputError(fmt::format(
            "{}: {} bytes, of which a tiled store's header alone takes {}; it is truncated or no "
            "store, fetch or build it anew",
            file_.string(), file_bytes, kStoreHeaderBytes));
    }
    std::array<std::byte, kStoreHeaderBytes> bytes{};
    if (const Ending ending = read_at(descriptor_.number(), 0, bytes); ending != Ending::complete) {
        throw EnvironmentError(fmt::format(
            "{}: the header cannot be read: {}", file_.string(),
            ending == Ending::error ? std::strerror(errno) : "the file has become shorter"));
    }
    const StoreHeader header = decode_header(bytes, file_bytes, file_);
    info_ = header.info;
    sampling_ = header.sampling;
    layout_ = StoreLayout(info_.rows, info_.columns, sampling_);
    read_index(header, bytes);
    const TileSummary& root = summaries_[layout_.pyramid().index(layout_.pyramid().root())];
    if (root.min_height != info_.min_height || root.max_height != info_.max_height) {
        throw InputError(fmt::format(
            "{}: heights of {} to {} m by the header, of {} to {} m by the coarsest tile; the file "
            "is damaged, build it anew",
            file_.string(), info_.min_height, info_.max_height, root.min_height, root.max_height));
    }
}

void StoredTerrain::read_index(const StoreHeader& header, std::span<const std::byte> header_bytes) {
    const TilePyramid& pyramid = layout_.pyramid();
    // The file is as long as its tiles need: a small one cannot claim many. A sparse one can.
    const std::uint64_t needed = pyramid.count() * (sizeof(std::uint64_t) + sizeof(TileSummary));
    if (const auto free = available_memory(); free && needed > std::uint64_t(*free)) {
        throw EnvironmentError(
            fmt::format("{}: the index of {} tiles needs {} MiB, {} MiB of memory are free",
                        file_.string(), pyramid.count(), needed >> 20, *free >> 20));
    }
    checksums_.reserve(pyramid.count());
    summaries_.reserve(pyramid.count());
    base::WordHash hash;
    hash.add(header_bytes.first(kStoreHeaderBytes - 8));
    std::uint64_t place = kStoreHeaderBytes;
    std::vector<std::byte> bytes;
    for (int level = 0; level < pyramid.levels(); ++level) {
        for (int row = 0; row < pyramid.rows(level); ++row) {
            bytes.resize(std::size_t(pyramid.columns(level)) * kIndexEntryBytes);
            const Ending ending = read_at(descriptor_.number(), place, bytes);
            if (ending != Ending::complete) {
                throw EnvironmentError(
                    fmt::format("{}: the index cannot be read: {}", file_.string(),
                                ending == Ending::error ? std::strerror(errno)
                                                        : "the file has become shorter"));
            }
            hash.add(bytes);
            place += bytes.size();
            for (int column = 0; column < pyramid.columns(level); ++column) {
                const IndexEntry entry =
                    decode_entry(std::span(std::as_const(bytes))
                                     .subspan(std::size_t(column) * kIndexEntryBytes)
                                     .first<kIndexEntryBytes>(),
                                 {level, row, column}, layout_, file_);
                checksums_.push_back(entry.checksum);
                summaries_.push_back(entry.summary);
            }
        }
    }
    if (hash.value() != header.checksum) {
        throw InputError(fmt::format(
            "{}: header and index have the checksum {:016x}, the header says {:016x}; the file is "
            "damaged, fetch or build it anew",
            file_.string(), hash.value(), header.checksum));
    }
}

void StoredTerrain::copy_tile(const TileId& tile, std::span<float> heights) const {
    const auto fail = [&](const std::string& what) {
        throw TerrainError(fmt::format("{}: {}: {}", file_.string(), name_of(tile), what));
    };
    std::array<std::byte, kTileSampleCount * 4> buffer;
    const std::span<std::byte> record = std::span(buffer).first(layout_.record_bytes());
    const std::uint64_t offset = layout_.offset(tile);
    switch (read_at(descriptor_.number(), offset, record)) {
        case Ending::complete: break;
        case Ending::error: fail(fmt::format("cannot be read: {}", std::strerror(errno))); break;
        case Ending::end_of_file:
            fail(
                fmt::format("its bytes {} to {} lie beyond the end of the file, which has been "
                            "truncated; fetch or build it anew",
                            offset, offset + record.size()));
            break;
    }
    bytes_read_ += record.size();
    const std::size_t index = layout_.pyramid().index(tile);
    base::WordHash hash;
    hash.add(record);
    if (hash.value() != checksums_[index]) {
        fail(
            fmt::format("the checksum is {:016x}, the index says {:016x}; the file is damaged, "
                        "fetch or build it anew",
                        hash.value(), checksums_[index]));
    }
    decode_tile(record, sampling_, heights);
    // A file made to deceive has the checksum that it says it has. So that NaN fails too.
    const TileSummary& summary = summaries_[index];
    bool inside = true;
    for (const float height : heights) {
        inside &= height >= summary.min_height && height <= summary.max_height;
    }
    if (!inside) {
        fail(fmt::format("heights that are not within {} to {} m, as the index says; build it anew",
                         summary.min_height, summary.max_height));
    }
}

TileSummary StoredTerrain::find_summary(const TileId& tile) const {
    return summaries_[layout_.pyramid().index(tile)];
}

StoredTerrain::Tile StoredTerrain::cached(const TileId& tile) const {
    {
        const std::lock_guard lock(mutex_);
        const auto found =
            std::ranges::find_if(cache_, [&](const auto& entry) { return entry.first == tile; });
        if (found != cache_.end()) {
            cache_.splice(cache_.begin(), cache_, found);
            return found->second;
        }
    }
    // Unlocked: threads that miss the same tile at once read it twice, and none waits for the disk
    // of another.
    auto heights = std::make_shared<std::vector<float>>(kTileSampleCount);
    copy_tile(tile, *heights);
    const std::lock_guard lock(mutex_);
    cache_.emplace_front(tile, heights);
    if (cache_.size() > kCachedTiles) cache_.pop_back();
    return heights;
}

void StoredTerrain::copy_samples(const SampleRect& rect, std::span<float> heights) const {
    const TilePyramid& pyramid = layout_.pyramid();
    // Neighbours share a line: it is taken from the tile that ends there only at the grid's edge.
    const auto last_tile = [](int end, int tiles) {
        return std::min((end - 1) / kTileCells, tiles - 1);
    };
    if (rect.rows == 0 || rect.columns == 0) return;
    const int last_row = last_tile(rect.row + rect.rows, pyramid.rows(0));
    const int last_column = last_tile(rect.column + rect.columns, pyramid.columns(0));
    for (int row = std::min(rect.row / kTileCells, last_row); row <= last_row; ++row) {
        for (int column = std::min(rect.column / kTileCells, last_column); column <= last_column;
             ++column) {
            const Tile tile = cached({0, row, column});
            const int north = std::max(rect.row, row * kTileCells);
            const int south =
                std::min(rect.row + rect.rows,
                         row * kTileCells + (row == last_row ? kTileSamples : kTileCells));
            const int west = std::max(rect.column, column * kTileCells);
            const int east =
                std::min(rect.column + rect.columns,
                         column * kTileCells + (column == last_column ? kTileSamples : kTileCells));
            for (int r = north; r < south; ++r) {
                const auto in = tile->begin() + (r - row * kTileCells) * kTileSamples +
                                (west - column * kTileCells);
                std::copy_n(in, east - west,
                            heights.begin() + std::ptrdiff_t(r - rect.row) * rect.columns +
                                (west - rect.column));
            }
        }
    }
}

Provenance provenance_of(const StoredTerrain& store) {
    return {.kind = fmt::format("tiled store, {}", store.sampling().text())};
}

}  // namespace lodbench::terrain
