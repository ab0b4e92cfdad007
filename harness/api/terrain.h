#pragma once
// The terrain as served to methods: float32 heights in metres on a regular grid, by rectangles of
// the full resolution or by tiles of a pyramid.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>

namespace lodbench {

/// A block of samples of the full-resolution grid: rows [row, row + rows), columns likewise.
struct SampleRect {
    int row = 0;
    int column = 0;
    int rows = 0;
    int columns = 0;
};

/// What is known of a terrain without reading a sample of it.
struct TerrainInfo {
    std::string name;
    int rows = 0;                  ///< >= 2
    int columns = 0;               ///< >= 2
    glm::dvec2 spacing{1.0};       ///< metres between columns (x) and between rows (y), > 0
    glm::dvec2 origin{0.0};        ///< world x, y of sample (rows - 1, 0), the south-west corner
    float min_height = 0;          ///< metres
    float max_height = 0;          ///< metres
    std::uint64_t void_count = 0;  ///< samples that had no data and were filled
    std::string checksum;          ///< of the grid as served: 16 hex digits

    [[nodiscard]] glm::dvec2 extent_min() const { return origin; }
    [[nodiscard]] glm::dvec2 extent_max() const {
        return origin + spacing * glm::dvec2(columns - 1, rows - 1);
    }
    /// World x, y of sample (row, column); row 0 is the north edge.
    [[nodiscard]] glm::dvec2 position(int row, int column) const {
        return origin + spacing * glm::dvec2(column, rows - 1 - row);
    }
};

/// Cells and samples along a tile's edge: neighbours share a line of samples.
inline constexpr int kTileCells = 64;
inline constexpr int kTileSamples = kTileCells + 1;
inline constexpr std::size_t kTileSampleCount = std::size_t(kTileSamples) * kTileSamples;

/// A tile of the pyramid. Level 0 is the full resolution; the samples of level l are those of which
/// row and column are multiples of 2^l. Tile (row, column) of level l begins at sample
/// (64 row 2^l, 64 column 2^l) and takes 65 x 65 samples of its level.
struct TileId {
    int level = 0;
    int row = 0;
    int column = 0;
    friend bool operator==(const TileId&, const TileId&) = default;
};

/// How a grid is cut into tiles: a quadtree in which tile (l, row, column) covers the same ground
/// as the four tiles (l - 1, 2 row + 0|1, 2 column + 0|1), of which those exist that have a cell of
/// the grid. The coarsest level has one tile. Nothing is held but the grid's size.
class TilePyramid {
public:
    /// Both at least 2 and at most 2^30.
    TilePyramid(int rows, int columns);
    [[nodiscard]] int levels() const { return levels_; }
    [[nodiscard]] TileId root() const { return {levels_ - 1, 0, 0}; }
    /// Tiles from north to south and from west to east, 0 <= level < levels().
    [[nodiscard]] int rows(int level) const { return tiles_along(rows_, level); }
    [[nodiscard]] int columns(int level) const { return tiles_along(columns_, level); }
    [[nodiscard]] bool contains(const TileId& tile) const;
    [[nodiscard]] std::size_t count() const { return first_[std::size_t(levels_)]; }
    /// Place of a tile that exists in an array of all tiles: level upon level from 0, each row by
    /// row.
    [[nodiscard]] std::size_t index(const TileId& tile) const {
        return first_[std::size_t(tile.level)] +
               std::size_t(tile.row) * std::size_t(columns(tile.level)) + std::size_t(tile.column);
    }

private:
    static constexpr int kMaxLevels = 25;  ///< 2^30 cells are 2^24 tiles
    static int tiles_along(int samples, int level) {
        return (samples - 2) / kTileCells / (1 << level) + 1;
    }
    int rows_, columns_;
    int levels_ = 1;
    std::array<std::size_t, kMaxLevels + 1> first_{};
};

/// What is known of a tile without reading its samples.
struct TileSummary {
    float min_height = 0;  ///< metres, over all samples of the full resolution that it covers
    float max_height = 0;
    /// Metres: what its level lacks of the next finer one, as longest-edge bisection sees it. The
    /// greatest |z - (z_l + z_r) / 2| over the samples of level l - 1 in the tile that level l does
    /// not have, z_l and z_r being the ends of the edge that the sample splits: of a row or column,
    /// or the diagonal of a cell from a corner with even row and column to one with odd ones (in
    /// steps of level l). Not accumulated over finer levels. 0 at level 0.
    float midpoint_error = 0;
};

/// Serves samples. Every height is finite. All members may be called from several threads at once.
/// What a method asks for is counted where it asks; a terrain itself does not know who does.
class Terrain {
public:
    virtual ~Terrain() = default;
    Terrain(const Terrain&) = delete;
    Terrain& operator=(const Terrain&) = delete;

    [[nodiscard]] const TerrainInfo& info() const { return info_; }

    /// Copies the rectangle into `heights`, row by row, rect.rows * rect.columns floats in metres.
    /// Throws ContractError when the rectangle leaves the grid or the span has another size,
    /// TerrainError as `read_tile` does.
    void read(const SampleRect& rect, std::span<float> heights) const;

    [[nodiscard]] TilePyramid tiles() const { return {info_.rows, info_.columns}; }

    /// Copies a tile's 65 x 65 samples into `heights`, row by row from the north. Beyond the grid
    /// the nearest sample is repeated; the shared shaders cut off what is drawn there. Throws
    /// ContractError for a tile that does not exist or a span of another size, TerrainError, which
    /// names the tile, where the disk fails or what it gives is damaged.
    void read_tile(const TileId& tile, std::span<float> heights) const;

    /// Without reading the tile, where the terrain was stored; else the first call finds the
    /// summaries of all tiles. Throws ContractError for a tile that does not exist.
    [[nodiscard]] TileSummary tile_summary(const TileId& tile) const;

    /// Bytes of tiles read from a file so far to serve what was asked for; 0 for a terrain in
    /// memory.
    [[nodiscard]] virtual std::uint64_t bytes_read() const { return 0; }

protected:
    Terrain() = default;
    TerrainInfo info_;

private:
    virtual void copy_samples(const SampleRect& rect, std::span<float> heights) const = 0;
    virtual void copy_tile(const TileId& tile, std::span<float> heights) const = 0;
    [[nodiscard]] virtual TileSummary find_summary(const TileId& tile) const = 0;
    void require(const TileId& tile, const char* caller) const;
};

}  // namespace lodbench
