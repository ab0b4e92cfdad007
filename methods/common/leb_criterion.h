#pragma once
// Whether a vertex is active for a camera: the screen-space criterion and the view frustum.
//
// Euclidean (Lindstrom & Pascucci 2002): lambda error > tau (|p - e| - radius), tested as
//     scale * error + radius > |p - e|,  scale = lambda / tau,  both sides squared:
// no division, and a viewpoint inside the sphere makes the vertex active by itself. An error of 0
// means that everything below lies in the plane of the coarser triangle: never active.
//
// Planar (absent from the paper): a segment of length d with both ends at depth >= D in front of
// the image plane, one end in view, is drawn at most lambda d sec(theta) / D pixels long, theta the
// angle of the image's corner. The ends, true and drawn, of what the vertex's absence moves lie
// within radius + error of p, so D = depth - radius - error, and the vertex is active when
//     lambda sec(theta) error > tau D,  tested as  (scale + 1) * error + radius > depth.
// With accumulated errors this bounds the screen error of every sample in view by tau.
//
// Nesting. In exact numbers both criteria are nested, because errors are saturated and spheres hold
// their children's spheres. The arithmetic is double, and stored radii exceed the exact ones by
// 2^-25 of themselves, so rounding (2^-50 of the distance) cannot undo it while the distance is
// less than 2^24 times the spacing. All is computed from the vertex's row and column, never along
// the path, so that both triangles of a vertex see the same bits.

#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/camera.h"
#include "common/leb_errors.h"

namespace lodbench::common {

enum class Metric { euclidean, planar };

/// What the criteria take from a camera and a grid.
struct LebView {
    glm::dvec2 north_west{0.0};  ///< vertex (0, 0) relative to the eye, metres
    glm::dvec2 spacing{1.0};
    double eye_height = 0;
    double scale = 0;  ///< lambda / tau, times the secant of the image's corner where planar
    double cull_margin = 0;
    glm::dvec3 forward{0, 0, -1};
    std::array<glm::dvec4, 5> planes{};  ///< inward, relative to the eye

    /// `tau` > 0 in pixels. `leaf_edge` as from longest_leaf_edge().
    LebView(const LebGrid& grid, const Camera& camera, double tau, Metric metric, double leaf_edge)
        : north_west(grid.north_west() - glm::dvec2(camera.position)),
          spacing(grid.spacing()),
          eye_height(camera.position.z),
          scale(camera.lambda() / tau),
          cull_margin(leaf_edge),
          forward(camera.forward()),
          planes(camera.frustum_planes()) {
        if (metric == Metric::planar) {
            const glm::dvec2 corner = camera.half_tangents();
            scale *= std::sqrt(1 + corner.x * corner.x + corner.y * corner.y);
        }
    }
};

/// Both sides of the criterion's comparison at a vertex, for all who decide by it.
template <Metric metric>
struct LebComparison {
    double x, y, z;  ///< of the vertex, relative to the eye, metres
    double error;
    double reach;  ///< the vertex is active while the eye is nearer than this, metres
    double away;   ///< planar: depth, metres; Euclidean: distance squared

    LebComparison(const LebView& view, const LebVertex& vertex, int row, int column)
        : x(view.north_west.x + column * view.spacing.x),
          y(view.north_west.y - row * view.spacing.y),
          z(double(vertex.height) - view.eye_height),
          error(vertex.error) {
        if constexpr (metric == Metric::euclidean) {
            reach = view.scale * error + double(vertex.radius);
            away = x * x + y * y + z * z;
        } else {
            reach = (view.scale + 1) * error + double(vertex.radius);
            away = view.forward.x * x + view.forward.y * y + view.forward.z * z;
        }
    }
    [[nodiscard]] bool active() const {
        if constexpr (metric == Metric::euclidean) {
            return reach * reach > away && error > 0;
        } else {
            return reach > away && error > 0;
        }
    }
};

/// All frustum planes still to be tested.
inline constexpr unsigned kAllPlanes = (1U << 5) - 1;

/// Criterion of LebStripBuilder. `planes` are the planes that cut the parent's ball; 0 culls
/// nothing.
///
/// Culling makes vertices inactive, it never removes triangles: the mesh outside the picture is
/// coarse but whole. Vertex i may be dropped when nothing that it refines is in view. The spheres
/// hold its descendants, not the corners of its diamond; but every point of the full-resolution
/// surface over the diamond lies in a leaf triangle whose apex is i or a descendant, so within the
/// longest leaf edge of one. And what is drawn instead lies up to `error` above or below. Hence the
/// ball of radius + error + longest leaf edge: constant plus nested, so nested again. A plane that
/// has the ball wholly inside is not tested below: its children's balls are inside too, by at least
/// twice the leaf edge, which no rounding bridges.
template <Metric metric>
class LebCriterion {
public:
    explicit LebCriterion(const LebView& view) : view_(view) {}

    [[nodiscard]] bool active(const LebVertex& vertex, int row, int column,
                              unsigned& planes) const {
        const LebComparison<metric> compared(view_, vertex, row, column);
        if (!compared.active()) return false;
        if (planes == 0) return true;
        return in_view({compared.x, compared.y, compared.z},
                       double(vertex.radius) + compared.error + view_.cull_margin, planes);
    }

private:
    [[nodiscard]] bool in_view(const glm::dvec3& centre, double radius, unsigned& planes) const {
        for (unsigned i = 0; i < view_.planes.size(); ++i) {
            if ((planes & (1U << i)) == 0) continue;
            const glm::dvec4& plane = view_.planes[i];
            const double inside =
                plane.x * centre.x + plane.y * centre.y + plane.z * centre.z + plane.w;
            if (inside < -radius) return false;
            if (inside >= radius) planes &= ~(1U << i);
        }
        return true;
    }

    const LebView& view_;
};

}  // namespace lodbench::common
