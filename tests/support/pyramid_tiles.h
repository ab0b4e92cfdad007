#pragma once
// The tiles of a pyramid, one by one.

#include <vector>

#include "api/terrain.h"

namespace lodbench::test {

/// Level upon level from the finest, each row by row.
inline std::vector<TileId> all_tiles(const TilePyramid& pyramid) {
    std::vector<TileId> tiles;
    for (int level = 0; level < pyramid.levels(); ++level) {
        for (int row = 0; row < pyramid.rows(level); ++row) {
            for (int column = 0; column < pyramid.columns(level); ++column) {
                tiles.push_back({level, row, column});
            }
        }
    }
    return tiles;
}

}  // namespace lodbench::test
