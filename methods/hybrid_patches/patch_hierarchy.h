#pragma once
// The diamond graph of triangular patches, and the cut through it that a camera needs.
//
// Source: F. Loeffler, S. Schwanke, H. Schumann, "A Hybrid Approach for High Quality Real-Time
// Terrain Rendering and Optimized A-Priori Error Estimation", 2010, section 4.1. A patch is a
// triangle of longest-edge bisection (LEB); 2 m further bisections make its regular
// sub-triangulation, whose legs and longest edge have K = 2^m segments each. A patch and the one
// half as large across an edge have the same segments on it: a leg of the one is the longest edge
// of the other. So patches of a conforming cut fit together, and a cut of nested criteria conforms.
//
// Patch criterion. Patch T of depth d lacks the vertices from level d + 2 m on. It must be split
// where one of these is active, so it is split by the criterion of the vertex that splits it, with
// that vertex's own nested sphere, which holds the spheres of all its descendants, and with the
// largest error among the level-(d + 2 m) vertices of T and of its neighbour across the longest
// edge, raised to that of the vertex's children. Errors are saturated, so this bounds all deeper
// levels; and as error and sphere are nested, the criterion is too.

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <glm/vec2.hpp>
#include <string>
#include <utility>
#include <vector>

#include "api/error.h"
#include "common/leb_criterion.h"
#include "common/leb_grid.h"

namespace lodbench::hybrid_patches {

using common::LebGrid;
using common::LebVertex;
using common::LebView;
using common::Metric;
using common::Sample;

/// A LEB triangle: `left` and `right` end its longest edge; from above, left, right, apex run
/// anticlockwise.
struct Triangle {
    Sample left, apex, right;

    /// The sample that splits the longest edge.
    [[nodiscard]] Sample middle() const {
        return {(left.row + right.row) / 2, (left.column + right.column) / 2};
    }
    [[nodiscard]] std::array<Triangle, 2> halves() const {
        const Sample m = middle();
        return {{{apex, m, left}, {right, m, apex}}};
    }
};

struct Patch {
    Triangle triangle;
    float low = 0, high = 0;  ///< metres: heights of all samples in the triangle
};

/// Patches are numbered by depth, the halves of patch p being 2 p + 4 and 2 p + 5; 0 to 3 are the
/// triangles around the grid's centre.
class PatchHierarchy {
public:
    /// `grid` has its errors and outlives this. `segments` is K, a power of two from 2 on; `rows`
    /// and `columns` are the terrain's, without padding.
    PatchHierarchy(const LebGrid& grid, int segments, int rows, int columns)
        : grid_(grid), segments_(segments), rows_(rows), columns_(columns) {
        const int full_depth = full_depth_of(grid.size());
        const int levels = levels_of(segments);
        deepest_ = std::max(0, full_depth - levels);
        levels_ = std::min(levels, full_depth);
        make_triangles();
        find_height_ranges();
        find_errors();
    }

    /// Patches beyond this many would take more memory than the terrain does: at 152 bytes each,
    /// hybrid-patches' largest share, 2.4 GiB.
    static constexpr std::uint64_t kMostPatches = std::uint64_t(1) << 24;

    /// Of a terrain of this size, which may be larger than a grid can be.
    [[nodiscard]] static std::uint64_t count_of(const TerrainInfo& info, int segments) {
        const int deepest =
            std::max(0, full_depth_of(std::max(info.rows, info.columns)) - levels_of(segments));
        return 4 * ((std::uint64_t(2) << deepest) - 1);
    }
    /// Throws InputError for more than kMostPatches.
    static void require_few(const TerrainInfo& info, int segments) {
        const std::uint64_t count = count_of(info, segments);
        if (count <= kMostPatches) return;
        throw InputError("terrain '" + info.name + "' has " + std::to_string(count) +
                         " patches of " + std::to_string(segments + 1) +
                         " samples an edge, at most " + std::to_string(kMostPatches) +
                         " are taken: use a larger patch_samples");
    }

    [[nodiscard]] const Patch& patch(std::uint32_t number) const { return patches_[number]; }
    [[nodiscard]] std::size_t size() const { return patches_.size(); }
    [[nodiscard]] int segments() const { return segments_; }
    /// Bisections from a patch to its regular sub-triangulation: 2 m, less where the grid has
    /// fewer.
    [[nodiscard]] int levels() const { return levels_; }
    [[nodiscard]] int deepest() const { return deepest_; }
    [[nodiscard]] static int depth_of(std::uint32_t number) {
        int depth = 0;
        while (number >= first_of(depth + 1)) ++depth;
        return depth;
    }
    /// What `split` tests at the vertex that splits a patch: height, patch error, radius.
    [[nodiscard]] const LebVertex& criterion_vertex(Sample vertex) const {
        return vertices_[index(vertex)];
    }

    /// Numbers of the patches to draw, in the order of the hierarchy. `culling` leaves out those
    /// that are wholly out of view or wholly in the padding; it changes no other patch.
    void select(const LebView& view, Metric metric, bool culling,
                std::vector<std::uint32_t>& selected) const {
        selected.clear();
        const unsigned planes = culling ? common::kAllPlanes : 0;
        for (std::uint32_t root = 0; root < 4; ++root) {
            if (metric == Metric::planar) {
                visit(common::LebCriterion<Metric::planar>(view), view, root, culling, planes,
                      selected);
            } else {
                visit(common::LebCriterion<Metric::euclidean>(view), view, root, culling, planes,
                      selected);
            }
        }
    }

    /// Distance in metres from the eye of `view` to the farthest point of the patch's box.
    [[nodiscard]] double farthest(std::uint32_t number, const LebView& view) const {
        const Box box = box_of(patches_[number], view);
        const glm::dvec3 far = glm::max(glm::abs(box.low), glm::abs(box.high));
        return std::sqrt(far.x * far.x + far.y * far.y + far.z * far.z);
    }

private:
    struct Box {
        glm::dvec3 low, high;  ///< relative to the eye
    };

    /// Depth of the triangles of full resolution; a side has 2^n + 1 samples, or is padded to that.
    [[nodiscard]] static int full_depth_of(int samples_a_side) {
        int doublings = 1;
        while ((std::int64_t(1) << doublings) < samples_a_side - 1) ++doublings;
        return 2 * doublings - 1;
    }
    /// Bisections that make `segments` segments on each edge.
    [[nodiscard]] static int levels_of(int segments) {
        int halvings = 0;
        while ((1 << halvings) < segments) ++halvings;
        return 2 * halvings;
    }
    [[nodiscard]] static constexpr std::uint32_t first_of(int depth) {
        return 4 * ((std::uint32_t(1) << depth) - 1);
    }
    [[nodiscard]] std::size_t index(Sample vertex) const {
        return std::size_t(vertex.row / vertex_step_) * std::size_t(vertex_size_) +
               std::size_t(vertex.column / vertex_step_);
    }

    void make_triangles() {
        patches_.resize(first_of(deepest_ + 1));
        const int last = grid_.size() - 1;
        const Sample centre{last / 2, last / 2};
        const Sample corners[4] = {{last, 0}, {last, last}, {0, last}, {0, 0}};  // anticlockwise
        for (std::size_t i = 0; i < 4; ++i) {
            patches_[i].triangle = {corners[i], centre, corners[(i + 1) % 4]};
        }
        for (std::uint32_t i = 0; i < first_of(deepest_); ++i) {
            const auto halves = patches_[i].triangle.halves();
            patches_[2 * i + 4].triangle = halves[0];
            patches_[2 * i + 5].triangle = halves[1];
        }
    }

    void find_height_ranges() {
        const std::uint32_t first = first_of(deepest_);
        tbb::parallel_for(first, std::uint32_t(patches_.size()), [&](std::uint32_t i) {
            Patch& patch = patches_[i];
            patch.low = patch.high = grid_.at(patch.triangle.apex).height;
            for_each_run(patch.triangle, [&](int row, int from, int to) {
                for (const LebVertex* v = &grid_.at({row, from}); from <= to; ++from, ++v) {
                    patch.low = std::min(patch.low, v->height);
                    patch.high = std::max(patch.high, v->height);
                }
            });
        });
        for (std::uint32_t i = first; i-- > 0;) {
            const Patch& a = patches_[2 * i + 4];
            const Patch& b = patches_[2 * i + 5];
            patches_[i].low = std::min(a.low, b.low);
            patches_[i].high = std::max(a.high, b.high);
        }
    }

    /// Calls run(row, first column, last column) for the rows of a triangle, borders included. Its
    /// sides are level, upright or at 45 degrees, so that they meet rows in samples.
    template <typename Run>
    static void for_each_run(const Triangle& t, const Run& run) {
        const std::array<std::pair<Sample, Sample>, 3> sides = {
            {{t.left, t.apex}, {t.apex, t.right}, {t.right, t.left}}};
        const auto [top, bottom] = std::minmax({t.left.row, t.apex.row, t.right.row});
        for (int row = top; row <= bottom; ++row) {
            int from = std::max({t.left.column, t.apex.column, t.right.column});
            int to = std::min({t.left.column, t.apex.column, t.right.column});
            const auto include = [&](int column) {
                from = std::min(from, column);
                to = std::max(to, column);
            };
            for (const auto& [a, b] : sides) {
                if (a.row == b.row) {
                    if (a.row != row) continue;
                    include(a.column);
                    include(b.column);
                } else if ((row - a.row) * std::int64_t(row - b.row) <= 0) {
                    const int direction = (b.column - a.column) / (b.row - a.row);  // -1, 0 or 1
                    include(a.column + direction * (row - a.row));
                }
            }
            run(row, from, to);
        }
    }

    /// Largest error of the vertices of level depth + 2 m in the patch: those at the middle of the
    /// cells between its legs' segments.
    [[nodiscard]] float error_of(const Triangle& t) const {
        const Sample left{t.left.row - t.apex.row, t.left.column - t.apex.column};
        const Sample right{t.right.row - t.apex.row, t.right.column - t.apex.column};
        float error = 0;
        for (int a = 1; a < 2 * segments_; a += 2) {
            for (int b = 1; a + b <= 2 * segments_; b += 2) {
                const Sample vertex{
                    t.apex.row + (a * left.row + b * right.row) / (2 * segments_),
                    t.apex.column + (a * left.column + b * right.column) / (2 * segments_)};
                error = std::max(error, grid_.at(vertex).error);
            }
        }
        return error;
    }

    void find_errors() {
        // The smallest step among the vertices that split patches.
        const std::uint32_t splittable = first_of(deepest_);
        vertex_step_ = common::step_of(patches_[std::max(splittable, 1U) - 1].triangle.middle());
        for (std::uint32_t i = 0; i < splittable; ++i) {
            vertex_step_ = std::min(vertex_step_, common::step_of(patches_[i].triangle.middle()));
        }
        vertex_size_ = (grid_.size() - 1) / vertex_step_ + 1;
        vertices_.resize(std::size_t(vertex_size_) * std::size_t(vertex_size_));
        std::vector<float> errors(splittable);
        tbb::parallel_for(std::uint32_t(0), splittable,
                          [&](std::uint32_t i) { errors[i] = error_of(patches_[i].triangle); });
        // From the deepest to the roots: a vertex's children come before it.
        for (std::uint32_t i = splittable; i-- > 0;) {
            const Sample middle = patches_[i].triangle.middle();
            LebVertex& vertex = vertices_[index(middle)];
            vertex.height = grid_.at(middle).height;
            vertex.radius = grid_.at(middle).radius;
            vertex.error = std::max(vertex.error, errors[i]);
            const common::Children below = common::children(middle);
            for (int c = 0; c < below.count; ++c) {
                const Sample child = below.vertices[std::size_t(c)];
                if (!grid_.contains(child) || common::step_of(child) < vertex_step_) continue;
                vertex.error = std::max(vertex.error, vertices_[index(child)].error);
            }
        }
    }

    [[nodiscard]] static Box box_of(const Patch& patch, const LebView& view) {
        const Triangle& t = patch.triangle;
        const auto [west, east] = std::minmax({t.left.column, t.apex.column, t.right.column});
        const auto [north, south] = std::minmax({t.left.row, t.apex.row, t.right.row});
        return {{view.north_west.x + west * view.spacing.x,
                 view.north_west.y - south * view.spacing.y, double(patch.low) - view.eye_height},
                {view.north_west.x + east * view.spacing.x,
                 view.north_west.y - north * view.spacing.y, double(patch.high) - view.eye_height}};
    }

    /// Whether any of the box may be in view; clears the planes that have all of it inside.
    [[nodiscard]] static bool in_view(const Box& box, const LebView& view, unsigned& planes) {
        const glm::dvec3 centre = 0.5 * (box.low + box.high);
        const glm::dvec3 half = 0.5 * (box.high - box.low);
        for (unsigned i = 0; i < view.planes.size(); ++i) {
            if ((planes & (1U << i)) == 0) continue;
            const glm::dvec4& plane = view.planes[i];
            const double inside =
                plane.x * centre.x + plane.y * centre.y + plane.z * centre.z + plane.w;
            // What is drawn is rounded to float, 2^-24 of its distance a few times over.
            const double reach = std::abs(plane.x) * half.x + std::abs(plane.y) * half.y +
                                 std::abs(plane.z) * half.z +
                                 0x1p-20 * (std::abs(centre.x) + std::abs(centre.y) +
                                            std::abs(centre.z) + half.x + half.y + half.z);
            if (inside < -reach) return false;
            if (inside >= reach) planes &= ~(1U << i);
        }
        return true;
    }

    [[nodiscard]] bool in_padding(const Triangle& t) const {
        return std::min({t.left.row, t.apex.row, t.right.row}) >= rows_ - 1 ||
               std::min({t.left.column, t.apex.column, t.right.column}) >= columns_ - 1;
    }

    template <typename Criterion>
    void visit(const Criterion& criterion, const LebView& view, std::uint32_t number, bool culling,
               unsigned planes, std::vector<std::uint32_t>& selected) const {
        const Patch& patch = patches_[number];
        if (culling && in_padding(patch.triangle)) return;
        if (planes != 0 && !in_view(box_of(patch, view), view, planes)) return;
        if (number < first_of(deepest_)) {
            const Sample middle = patch.triangle.middle();
            unsigned none = 0;
            if (criterion.active(vertices_[index(middle)], middle.row, middle.column, none)) {
                visit(criterion, view, 2 * number + 4, culling, planes, selected);
                visit(criterion, view, 2 * number + 5, culling, planes, selected);
                return;
            }
        }
        selected.push_back(number);
    }

    const LebGrid& grid_;
    int segments_;
    int rows_, columns_;
    int deepest_ = 0;
    int levels_ = 0;
    std::vector<Patch> patches_;
    int vertex_step_ = 1;
    int vertex_size_ = 0;
    std::vector<LebVertex> vertices_;  ///< every vertex_step_-th sample; those that split patches
};

}  // namespace lodbench::hybrid_patches
