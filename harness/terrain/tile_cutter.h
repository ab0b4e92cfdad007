#pragma once
// Rows of the full resolution in, tiles of all levels out.

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "api/terrain.h"

namespace lodbench::terrain {

/// Cuts a grid into the tiles of its pyramid while its rows come by, from north to south. Holds 65
/// rows of each level: 65 x columns x 4 bytes for level 0 and half of it for each level above, so
/// 130 x columns x 4 in all.
class TileCutter {
public:
    /// A tile and its 65 x 65 heights, as Terrain::read_tile gives them; they live as long as the
    /// call. Each tile comes once, children before their parent. Tiles of one row of tiles come
    /// from several threads at once, those of one parent from the same.
    using Sink = std::function<void(const TileId& tile, std::span<const float> heights)>;

    TileCutter(int rows, int columns, Sink sink);

    /// The next row, `columns` heights.
    void push(std::span<const float> row);
    /// After the last row.
    void finish();

private:
    struct Level {
        /// A row: the level's samples, then the grid's last column, which is repeated beyond them.
        std::size_t width = 0;
        std::vector<float> rows;  ///< kTileSamples x width
        int held = 0;             ///< rows that are in `rows`
        int next = 0;             ///< number of the level's next row
        int tile_row = 0;         ///< that `rows` becomes
    };
    void take(int level, std::span<const float> row);
    void emit(int level);
    [[nodiscard]] std::vector<float> thinned(std::span<const float> row, std::size_t step) const;

    TilePyramid pyramid_;
    int grid_rows_, grid_columns_;
    int pushed_ = 0;
    Sink sink_;
    std::vector<Level> levels_;
    std::vector<float> last_;  ///< the row that came last
};

}  // namespace lodbench::terrain
