#pragma once
// A-priori refinement criteria per vertex: saturated object-space errors and nested radii.
//
//   delta_i  = | z_i - (z_left + z_right) / 2 |        over the edge that vertex i splits
//   midpoint:     error_i = max(delta_i, error of children)      Lindstrom & Pascucci 2002
//   accumulated:  error_i = delta_i + max(error of children)     absent from the paper; it bounds
//                 the surface at every sample, which the midpoint form does not
//   radius_i = max over children (|p_i - p_c| + radius_c), 0 at leaves
//
// Both triangles of a vertex share its split edge, so delta is one number; a vertex on the border
// has one triangle and at most two children.
//
// Stored as float, rounded up: each result is computed in double, enlarged by 2^-23 of itself and
// rounded to nearest (which takes at most 2^-24 back), so that what is stored exceeds the exact
// value by 2^-25 of it at least, and by 2^-22 at most. Hence error_i >= delta_i (and >= delta_i +
// child where accumulated) and radius_i >= |p_i - p_c| + radius_c hold for the stored floats,
// strictly where the right side is positive; zero stays zero, so a plane costs nothing. The sum of
// two heights is exact in double unless they differ by a factor of 2^29 or more.

#include "common/leb_grid.h"

namespace lodbench::common {

enum class ErrorKind { midpoint, accumulated };

/// Smallest enlargement that survives the rounding to float; see above. `value` >= 0.
[[nodiscard]] inline float stored_above(double value) {
    return static_cast<float>(value * (1 + 0x1p-23));
}

// Three ways to the same bits (Loeffler 2010, section 3 and table 1). A level needs the finished
// one below it and nothing of its own.

/// ppcs: the paper's level-by-level scheme, at the speed of memory. The levels follow each other
/// row by row in one pass over the grid, a level's row as soon as the rows that it needs are there,
/// so that several levels find theirs in the cache; bands of rows in parallel; vector code.
void compute_errors_by_level(LebGrid& grid, ErrorKind kind);

/// ppcs as the paper states it: one pass a level, each vertex by itself, a level's rows in
/// parallel. The readable form, and the oracle of the above.
void compute_errors_by_level_plain(LebGrid& grid, ErrorKind kind);

/// rpcs: recursion over the vertex graph, the paper's comparator. Its depth is the number of
/// levels.
void compute_errors_recursively(LebGrid& grid, ErrorKind kind);

/// Upper bound of the length, in metres and in space, of every edge of the full-resolution mesh.
[[nodiscard]] double longest_leaf_edge(const LebGrid& grid);

}  // namespace lodbench::common
