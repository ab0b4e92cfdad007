#pragma once
// Over which grounds and settings blocks of equal size have to be closed.

#include "closed_surface.h"

namespace lodbench::test {

inline const std::vector<ClosedCase> kUniformClosed = {
    ClosedCase{"puget", 0, 0, {}},
    ClosedCase{"ridged", 257, 257, {}},
    ClosedCase{"ridged", 100, 37, {{"block_cells", "16"}}},
    ClosedCase{"ridged", 2, 2, {{"block_cells", "1"}}},
    ClosedCase{"ridged", 131, 258, {{"block_cells", "37"}}},
    ClosedCase{"bump", 77, 40, {{"block_cells", "16"}}},
    ClosedCase{"step", 67, 66, {{"block_cells", "8"}}},
    ClosedCase{"ridged", 257, 257, {{"metric", "edge_length"}}},
    ClosedCase{
        "ridged", 257, 257, {{"error", "max"}, {"view_angle", "false"}, {"block_cells", "64"}}}};

}  // namespace lodbench::test
