#pragma once
// The regular sub-triangulation of a patch as triangles, each named by three vertices.
//
// Source: Loeffler et al. 2010, section 4.1 ("each precomputed patch triangle represents a regular
// sub-triangulation"). What is triangulated beforehand needs no strip: where the generalised strip
// of Lindstrom & Pascucci 2002 turns, it repeats a vertex, and two in five of its triangles have no
// area. Triangles follow each other as bisection finds them, so that neighbours share vertices that
// are still in the vertex cache.

#include <cstdint>
#include <vector>

#include "hybrid_patches/patch_hierarchy.h"
#include "hybrid_patches/patch_strip.h"

namespace lodbench::hybrid_patches {

/// Three of PatchNames a triangle, 2^levels triangles, facing up. `segments` is K, `levels` at most
/// 2 log2 K. The names are the same for every patch.
[[nodiscard]] inline std::vector<std::uint16_t> regular_triangles(const Triangle& patch,
                                                                  int segments, int levels) {
    const PatchNames names(patch, segments);
    std::vector<std::uint16_t> triangles;
    triangles.reserve(std::size_t(3) << levels);
    const auto bisect = [&](const auto& again, const Triangle& t, int left) -> void {
        if (left > 0) {
            for (const Triangle& half : t.halves()) again(again, half, left - 1);
            return;
        }
        for (const Sample vertex : {t.left, t.right, t.apex}) {
            triangles.push_back(names.of(vertex.row, vertex.column));
        }
    };
    bisect(bisect, patch, levels);
    return triangles;
}

}  // namespace lodbench::hybrid_patches
