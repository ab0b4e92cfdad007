#pragma once
// The strips of a frame (Zhang 2019, 3.2), and the squares between their ends (P-blocks): made by
// several threads, each of which writes into places of its own, so that the result does not depend
// on how many there are.

#include <tbb/task_arena.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/view_frustum.h"
#include "stitching_strips/block_cut.h"
#include "stitching_strips/stitching.h"

namespace lodbench::stitching_strips {

/// A vertex of a block's edge, which the GPU places as it does the block's own: no coordinates.
struct StripVertex {
    std::uint32_t leaf = 0;   ///< place in BlockCut::leaves
    std::uint32_t place = 0;  ///< edge + 4 * index along the edge, from the west or the south
    friend bool operator==(const StripVertex&, const StripVertex&) = default;
};
[[nodiscard]] constexpr std::uint32_t vertex_place(Edge edge, int index) {
    return std::uint32_t(edge) + 4 * std::uint32_t(index);
}

class StripBuilder {
public:
    /// `threads`: 0, or more than there are processors: as many as these.
    StripBuilder(const BlockTree& tree, int threads);

    /// Of all splits of the cut, or of what of them may be seen. Runs in three steps, which are
    /// timed apart.
    void build(const BlockCut& cut, const std::optional<common::ViewFrustum>& frustum);

    [[nodiscard]] std::span<const StripVertex> vertices() const { return vertices_; }
    /// Three for each triangle, anti-clockwise from above; the strips' first, then two triangles a
    /// P-block.
    [[nodiscard]] std::span<const std::uint32_t> indices() const { return indices_; }
    [[nodiscard]] std::size_t strip_triangles() const { return strip_triangles_; }
    [[nodiscard]] std::size_t strip_count() const { return strips_.size(); }
    [[nodiscard]] std::size_t patch_count() const { return patches_.size(); }  ///< P-blocks
    [[nodiscard]] std::size_t stretch_count() const { return stretches_.size(); }
    /// The vertices of a strip's left and right side, along it.
    struct SideVertices {
        std::size_t first = 0, count = 0;
    };
    [[nodiscard]] std::pair<SideVertices, SideVertices> sides(std::size_t strip) const {
        const Strip& found = strips_[strip];
        return {{found.first_vertex, found.middle_vertex - found.first_vertex},
                {found.middle_vertex, found.end_vertex - found.middle_vertex}};
    }
    /// Of the last `build`.
    struct Seconds {
        double listing = 0, vertices = 0, triangles = 0;
    };
    [[nodiscard]] const Seconds& seconds() const { return seconds_; }

private:
    /// Seen along a strip, to the north or to the east.
    enum Side : std::size_t { kLeft = 0, kRight = 1 };
    struct Strip {
        int number = 0;         ///< its own, which is also a block's
        bool northward = true;  ///< else eastward
        glm::ivec2 south_west{0}, north_east{0};
        std::size_t first_vertex = 0, middle_vertex = 0, end_vertex = 0;  ///< left; right; end
    };
    struct Part {
        std::size_t strip = 0, first_triangle = 0;
        Stretch stretch;
    };

    void list_edges();
    void list_strips(int block);
    [[nodiscard]] bool may_see(glm::ivec2 south_west, glm::ivec2 north_east) const;
    [[nodiscard]] Strip strip_between(int block, int number) const;
    /// Leaves along a side, from the south or the west.
    [[nodiscard]] std::span<const std::uint32_t> edges(int strip, Side side) const;
    void place_vertices();
    void place_side(const Strip& strip, Side side, std::size_t first);
    void cut_stretches();
    void cut_stretch(const Strip& strip, double begin, double end,
                     std::vector<Stretch>& stretches) const;
    void triangulate();
    void add_patches();
    [[nodiscard]] std::uint32_t corner_leaf(int block, int corner) const;
    [[nodiscard]] std::span<const double> along(std::size_t first, std::size_t end) const {
        return std::span(along_).subspan(first, end - first);
    }
    template <typename Work>
    void in_parallel(const Work& work);

    const BlockTree& tree_;
    std::unique_ptr<tbb::task_arena> arena_;  ///< none: the caller's
    const BlockCut* cut_ = nullptr;
    const std::optional<common::ViewFrustum>* frustum_ = nullptr;

    std::vector<std::uint32_t> edge_begin_;  ///< by split, strip and side: first of edge_leaves_
    std::vector<std::uint32_t> edge_leaves_;
    std::vector<Strip> strips_;
    std::vector<int> patches_;  ///< splits of which the P-block is drawn
    std::vector<StripVertex> vertices_;
    std::vector<double> along_;  ///< by vertex: its place along its strip, in cells
    std::vector<std::vector<Stretch>> stretches_by_strip_;
    std::vector<Part> stretches_;
    std::vector<std::uint32_t> indices_;
    std::size_t strip_triangles_ = 0;
    Seconds seconds_;
};

}  // namespace lodbench::stitching_strips
