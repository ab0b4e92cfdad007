#pragma once
// The surface l_f(x, y) that a method really drew: its captured triangles, evaluated in double.
//
// A triangle covers a point (x, y) when the point lies in it or on its edges; where several cover
// it, the highest wins. Two triangles that share an edge leave no point of it uncovered. Vertices
// came through float32 relative to the eye: a point that no triangle covers but that lies within
// that rounding of one (see `kRoundingUnits`) is covered by it, at the height of its nearest point;
// of several such triangles the highest wins.
//
// Two kinds of triangle are not simply part of it; the rules stand at `DrawnSurface`:
// - *Slivers*, thinner in plan than that rounding: they have no inside to speak of, and cover only
// as
//   the neighbourhood of their outline.
// - *Steep* triangles below the rest are skirts: they belong to the picture, not to l_f.

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "api/terrain.h"
#include "measure/capture.h"
#include "measure/reference_terrain.h"
#include "measure/triangle_tree.h"

namespace lodbench::measure {

/// What becomes of a triangle. It is *steep* when it rises by more than `kSteepSlope` a metre, and
/// has *thickness* when its least altitude in plan exceeds the rounding of its vertices in plan.
/// - Not steep: part of l_f (a sliver, when it has no thickness).
/// - Steep, and nowhere above the rest: a skirt. The rest is l_f without the steep triangles that
/// have
///   thickness, or, for a triangle without thickness, all of l_f. It is asked at the corners, the
///   middles of the edges and the centroid, each moved to the nearest place within the extent.
///   Triangles that close a gap at a T-junction are skirts by this rule, and should be.
/// - Steep, not a skirt, with thickness: part of l_f, like the riser of a step or the sides of a
///   spike, which nothing else covers between their ends.
/// - Steep, not a skirt, without thickness: a wall. It stands above l_f but has no place in a
/// function
///   of (x, y).
/// All const functions may be called from several threads at once.
class DrawnSurface {
public:
    /// Horizontal distance, in units of 2^-24 times the largest horizontal coordinate (relative to
    /// the eye) of a triangle's vertices, within which its edges are uncertain: position, matrix
    /// and feedback round once each, and the two ends of an edge may round apart. Coordinates
    /// beyond the extent count as far as the extent's own: where an edge passes the extent, the
    /// rounding of its far end is scaled down with the distance.
    static constexpr double kRoundingUnits = 8;

    /// Metres a metre: no level of detail of a terrain is that steep over more than a few samples,
    /// and a skirt that leans outward by one in sixteen is still one.
    static constexpr double kSteepSlope = 16;

    /// Copies what it needs: 36 bytes a triangle and about 16 for the search; 16 more while it is
    /// built. Triangles without area or with a vertex that is not finite are dropped, and those
    /// outside the extent, which is all that can be asked about. `surface.vertices` is taken over
    /// by move.
    DrawnSurface(CapturedSurface&& surface, const TerrainInfo& info);

    /// l_f at a world position inside the extent; nothing where no triangle covers it.
    [[nodiscard]] std::optional<double> height(const glm::dvec2& position) const;

    /// How uncertain captured positions are, metres: see kRoundingUnits.
    struct Rounding {
        double plan = 0, height = 0;
    };
    /// `height`, and the greatest rounding among the triangles of l_f there; 0 where none covers
    /// it.
    struct Look {
        std::optional<double> height;
        Rounding rounding;
    };
    [[nodiscard]] Look look(const glm::dvec2& position) const;

    /// l_f - h in metres at every sample, row by row as `heights`: float32, so that its rounding is
    /// relative to the difference; NaN where no triangle covers the sample. Parallel; the same to
    /// the bit each time, and `height` minus h to the bit. Throws ContractError when a span's size
    /// is not rows * columns.
    void displacements(std::span<const float> heights, std::span<float> result) const;
    /// The same at the samples of a rectangle alone, not parallel. `heights`: of all samples.
    void displacements(std::span<const float> heights, const SampleRect& rect,
                       std::span<float> result) const;

    /// An interval that holds l_f wherever it is, metres: conservative. Low is above high where no
    /// triangle is.
    [[nodiscard]] HeightInterval bounds() const;
    /// What it takes, about.
    [[nodiscard]] std::size_t bytes() const {
        return surface_.bytes() + slivers_.bytes() + skirts_.bytes();
    }

    /// Whether the ray origin + t * direction is below l_f, strictly, for some t in [from, to];
    /// `from` is finite, `to` may be infinite. Exact, up to the rounding of double, against every
    /// triangle of l_f with thickness (a sliver has no inside to be below of); what is outside the
    /// extent does not count.
    [[nodiscard]] bool passes_below(const glm::dvec3& origin, const glm::dvec3& direction,
                                    double from, double to) const;

    /// The least t in [from, to] at which the ray meets a skirt; nothing when it meets none. A ray
    /// in the plane of a skirt does not meet it.
    [[nodiscard]] std::optional<double> meets_skirt(const glm::dvec3& origin,
                                                    const glm::dvec3& direction, double from,
                                                    double to) const;

    /// The least t in [from, to] at which the ray meets a triangle of l_f with thickness, from
    /// above or from below; nothing when it meets none.
    [[nodiscard]] std::optional<double> meets_surface(const glm::dvec3& origin,
                                                      const glm::dvec3& direction, double from,
                                                      double to) const;

    /// Of the triangles of l_f that come within a tangent of a ray's part in plan: what the
    /// precision of their picture depends on, metres.
    struct Reach {
        double largest = 0;  ///< coordinate of a corner, relative to the eye
        double nearest = std::numeric_limits<double>::infinity();  ///< depth of a corner
    };
    [[nodiscard]] Reach reach_beside(const glm::dvec3& origin, const glm::dvec3& direction,
                                     double from, double to, double radius,
                                     const glm::dvec3& forward) const;

    /// Whether a triangle of l_f that is seen thinner than the tangent `thickness` passes within
    /// the tangent `radius` of the ray's part [from, to], seen from its origin.
    [[nodiscard]] bool sliver_near(const glm::dvec3& origin, const glm::dvec3& direction,
                                   double from, double to, double radius, double thickness) const;

    /// Triangles that touch the extent, by what became of them.
    [[nodiscard]] std::uint64_t triangle_count() const {  ///< of l_f, slivers included
        return surface_.triangle_count() + slivers_.triangle_count();
    }
    [[nodiscard]] std::uint64_t skirt_triangle_count() const { return skirts_.triangle_count(); }
    [[nodiscard]] std::uint64_t wall_triangle_count() const { return wall_triangle_count_; }

private:
    struct Sorted;
    struct Tile;

    /// The rounding in plan of vertices, the largest coordinate among which is given.
    [[nodiscard]] double plan_rounding(double largest_coordinate) const;
    [[nodiscard]] double plan_rounding(const glm::vec3* corners) const;
    [[nodiscard]] bool touches_extent(const glm::vec3* corners) const;
    [[nodiscard]] Sorted sort_by_kind(std::vector<glm::vec3>&& vertices) const;
    /// For each steep triangle whether it is a skirt beside what the trees hold now. Parallel.
    [[nodiscard]] std::vector<char> below_surface(std::span<const glm::vec3> steep) const;
    [[nodiscard]] bool is_below_surface(const glm::vec3* corners) const;

    // The following are relative to origin_; "nothing" is minus infinity.
    [[nodiscard]] double relative_height(const glm::dvec2& point) const;
    /// A rectangle with the rounding of any triangle around it.
    [[nodiscard]] PlanBox around(const glm::dvec2& low, const glm::dvec2& high) const;
    /// `height` from what was found covering a point, or near it where nothing does.
    [[nodiscard]] std::optional<double> world_height(double relative) const;
    /// Of the triangles within whose rounding a point lies.
    [[nodiscard]] double nearby_height(const glm::dvec2& point) const;
    /// Whether a triangle's box comes within its rounding of the rectangle: if not, nothing covers
    /// any point of it.
    [[nodiscard]] bool anything_near(const glm::dvec2& low, const glm::dvec2& high) const;
    /// Calls `visit(corners)` for the triangles of l_f whose box in plan comes within the tangent
    /// `radius` of a ray's part, relative to origin_, until it returns true.
    template <typename Visit>
    [[nodiscard]] bool any_beside(const glm::dvec3& start, const glm::dvec3& direction, double from,
                                  double to, double radius, const Visit& visit) const;
    [[nodiscard]] std::optional<double> least_meeting(const TriangleTree& tree,
                                                      const glm::dvec2& low, const glm::dvec2& high,
                                                      const glm::dvec3& origin,
                                                      const glm::dvec3& direction, double from,
                                                      double to) const;
    [[nodiscard]] std::size_t sample_index(int row, int column) const;
    /// Of a rectangle's samples, rows `stride` apart.
    void write_displacements(std::span<const float> heights, const SampleRect& rect, float* result,
                             std::size_t stride) const;
    void draw_triangles(Tile& tile) const;
    void draw_neighbourhoods(Tile& tile) const;  ///< where no triangle was drawn

    TerrainInfo info_;
    glm::dvec3 origin_;
    glm::dvec2 low_, high_;                                    ///< the extent
    double lowest_ = std::numeric_limits<double>::infinity();  ///< z of a corner of l_f
    double highest_ = -std::numeric_limits<double>::infinity();
    double reach_;          ///< largest coordinate of the extent
    TriangleTree surface_;  ///< with thickness
    TriangleTree slivers_;
    TriangleTree skirts_;
    glm::dvec2 skirts_low_{0.0}, skirts_high_{0.0};  ///< box of the skirts and the eye, in plan
    std::uint64_t wall_triangle_count_ = 0;
};

}  // namespace lodbench::measure
