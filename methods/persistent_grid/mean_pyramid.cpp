#include "persistent_grid/mean_pyramid.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <functional>
#include <utility>

#include "api/error.h"

namespace lodbench::persistent_grid {
namespace {

constexpr std::size_t kTileBytes = kTileSampleCount * sizeof(float);
constexpr std::array<char, 16> kMagic = {'l', 'o', 'd', 'b', 'e', 'n', 'c',  'h',
                                         ' ', 'm', 'e', 'a', 'n', 's', '\n', '\0'};
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kByteOrder = 0x01020304;

/// As it lies in the file, in this machine's byte order: the file is never taken elsewhere, and one
/// of another order is made again.
struct Header {
    std::array<char, 16> magic = kMagic;
    std::array<char, 16> terrain{};  ///< its checksum
    std::uint32_t version = kVersion, byte_order = kByteOrder;
    std::uint32_t rows = 0, columns = 0;
    std::uint64_t tiles = 0;
    std::uint64_t checksum = 0;  ///< of all before and of the index, which follows
};
static_assert(sizeof(Header) == 64);

/// Of a sequence of words in this machine's byte order. Each step can be undone, so that a change
/// within one word always changes the result; any other goes unseen once in 2^64.
class Checksum {
public:
    /// Of pieces all but the last are a multiple of 8 bytes long; it is filled up with zeros.
    void add(std::span<const std::byte> bytes) {
        for (std::size_t place = 0; place < bytes.size(); place += 8) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes.data() + place,
                        std::min<std::size_t>(8, bytes.size() - place));
            state_ = (state_ ^ word) * 0x9fb21c651e98df25ULL;
            state_ ^= state_ >> 32U;
        }
    }
    [[nodiscard]] std::uint64_t value() const { return state_; }

private:
    std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

Header header_of(const TerrainInfo& info, std::span<const std::uint64_t> index) {
    Header header;
    std::copy_n(info.checksum.begin(), std::min<std::size_t>(info.checksum.size(), 16),
                header.terrain.begin());
    header.rows = std::uint32_t(info.rows);
    header.columns = std::uint32_t(info.columns);
    header.tiles = index.size();
    Checksum hash;
    hash.add(std::as_bytes(std::span(&header, 1)).first(sizeof header - sizeof header.checksum));
    hash.add(std::as_bytes(index));
    header.checksum = hash.value();
    return header;
}

std::uint64_t checksum_of(std::span<const float> tile) {
    Checksum hash;
    hash.add(std::as_bytes(tile));
    return hash.value();
}

bool read_at(int descriptor, std::uint64_t offset, std::span<std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t got = pread(descriptor, bytes.data(), bytes.size(), off_t(offset));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        offset += std::uint64_t(got);
        bytes = bytes.subspan(std::size_t(got));
    }
    return true;
}

/// Throws EnvironmentError with the system's words.
void write_at(int descriptor, std::uint64_t offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t put = pwrite(descriptor, bytes.data(), bytes.size(), off_t(offset));
        if (put < 0 && errno == EINTR) continue;
        if (put < 0) {
            throw EnvironmentError(
                fmt::format("the pyramid of means cannot be written: {}; free "
                            "some space, or set XDG_CACHE_HOME to another disk",
                            std::strerror(errno)));
        }
        offset += std::uint64_t(put);
        bytes = bytes.subspan(std::size_t(put));
    }
}

/// Takes the rows of one level from north to south: makes its tiles, and the rows of the next
/// level.
class LevelPass {
public:
    /// `write(tile row, heights of its tiles from west to east, 65 x 65 each)`.
    using Write = std::function<void(int, std::span<const float>)>;

    /// `tiles`: columns (x) and rows (y) of tiles.
    LevelPass(glm::ivec2 size, glm::ivec2 tiles, Write write)
        : size_(size), tiles_(tiles), write_(std::move(write)) {
        band_.reserve(std::size_t(kTileSamples) * std::size_t(size.x));
    }
    void feed_into(LevelPass* coarser) { coarser_ = coarser; }

    void add(std::span<const float> row) {
        band_.insert(band_.end(), row.begin(), row.end());
        const bool last = ++rows_ == size_.y;
        if (coarser_ != nullptr) pass_on(row, last);
        if (rows_in_band() == kTileSamples) write_band();
        // The last band may have nothing but the row that it shares with the one before.
        while (last && bands_ < tiles_.y) write_band();
    }

private:
    [[nodiscard]] int rows_in_band() const { return rows_ - kTileCells * bands_; }

    /// Two rows make one, the last of an odd number one by itself.
    void pass_on(std::span<const float> row, bool last) {
        const bool north = rows_ % 2 == 1;
        if (north && !last) {
            north_.assign(row.begin(), row.end());
            return;
        }
        Level pair{size_.x, north ? 1 : 2, {}};
        if (!north) pair.heights = north_;
        pair.heights.insert(pair.heights.end(), row.begin(), row.end());
        coarser_->add(half_resolution(pair).heights);
    }

    void write_band() {
        std::vector<float> tiles;
        tiles.reserve(std::size_t(tiles_.x) * kTileSampleCount);
        for (int column = 0; column < tiles_.x; ++column) {
            for (int r = 0; r < kTileSamples; ++r) {
                const auto row = band_.begin() + std::ptrdiff_t(std::min(r, rows_in_band() - 1)) *
                                                     std::ptrdiff_t(size_.x);
                for (int c = 0; c < kTileSamples; ++c) {
                    tiles.push_back(row[std::min(column * kTileCells + c, size_.x - 1)]);
                }
            }
        }
        write_(bands_, tiles);
        // Neighbours share a row.
        band_.erase(band_.begin(),
                    band_.begin() + std::ptrdiff_t(std::min(rows_in_band() - 1, kTileCells)) *
                                        std::ptrdiff_t(size_.x));
        ++bands_;
    }

    glm::ivec2 size_;
    glm::ivec2 tiles_;
    Write write_;
    LevelPass* coarser_ = nullptr;
    int rows_ = 0;              ///< added so far
    int bands_ = 0;             ///< written so far
    std::vector<float> band_;   ///< rows of the tiles that are being made
    std::vector<float> north_;  ///< waits for the row below it
};

}  // namespace

MeanPyramid::MeanPyramid(const Terrain& terrain, const std::vector<std::filesystem::path>& folders)
    : terrain_(terrain) {
    info_ = terrain.info();
    const TilePyramid pyramid = tiles();
    tile_count_ = pyramid.count() - std::size_t(pyramid.rows(0)) * std::size_t(pyramid.columns(0));
    const std::string name =
        fmt::format("pgm-means-{}-{}x{}", info_.checksum, info_.rows, info_.columns);
    // Without tiles there is nothing that would not fit into memory.
    if (tile_count_ > 0 && !find(folders, name)) make_in(folders, name);
    read_small();
}

bool MeanPyramid::find(const std::vector<std::filesystem::path>& folders, const std::string& name) {
    if (info_.checksum.empty()) return false;
    return std::ranges::any_of(
        folders, [&](const std::filesystem::path& folder) { return open(folder / name); });
}

void MeanPyramid::make_in(std::vector<std::filesystem::path> folders, const std::string& name) {
    const bool keep = !folders.empty() && !info_.checksum.empty();
    if (folders.empty()) folders.push_back(std::filesystem::temp_directory_path());
    std::string tried;
    for (const std::filesystem::path& folder : folders) {
        std::error_code failed;
        std::filesystem::create_directories(folder, failed);
        UnfinishedFile unfinished(folder / name);
        if (!unfinished) {
            tried += fmt::format("{}{}: {}", tried.empty() ? "" : "; ", folder.string(),
                                 std::strerror(errno));
            continue;
        }
        make(unfinished.descriptor());
        if (keep && unfinished.keep()) path_ = folder / name;
        file_ = unfinished.take();
        return;
    }
    throw EnvironmentError(fmt::format(
        "the pyramid of means can be written nowhere ({}); set XDG_CACHE_HOME to a folder of yours",
        tried));
}

std::size_t MeanPyramid::place_of(const TileId& tile) const {
    return tiles().index(tile) - (tiles().count() - tile_count_);
}
std::uint64_t MeanPyramid::offset_of(std::size_t place) const {
    return sizeof(Header) + tile_count_ * sizeof(std::uint64_t) + place * kTileBytes;
}
std::uint64_t MeanPyramid::file_bytes() const {
    return offset_of(tile_count_);
}

bool MeanPyramid::open(const std::filesystem::path& path) {
    file_ = OpenFile(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file_ || !is_whole()) {
        file_ = {};
        return false;
    }
    path_ = path;
    cached_ = true;
    return true;
}

bool MeanPyramid::is_whole() {
    struct stat status {};
    if (fstat(file_.descriptor(), &status) != 0 || !S_ISREG(status.st_mode) ||
        std::uint64_t(status.st_size) != file_bytes()) {
        return false;
    }
    Header header;
    checksums_.assign(tile_count_, 0);
    if (!read_at(file_.descriptor(), 0, std::as_writable_bytes(std::span(&header, 1))) ||
        !read_at(file_.descriptor(), sizeof header,
                 std::as_writable_bytes(std::span(checksums_)))) {
        return false;
    }
    const Header expected = header_of(info_, checksums_);
    if (std::memcmp(&header, &expected, sizeof header) != 0) return false;
    std::vector<float> tile(kTileSampleCount);
    for (std::size_t place = 0; place < tile_count_; ++place) {
        if (!read_at(file_.descriptor(), offset_of(place),
                     std::as_writable_bytes(std::span(tile))) ||
            checksum_of(tile) != checksums_[place]) {
            return false;
        }
    }
    return true;
}

void MeanPyramid::make(int descriptor) {
    checksums_.assign(tile_count_, 0);
    const TilePyramid pyramid = tiles();
    std::vector<LevelPass> passes;
    for (int level = 1; level < pyramid.levels(); ++level) {
        passes.emplace_back(
            level_size(info_, level), glm::ivec2(pyramid.columns(level), pyramid.rows(level)),
            [this, level, descriptor](int row, std::span<const float> heights) {
                const std::size_t first = place_of({level, row, 0});
                write_at(descriptor, offset_of(first), std::as_bytes(heights));
                for (std::size_t i = 0; i * kTileSampleCount < heights.size(); ++i) {
                    checksums_[first + i] =
                        checksum_of(heights.subspan(i * kTileSampleCount, kTileSampleCount));
                }
            });
    }
    for (std::size_t i = 1; i < passes.size(); ++i) passes[i - 1].feed_into(&passes[i]);
    if (!passes.empty()) {
        // A pass over level 0 has no tiles to write: it is the terrain.
        LevelPass finest({info_.columns, info_.rows}, {0, pyramid.rows(0)},
                         [](int, std::span<const float>) {});
        finest.feed_into(&passes[0]);
        const auto columns = std::size_t(info_.columns);
        std::vector<float> band;
        for (int row = 0; row < info_.rows; row += kTileCells) {
            const int rows = std::min(kTileCells, info_.rows - row);
            band.resize(std::size_t(rows) * columns);
            terrain_.read({row, 0, rows, info_.columns}, band);
            for (std::size_t r = 0; r < std::size_t(rows); ++r) {
                finest.add(std::span(band).subspan(r * columns, columns));
            }
        }
    }
    const Header header = header_of(info_, checksums_);
    write_at(descriptor, 0, std::as_bytes(std::span(&header, 1)));
    write_at(descriptor, sizeof header, std::as_bytes(std::span(checksums_)));
}

void MeanPyramid::read_small() {
    const TileId root = tiles().root();
    const glm::ivec2 size = level_size(info_, root.level);
    std::vector<float> tile(kTileSampleCount);
    read_tile(root, tile);
    Level level{size.x, size.y, {}};
    for (int row = 0; row < size.y; ++row) {
        const auto begin = tile.begin() + std::ptrdiff_t(row) * kTileSamples;
        level.heights.insert(level.heights.end(), begin, begin + size.x);
    }
    std::vector<Level> levels = make_pyramid(std::move(level));
    small_.assign(std::make_move_iterator(levels.begin() + 1),
                  std::make_move_iterator(levels.end()));
}

std::uint64_t MeanPyramid::bytes_read() const {
    return terrain_.bytes_read() + bytes_read_.load();
}

void MeanPyramid::copy_samples(const SampleRect& rect, std::span<float> heights) const {
    terrain_.read(rect, heights);
}

void MeanPyramid::copy_tile(const TileId& tile, std::span<float> heights) const {
    if (tile.level == 0) {
        terrain_.read_tile(tile, heights);
        return;
    }
    const std::size_t place = place_of(tile);
    if (!read_at(file_.descriptor(), offset_of(place), std::as_writable_bytes(heights)) ||
        checksum_of(heights) != checksums_[place]) {
        throw TerrainError(fmt::format(
            "{}: tile (level {}, row {}, column {}) cannot be read or is damaged; start again, and "
            "it is made anew",
            path_.empty() ? "the pyramid of means" : path_.string(), tile.level, tile.row,
            tile.column));
    }
    bytes_read_ += kTileBytes;
}

TileSummary MeanPyramid::find_summary(const TileId&) const {
    throw ContractError("MeanPyramid: means have no summaries; ask the terrain");
}

}  // namespace lodbench::persistent_grid
