#pragma once
// The auxiliary camera and the mapping of the persistent grid onto the base plane.
// Livny, Sokolovsky, Grinshpoun, El-Sana: Persistent Grid Mapping: A GPU-based Framework for
// Interactive Terrain Rendering (2006), sections 3.1 and 3.2.

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "api/camera.h"
#include "api/terrain.h"

namespace lodbench::persistent_grid {

/// The grid's resolution: vertices along each axis, both at least 2; and how its rows lie.
struct GridSize {
    int columns = 2;
    int rows = 2;
    /// Absent from the paper, which leaves the distribution open: row k of n lies at (k / (n -
    /// 1))^2 of the way down, closer to its neighbours the nearer it is to the horizon.
    bool denser_at_horizon = false;

    /// Of the way from the horizon to the bottom.
    [[nodiscard]] double way_down(int row) const {
        const double t = double(row) / (rows - 1);
        return denser_at_horizon ? t * t : t;
    }
};

/// The rays of the grid's vertices and the plane that they meet. The ray of vertex (column i, row
/// j) is first + i / (columns - 1) across + j / (rows - 1) down; it always points downward, and row
/// 0 is the one nearest to the horizon. Metres; directions in the world's axes.
struct Mapping {
    glm::dvec3 first{0.0};
    glm::dvec3 across{0.0};
    glm::dvec3 down{0.0};
    double eye_height = 1;    ///< of the viewpoint above the base plane, > 0
    double far_distance = 1;  ///< horizontal; no place of the terrain is farther from the viewpoint
    double ray_angle = 0;     ///< alpha of (3): radians between the rays of adjacent rows
    double pitch = 0;         ///< A_aux of (2): radians below the horizon
    bool restricted = false;  ///< the auxiliary camera differs from the main one

    [[nodiscard]] glm::dvec3 ray(double i, double j) const { return first + i * across + j * down; }
};

/// How far the grid reaches beyond the picture.
struct Coverage {
    double margin = 0;   ///< part of the picture, on each axis (0.05: 5 % wider and higher)
    bool extend = true;  ///< the vertical field of view is 90 degrees at least
};

/// The auxiliary camera. `base` is the height of the base plane.
///
/// (2)  A_aux = max(A_main, FOV / 2 + epsilon), with the FOV extended to 90 degrees where asked.
///
/// What the paper leaves open:
/// - The field of view is extended whatever the pitch, so that the mapping does not jump as the
///   camera tilts, and along the picture's vertical only: that reaches the ground below the eye.
/// - As long as no ray comes near the horizon, and (2) leaves the pitch alone, the auxiliary camera
///   is the main one, its roll included. Otherwise it does not roll: it takes in the upright
///   rectangle around the rolled picture.
/// - A tilted camera sees the far ground narrower: its horizontal field of view is widened to take
///   in, at the lowest elevation that both share (where the ratio is greatest), all that the main
///   one sees.
/// - epsilon is 1e-4, or less where the terrain reaches farther than that ray would.
/// - On or under the plane the viewpoint is taken to be one near-plane distance above it.
inline Mapping make_mapping(const Camera& camera, const TerrainInfo& terrain, double base,
                            const Coverage& coverage, const GridSize& grid) {
    constexpr double kEpsilon = 1e-4;
    // A rolled frustum this close to the horizon is handled by the upright camera, whose rays'
    // slopes are sums of one sign in the shader and so keep their sign in float.
    constexpr double kHorizonGuard = 1e-3;
    Mapping mapping;
    mapping.eye_height = std::max(camera.position.z - base, camera.near_plane);
    const glm::dvec2 eye(camera.position);
    const glm::dvec2 to_corner =
        glm::max(glm::abs(terrain.extent_min() - eye), glm::abs(terrain.extent_max() - eye));
    mapping.far_distance = glm::length(to_corner) + std::max(terrain.spacing.x, terrain.spacing.y);

    const glm::dvec3 forward = camera.forward(), right = camera.right(), up = camera.up();
    const glm::dvec2 picture = camera.half_tangents() * (1 + coverage.margin);
    // tan 45 degrees and the margin.
    const double smallest_vertical = coverage.extend ? 1 + coverage.margin : 0;
    glm::dvec2 tangents(picture.x, std::max(picture.y, smallest_vertical));
    const double highest_slope =
        forward.z + tangents.x * std::abs(right.z) + tangents.y * std::abs(up.z);
    const double corner_length = std::sqrt(1 + glm::dot(tangents, tangents));
    const double main_pitch = std::atan2(-forward.z, std::hypot(forward.x, forward.y));

    // The second condition matters to a rolled camera alone, whose picture's vertical is not the
    // world's.
    if (highest_slope <= -kHorizonGuard * corner_length && main_pitch >= std::atan(tangents.y)) {
        mapping.pitch = main_pitch;
        mapping.first = forward - tangents.x * right + tangents.y * up;
        mapping.across = 2 * tangents.x * right;
        mapping.down = -2 * tangents.y * up;
    } else {
        mapping.restricted = true;
        glm::dvec3 level_right(forward.y, -forward.x, 0);
        // Straight up (or down, with a field of view near 180 degrees): the picture's own right
        // decides.
        if (glm::length(level_right) < 1e-9) level_right = {right.x, right.y, 0};
        level_right = glm::normalize(level_right);
        const glm::dvec3 ahead(-level_right.y, level_right.x, 0);
        const double cos_roll = std::abs(glm::dot(right, level_right));
        const double sin_roll = std::abs(glm::dot(up, level_right));
        const glm::dvec2 upright(picture.x * cos_roll + picture.y * sin_roll,
                                 picture.x * sin_roll + picture.y * cos_roll);
        tangents = {upright.x, std::max(upright.y, smallest_vertical)};

        const double epsilon = std::min(kEpsilon, mapping.eye_height / (2 * mapping.far_distance));
        const double half_fov = std::atan(tangents.y);
        constexpr double kStraightDown = 1.5707963267948966;
        mapping.pitch = std::min(std::max(main_pitch, half_fov + epsilon), kStraightDown);
        // The width of the horizon is what an upward camera needs of the ground.
        const double level_pitch = std::max(main_pitch, 0.0);
        const double shared = std::max(epsilon, level_pitch - std::atan(upright.y));
        tangents.x *=
            std::max(1.0, std::cos(shared - level_pitch) / std::cos(shared - mapping.pitch));

        const double sine = std::sin(mapping.pitch), cosine = std::cos(mapping.pitch);
        const glm::dvec3 aux_up = sine * ahead + glm::dvec3(0, 0, cosine);
        mapping.first = (cosine + tangents.y * sine) * ahead - tangents.x * level_right;
        // -sin A + tan(FOV / 2) cos A, without the cancellation.
        mapping.first.z = -std::sin(mapping.pitch - half_fov) / std::cos(half_fov);
        mapping.across = 2 * tangents.x * level_right;
        mapping.down = -2 * tangents.y * aux_up;
    }
    // Figure 9 has ray beta and the adjacent one, beta + alpha: radial, hence the rows' step alone.
    const double steepest = 1.5;  // radians: keeps cos(alpha) positive on the coarsest grids
    mapping.ray_angle = std::min(steepest, 2 * std::atan(tangents.y) / (grid.rows - 1));
    return mapping;
}

/// Where a ray meets the base plane, horizontally relative to the viewpoint: equation (1), as the
/// shader has it. Beyond the terrain's farthest place D the distance q is compressed to D (2 - D /
/// q): finite for every ray, exact wherever there is terrain, and growing all the way, so that no
/// triangle folds over.
inline glm::dvec2 ground_point(const Mapping& mapping, const glm::dvec3& ray) {
    const glm::dvec2 horizontal(ray);
    const double distance = glm::length(horizontal) * mapping.eye_height / -ray.z;
    if (distance <= mapping.far_distance) return horizontal * (mapping.eye_height / -ray.z);
    const double compressed = mapping.far_distance * (2 - mapping.far_distance / distance);
    return horizontal * (compressed / glm::length(horizontal));
}

/// r of section 3.4 by its definition: the distance, on the base plane, between vertex (column,
/// row) and the farthest of the four that are next to it in its row and its column.
inline double farthest_neighbour(const Mapping& mapping, const GridSize& grid, int column,
                                 int row) {
    const auto ground = [&](int i, int j) {
        return ground_point(mapping, mapping.ray(double(i) / (grid.columns - 1), grid.way_down(j)));
    };
    const glm::dvec2 here = ground(column, row);
    double farthest = 0;
    for (const glm::ivec2 step : {glm::ivec2(0, -1), {-1, 0}, {1, 0}, {0, 1}}) {
        const int i = column + step.x, j = row + step.y;
        if (i < 0 || j < 0 || i >= grid.columns || j >= grid.rows) continue;
        farthest = std::max(farthest, glm::length(ground(i, j) - here));
    }
    return farthest;
}

/// r of (3), which stands for it "for efficiency": q is the distance to the viewpoint on the plane.
/// Infinite where the next row's ray misses the plane.
inline double spacing_by_formula(const Mapping& mapping, double q) {
    const double h = mapping.eye_height;
    const double denominator = h * std::cos(mapping.ray_angle) - q * std::sin(mapping.ray_angle);
    if (denominator <= 0) return std::numeric_limits<double>::infinity();
    return (q * q + h * h) * std::sin(mapping.ray_angle) / denominator;
}

}  // namespace lodbench::persistent_grid
