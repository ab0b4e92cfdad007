#pragma once
// The arithmetic of ppcs for a whole row of diamonds at a time: straight loops over arrays without
// gaps, which the compiler turns into vector code, once for each instruction set; chosen when the
// program runs. Each operation is one of IEEE 754 in the order of the plain form, none is fused, so
// that every instruction set gives the same bits.

#include <cstddef>

#include "common/leb_errors.h"

namespace lodbench::common {

/// Height, error and radius of vertices that lie side by side, metres.
struct VertexRow {
    float* height;
    float* error;
    float* radius;
};

/// The vertices to be computed and the two ends of the edge that each splits.
struct SplitRow {
    VertexRow vertex;
    const float* end_a;
    const float* end_b;
};

struct RowKernels {
    const char* instruction_set;

    /// even[0..pairs], odd[0..pairs) from 2 * pairs + 1 heights, `stride` floats apart.
    void (*split)(const float* in, std::ptrdiff_t stride, int pairs, float* even, float* odd);

    /// error and radius of `count` leaves: vertices without children.
    void (*leaves)(const SplitRow& row, int count);

    /// `count` edge vertices, each with four children at the same horizontal distance.
    void (*edges)(ErrorKind kind, const SplitRow& row, const VertexRow (&child)[4],
                  double squared_distance, int count);

    /// `count` centres. `falling` is the row's first vertex's bias: whether it splits the diagonal
    /// from north-west to south-east; the next one splits the other, and so on in turn. `north` and
    /// `south` are the heights of the squares' corners, count + 1 each. Children: north, south,
    /// west, east; squared distances for the first two and the last two.
    void (*centres)(ErrorKind kind, VertexRow centre, bool falling, const float* north,
                    const float* south, const VertexRow (&child)[4], double squared_y,
                    double squared_x, int count);

    /// The same where the children are leaves, whose radius is 0: the root is monotone, so that the
    /// largest square gives the largest distance, to the bit.
    void (*centres_of_leaves)(ErrorKind kind, VertexRow centre, bool falling, const float* north,
                              const float* south, const VertexRow (&child)[4], double squared_y,
                              double squared_x, int count);
};

/// The fastest that this processor runs.
[[nodiscard]] const RowKernels& row_kernels();

/// All that this processor runs, the plain one first; for tests.
struct RowKernelList {
    const RowKernels* kernels[3];
    int count;
};
[[nodiscard]] RowKernelList all_row_kernels();

}  // namespace lodbench::common
