#pragma once
// Draw calls of patches that software rasterisers draw rightly.

#include <GL/glcorearb.h>

#include <cstddef>

namespace lodbench::stitching_strips {

/// Mesa's software rasteriser (22.3) draws wrongly what one draw call tessellates into more than
/// 65,535 vertices, while its counters are right. 15 patches at the greatest factor are below it.
inline constexpr std::size_t kMostTessellatedVertices = 65'000;

/// Calls `draw(first, count)` for runs of the patches 0 to `patches` - 1 in their order, each run
/// as long as `vertices_of(patch)`, the vertices that a patch is tessellated into at most, lets it
/// be.
template <typename VerticesOf, typename Draw>
void draw_in_runs(int patches, const VerticesOf& vertices_of, const Draw& draw) {
    int first = 0;
    std::size_t vertices = 0;
    for (int patch = 0; patch < patches; ++patch) {
        const std::size_t more = vertices_of(patch);
        if (patch > first && vertices + more > kMostTessellatedVertices) {
            draw(GLint(first), GLsizei(patch - first));
            first = patch;
            vertices = 0;
        }
        vertices += more;
    }
    if (first < patches) draw(GLint(first), GLsizei(patches - first));
}

}  // namespace lodbench::stitching_strips
