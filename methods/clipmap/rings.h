#pragma once
// The geometry of nested rings: how large they are, where they stand, of which rectangles they
// consist. A. Asirvatham, H. Hoppe: Terrain Rendering Using GPU-Based Geometry Clipmaps (2005),
// section 2.3.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <vector>

#include "api/terrain.h"

namespace lodbench::clipmap {

/// A ring has n x n vertices, n = 4 m - 1; blocks have m x m. The paper's n are 2^k - 1, so that
/// textures are powers of two; nothing else needs them to be.
class RingSize {
public:
    static constexpr int kLeast = 15, kMost = 1023;

    /// `n` in [kLeast, kMost]; lowered to the next 4 m - 1.
    explicit RingSize(int n) : m_((n + 1) / 4) {}

    [[nodiscard]] int m() const { return m_; }
    [[nodiscard]] int n() const { return 4 * m_ - 1; }
    /// Steps of the level over which a ring goes over into the next coarser one: n / 10, rounded.
    [[nodiscard]] int blend_width() const { return std::max(1, (2 * n() + 10) / 20); }
    /// Steps from the viewer at which that begins; it ends one step before the outermost vertices
    /// of a ring that is centred on the viewer, so that they are coarse wherever the ring stands.
    [[nodiscard]] int blend_begin() const { return (n() - 1) / 2 - blend_width() - 1; }

    /// Triangles of `levels` >= 1 active levels, all drawn: a full square and rings around it.
    [[nodiscard]] std::int64_t triangle_count(int levels) const {
        const std::int64_t square = 2 * std::int64_t(n() - 1) * (n() - 1);
        const std::int64_t hole = 2 * std::int64_t(2 * m_ - 1) * (2 * m_ - 1);
        return square + (levels - 1) * (square - hole);
    }

private:
    int m_;
};

/// Levels of a clipmap over this terrain: the coarsest one covers all of it, wherever over the
/// terrain the viewer is.
[[nodiscard]] inline int level_count(const TerrainInfo& terrain, const RingSize& size) {
    const std::int64_t cells = std::max(terrain.rows, terrain.columns) - 1;
    int levels = 1;
    while (std::int64_t((size.n() - 1) / 2 - 1) << (levels - 1) < cells) ++levels;
    return levels;
}

/// The north-west vertices of all levels' squares, in steps of the level, for a viewer at `place`
/// (x: column, y: row of the grid). They are even, so that a square's border lies on the next
/// coarser level's vertices; the viewer is at most a step from its middle on each axis.
[[nodiscard]] inline std::vector<glm::ivec2> ring_origins(const glm::dvec2& place,
                                                          const RingSize& size, int levels) {
    const int half = (size.n() - 1) / 2;
    const glm::dvec2 nearest = glm::floor((place - double(half)) / 2.0 + 0.5);
    std::vector<glm::ivec2> origins{2 * glm::ivec2(nearest)};
    // A square lies m or m - 1 steps of the next level inside of that level's. Integers alone, from
    // the finest level on: no rounding can part two rings.
    while (int(origins.size()) < levels) {
        const glm::ivec2 beyond = origins.back() / 2 + size.m() + 1;
        origins.push_back(2 * glm::ivec2(beyond.x >> 1, beyond.y >> 1) - 2 * size.m());
    }
    return origins;
}

/// A rectangle of cells of a ring, in steps from the ring's north-west vertex.
struct Piece {
    glm::ivec2 corner{0}, cells{0};
    friend bool operator==(const Piece&, const Piece&) = default;
};

/// The full square of the finest active level: sixteen blocks, a cross two cells wide between them.
[[nodiscard]] inline std::vector<Piece> full_square(const RingSize& size) {
    const int m = size.m();
    const int cuts[] = {0, m - 1, 2 * m - 2, 2 * m, 3 * m - 1, 4 * m - 2};
    std::vector<Piece> pieces;
    for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < 5; ++x) {
            pieces.push_back({{cuts[x], cuts[y]}, {cuts[x + 1] - cuts[x], cuts[y + 1] - cuts[y]}});
        }
    }
    return pieces;
}

/// A ring around the next finer level's square, which begins `hole` (m - 1 or m on each axis) steps
/// from this one's: twelve blocks, four pieces of the fix-up, and the trim: an L one cell wide, in
/// one of four positions, as two pieces.
[[nodiscard]] inline std::vector<Piece> ring(const RingSize& size, glm::ivec2 hole) {
    const int m = size.m();
    std::vector<Piece> pieces = full_square(size);
    std::erase_if(pieces, [m](const Piece& piece) {
        return piece.corner.x >= m - 1 && piece.corner.y >= m - 1 && piece.corner.x < 3 * m - 1 &&
               piece.corner.y < 3 * m - 1;
    });
    const int column = hole.x == m ? m - 1 : 3 * m - 2;
    const int row = hole.y == m ? m - 1 : 3 * m - 2;
    pieces.push_back({{column, m - 1}, {1, 2 * m}});
    pieces.push_back({{hole.x, row}, {2 * m - 1, 1}});
    return pieces;
}

/// The sizes that pieces have.
[[nodiscard]] inline std::vector<glm::ivec2> piece_shapes(const RingSize& size) {
    const int m = size.m();
    return {{m - 1, m - 1}, {2, m - 1}, {m - 1, 2}, {2, 2}, {1, 2 * m}, {2 * m - 1, 1}};
}

}  // namespace lodbench::clipmap
