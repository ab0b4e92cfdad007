#include "clipmap/tent_terrain.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include "api/error.h"

namespace lodbench::clipmap {

namespace {

/// One row of the coarser level, from the three finer ones around it. Sums of sixteenths of floats
/// are exact in double unless heights differ by a factor of 2^25, so that no order matters.
void filter_row(std::span<const float> north, std::span<const float> middle,
                std::span<const float> south, std::span<float> coarse) {
    const std::size_t last = middle.size() - 1;
    const auto column = [&](std::size_t x) {
        return double(north[x]) + 2.0 * double(middle[x]) + double(south[x]);
    };
    for (std::size_t k = 0; k < coarse.size(); ++k) {
        const std::size_t centre = std::min(2 * k, last);
        const std::size_t west = k == 0 ? 0 : std::min(2 * k - 1, last);
        const std::size_t east = std::min(2 * k + 1, last);
        coarse[k] = float((column(west) + 2.0 * column(centre) + column(east)) / 16.0);
    }
}

HeightGrid half_size(const HeightGrid& fine) {
    HeightGrid coarse{last_sample(fine.columns, 1) + 1, last_sample(fine.rows, 1) + 1, {}};
    coarse.heights.resize(std::size_t(coarse.columns) * std::size_t(coarse.rows));
    return coarse;
}

/// Tiles of the finest level, which is not stored.
std::size_t number_of_finest(const TilePyramid& pyramid) {
    return std::size_t(pyramid.rows(0)) * std::size_t(pyramid.columns(0));
}
std::size_t number_in_storage(const TilePyramid& pyramid, const TileId& tile) {
    return pyramid.index(tile) - number_of_finest(pyramid);
}

}  // namespace

float HeightGrid::nearest(int x, int y) const {
    return row(std::clamp(y, 0, rows - 1))[std::size_t(std::clamp(x, 0, columns - 1))];
}

HeightGrid coarser_by_tent(const HeightGrid& fine) {
    HeightGrid coarse = half_size(fine);
    const auto row = [&](int y) { return fine.row(std::clamp(y, 0, fine.rows - 1)); };
    for (int y = 0; y < coarse.rows; ++y) {
        filter_row(row(2 * y - 1), row(2 * y), row(2 * y + 1),
                   std::span(coarse.heights)
                       .subspan(std::size_t(y) * std::size_t(coarse.columns),
                                std::size_t(coarse.columns)));
    }
    return coarse;
}

HeightGrid coarser_by_decimation(const HeightGrid& fine) {
    HeightGrid coarse = half_size(fine);
    std::size_t i = 0;
    for (int y = 0; y < coarse.rows; ++y) {
        for (int x = 0; x < coarse.columns; ++x) coarse.heights[i++] = fine.nearest(2 * x, 2 * y);
    }
    return coarse;
}

/// Tiles by a number, in memory or in a file that has no name and ends with the process.
class TentTerrain::Storage {
public:
    Storage(std::size_t tiles, std::size_t most_bytes_in_memory) : bytes_(tiles * kTileBytes) {
        if (bytes_ <= most_bytes_in_memory) {
            memory_.resize(tiles * kTileSampleCount);
        } else {
            make_file();
        }
    }
    ~Storage() {
        if (file_ >= 0) ::close(file_);
    }
    Storage(const Storage&) = delete;
    Storage& operator=(const Storage&) = delete;

    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    void write(std::size_t tile, std::span<const float> heights) {
        if (file_ < 0) {
            std::ranges::copy(heights, memory_.begin() + std::ptrdiff_t(tile * kTileSampleCount));
        } else {
            transfer(tile, "write", [&](std::size_t done, std::size_t left, ::off_t place) {
                return ::pwrite(file_, reinterpret_cast<const char*>(heights.data()) + done, left,
                                place);
            });
        }
    }
    void read(std::size_t tile, std::span<float> heights) const {
        if (file_ < 0) {
            std::copy_n(memory_.begin() + std::ptrdiff_t(tile * kTileSampleCount), kTileSampleCount,
                        heights.begin());
        } else {
            transfer(tile, "read", [&](std::size_t done, std::size_t left, ::off_t place) {
                return ::pread(file_, reinterpret_cast<char*>(heights.data()) + done, left, place);
            });
        }
    }

private:
    static constexpr std::size_t kTileBytes = kTileSampleCount * sizeof(float);

    void make_file() {
        folder_ = std::filesystem::temp_directory_path().string();
        std::string name = folder_ + "/lodbench-clipmap-XXXXXX";
        file_ = ::mkostemp(name.data(), O_CLOEXEC);
        if (file_ < 0) fail("make a file", errno);
        ::unlink(name.c_str());
        // So that a lack of room is found now, and not in the middle of a flight.
        if (const int error = ::posix_fallocate(file_, 0, ::off_t(bytes_))) {
            ::close(file_);
            fail("reserve a file", error);
        }
    }
    [[noreturn]] void fail(const char* what, int error) const {
        throw EnvironmentError(fmt::format(
            "clipmap cannot {} of {} MB for its filtered levels in {}: {}; name another folder by "
            "TMPDIR, or choose filter = \"none\"",
            what, bytes_ / 1000000, folder_, std::generic_category().message(error)));
    }
    template <typename Call>
    void transfer(std::size_t tile, const char* what, const Call& call) const {
        std::size_t done = 0;
        while (done < kTileBytes) {
            const ::ssize_t count =
                call(done, kTileBytes - done, ::off_t(tile * kTileBytes + done));
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) fail(what, count == 0 ? EIO : errno);
            done += std::size_t(count);
        }
    }

    std::size_t bytes_;
    std::vector<float> memory_;
    std::string folder_;
    int file_ = -1;
};

/// Takes the terrain's rows from north to south, and keeps of each level what the next one and the
/// tiles still need: two rows, and the rows of one line of tiles.
class TentTerrain::Builder {
public:
    Builder(const TerrainInfo& info, const TilePyramid& pyramid, Storage& storage)
        : pyramid_(pyramid), storage_(storage), levels_(std::size_t(pyramid.levels())) {
        for (int level = 0; level < pyramid.levels(); ++level) {
            Level& made = levels_[std::size_t(level)];
            made.columns = last_sample(info.columns, level) + 1;
            made.rows = last_sample(info.rows, level) + 1;
            if (level > 0) made.tile_rows.resize(std::size_t(made.columns) * kTileSamples);
        }
    }

    void push(int level, std::span<const float> row) {
        Level& made = levels_[std::size_t(level)];
        const int index = made.next++;
        const bool is_last = index == made.rows - 1;
        if (level > 0) keep_for_tiles(level, index, row, is_last);
        if (level + 1 == pyramid_.levels()) return;
        if (index % 2 == 1) {
            const auto north = index == 1 ? std::span<const float>(made.middle) : made.north;
            push_filtered(level + 1, north, made.middle, row);
        }
        if (is_last) {
            // An odd last row is the coarser level's last but one: beyond it the edge goes on.
            push_filtered(level + 1, index % 2 == 1 ? row : std::span<const float>(made.middle),
                          row, row);
        }
        std::swap(made.north, made.middle);
        made.middle.assign(row.begin(), row.end());
    }

private:
    struct Level {
        int columns = 0, rows = 0;
        int next = 0;                      ///< row that comes
        std::vector<float> north, middle;  ///< the two before
        int tile_row = 0;                  ///< the line of tiles that is being filled
        std::vector<float> tile_rows;      ///< its rows
    };

    void push_filtered(int level, std::span<const float> north, std::span<const float> middle,
                       std::span<const float> south) {
        std::vector<float> row(std::size_t(levels_[std::size_t(level)].columns));
        filter_row(north, middle, south, row);
        push(level, row);
    }

    /// Where the line of tiles is complete it is written; its last row is the next one's first.
    void keep_for_tiles(int level, int index, std::span<const float> row, bool is_last) {
        Level& made = levels_[std::size_t(level)];
        const int within = index - made.tile_row * kTileCells;
        std::ranges::copy(row, made.tile_rows.begin() + std::ptrdiff_t(within) * made.columns);
        if (within < kTileCells && !is_last) return;
        write_tiles(level, within);
        std::ranges::copy(row, made.tile_rows.begin());
        ++made.tile_row;
    }
    /// Beyond the last row and column these are repeated.
    void write_tiles(int level, int last_row) {
        const Level& made = levels_[std::size_t(level)];
        std::vector<float> heights(kTileSampleCount);
        for (int column = 0; column < pyramid_.columns(level); ++column) {
            for (int y = 0; y < kTileSamples; ++y) {
                const auto row =
                    made.tile_rows.begin() + std::ptrdiff_t(std::min(y, last_row)) * made.columns;
                for (int x = 0; x < kTileSamples; ++x) {
                    heights[std::size_t(y) * kTileSamples + std::size_t(x)] =
                        row[std::min(column * kTileCells + x, made.columns - 1)];
                }
            }
            storage_.write(number_in_storage(pyramid_, {level, made.tile_row, column}), heights);
        }
    }

    const TilePyramid& pyramid_;
    Storage& storage_;
    std::vector<Level> levels_;
};

TentTerrain::TentTerrain(const Terrain& terrain, std::size_t most_bytes_in_memory)
    : terrain_(terrain), pyramid_(terrain.tiles()) {
    info_ = terrain.info();
    const std::size_t finest = number_of_finest(pyramid_);
    storage_ = std::make_unique<Storage>(pyramid_.count() - finest, most_bytes_in_memory);
    Builder builder(info_, pyramid_, *storage_);
    const std::size_t columns = std::size_t(info_.columns);
    // As many rows as a line of tiles has, so that no tile is read twice.
    std::vector<float> rows;
    for (int first = 0; first < info_.rows; first += kTileCells) {
        const int count = std::min(kTileCells, info_.rows - first);
        rows.resize(std::size_t(count) * columns);
        terrain.read({first, 0, count, info_.columns}, rows);
        for (int i = 0; i < count; ++i) {
            builder.push(0, std::span(rows).subspan(std::size_t(i) * columns, columns));
        }
    }
}

TentTerrain::~TentTerrain() = default;

std::size_t TentTerrain::bytes() const {
    return storage_->bytes();
}

void TentTerrain::copy_samples(const SampleRect& rect, std::span<float> heights) const {
    terrain_.read(rect, heights);
}

void TentTerrain::copy_tile(const TileId& tile, std::span<float> heights) const {
    if (tile.level == 0) {
        terrain_.read_tile(tile, heights);
    } else {
        storage_->read(number_in_storage(pyramid_, tile), heights);
    }
}

TileSummary TentTerrain::find_summary(const TileId& tile) const {
    return terrain_.tile_summary(tile);
}

}  // namespace lodbench::clipmap
