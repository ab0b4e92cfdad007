#pragma once
// The one mesh that all blocks share: Yusuf, Mostafa, Elarif 2014, figure 3a.

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace lodbench::multi_context {

struct BlockMesh {
    std::vector<glm::vec3>
        vertices;  ///< x: column, z: row, y: edge of a skirt's lower vertex, or 0
    std::vector<std::uint32_t> indices;  ///< triangles
};

/// k x k vertices and 2 (k - 1)^2 triangles: 12 and 24 bytes each, as the paper counts them. Each
/// cell is cut from its north-west to its south-east sample, which is the edge ai of (1). `skirts`
/// adds 4 k vertices and 8 (k - 1) triangles. Cells are taken in bands of eight columns, so that a
/// vertex is reused while it is still in the vertex cache.
inline BlockMesh make_block_mesh(int k, bool skirts) {
    constexpr int kBand = 8;
    BlockMesh mesh;
    for (int row = 0; row < k; ++row) {
        for (int column = 0; column < k; ++column) mesh.vertices.emplace_back(column, 0, row);
    }
    const auto vertex = [k](int row, int column) { return std::uint32_t(row * k + column); };
    for (int band = 0; band < k - 1; band += kBand) {
        for (int row = 0; row < k - 1; ++row) {
            for (int column = band; column < std::min(band + kBand, k - 1); ++column) {
                const std::uint32_t nw = vertex(row, column), ne = vertex(row, column + 1);
                const std::uint32_t sw = vertex(row + 1, column), se = vertex(row + 1, column + 1);
                mesh.indices.insert(mesh.indices.end(), {nw, sw, se, nw, se, ne});
            }
        }
    }
    if (!skirts) return mesh;
    const auto add_skirt = [&](int edge, auto row_of, auto column_of) {
        const auto first = std::uint32_t(mesh.vertices.size());
        for (int i = 0; i < k; ++i) mesh.vertices.emplace_back(column_of(i), edge, row_of(i));
        for (int i = 0; i + 1 < k; ++i) {
            const std::uint32_t here = vertex(row_of(i), column_of(i));
            const std::uint32_t next = vertex(row_of(i + 1), column_of(i + 1));
            const std::uint32_t below = first + std::uint32_t(i);
            mesh.indices.insert(mesh.indices.end(),
                                {here, below, below + 1, here, below + 1, next});
        }
    };
    const auto along = [](int i) { return i; };
    const auto first = [](int) { return 0; };
    const auto last = [k](int) { return k - 1; };
    add_skirt(1, first, along);
    add_skirt(2, along, last);
    add_skirt(3, last, along);
    add_skirt(4, along, first);
    return mesh;
}

}  // namespace lodbench::multi_context
