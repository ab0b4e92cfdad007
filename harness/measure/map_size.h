#pragma once
// How many cells a terrain's map has, seen from above.

#include <algorithm>

#include "api/terrain.h"

namespace lodbench::measure {

/// At most 512 cells along the longer side, and never more than there are samples.
struct MapSize {
    int rows = 0, columns = 0;
    explicit MapSize(const TerrainInfo& info) {
        constexpr double kLongest = 512;
        const double cells = std::min(1.0, kLongest / double(std::max(info.rows, info.columns)));
        rows = std::max(1, int(info.rows * cells));
        columns = std::max(1, int(info.columns * cells));
    }
};

}  // namespace lodbench::measure
