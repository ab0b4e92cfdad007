#include "gl/frame_blocks.h"

#include <fmt/format.h>

#include <cfloat>
#include <cmath>

#include "api/error.h"

namespace lodbench::gl {

namespace {

// float(sample - eye_sample) is exact up to 2^24 apart.
constexpr double kSampleLimit = 16777216.0;

void check(const Camera& camera) {
    const glm::dvec3& eye = camera.position;
    if (!std::isfinite(eye.x) || !std::isfinite(eye.y) || !std::isfinite(eye.z)) {
        throw ContractError(fmt::format("camera position ({}, {}, {}): expected finite metres",
                                        eye.x, eye.y, eye.z));
    }
}

/// A border of the extent relative to the eye, moved outward (`direction` -1 or 1) so that no
/// vertex on the border is cut. A shader computes such a vertex as n * spacing - eye_offset:
/// spacing, product, offset and difference are rounded once each, by at most FLT_EPSILON / 2 of
/// their size, and none of them is larger than |border| + spacing (the offset is half a spacing, or
/// has the border's sign where the eye's sample is clamped). The border's own rounding makes it
/// five halves; a method that sends positions relative to an origin of its own rounds twice more. 4
/// FLT_EPSILON = eight halves: 0.5 m at 1e6 m, 5 mm at 10 km.
float border(double relative, double spacing, double direction) {
    const double margin = 4 * double(FLT_EPSILON) * (std::abs(relative) + spacing);
    return static_cast<float>(relative + direction * margin);
}

}  // namespace

Frame make_frame(const View& view, const Camera& frozen, const TerrainInfo& terrain,
                 bool wireframe) {
    check(frozen);
    Frame frame{};
    frame.clip_from_relative = view.clip_from_relative;
    frame.frozen_to_view = glm::vec4(glm::vec3(frozen.position - view.origin), 0);
    const glm::dvec2 eye(frozen.position);
    const glm::dvec2 low = terrain.extent_min() - eye;
    const glm::dvec2 high = terrain.extent_max() - eye;
    frame.extent = {border(low.x, terrain.spacing.x, -1), border(low.y, terrain.spacing.y, -1),
                    border(high.x, terrain.spacing.x, 1), border(high.y, terrain.spacing.y, 1)};
    // From the north-west, 45 degrees up: the light of the cartographer's hill shading.
    frame.light = {-0.5F, 0.5F, static_cast<float>(std::sqrt(0.5)), 0};
    const double range = double(terrain.max_height) - double(terrain.min_height);
    frame.tint = {static_cast<float>(double(terrain.min_height) - frozen.position.z),
                  range > 0 ? static_cast<float>(1 / range) : 0.0F, wireframe ? 1.0F : 0.0F, 0};
    return frame;
}

Frozen make_frozen(const Camera& frozen, const TerrainInfo& terrain) {
    check(frozen);
    Frozen block{};
    const glm::dvec2 tangents = frozen.half_tangents();
    block.frozen_clip_from_relative = glm::mat4(frozen.clip_from_relative());
    block.frozen_right = glm::vec4(glm::dvec4(frozen.right(), tangents.x));
    block.frozen_up = glm::vec4(glm::dvec4(frozen.up(), tangents.y));
    block.frozen_forward = glm::vec4(glm::dvec4(frozen.forward(), frozen.near_plane));
    const auto planes = frozen.frustum_planes();
    for (std::size_t i = 0; i < planes.size(); ++i) block.frozen_planes[i] = glm::vec4(planes[i]);

    // Relative to the south-west corner first: at origins of 1e7 m this difference is exact to 1e-9
    // m, and all that follows is small.
    const glm::dvec2 from_corner = glm::dvec2(frozen.position) - terrain.origin;
    const auto nearest = [](double steps) {
        return std::fmin(std::fmax(std::round(steps), -kSampleLimit), kSampleLimit);
    };
    const double column = nearest(from_corner.x / terrain.spacing.x);
    const double row = nearest(terrain.rows - 1 - from_corner.y / terrain.spacing.y);
    const double height = frozen.position.z;
    const auto height_high = static_cast<float>(height);
    block.eye_offset = {
        static_cast<float>(from_corner.x - column * terrain.spacing.x),
        static_cast<float>(from_corner.y - (terrain.rows - 1 - row) * terrain.spacing.y),
        height_high, static_cast<float>(height - double(height_high))};
    block.sample_spacing =
        glm::vec4(glm::dvec4(terrain.spacing.x, terrain.spacing.y, frozen.lambda(), 0));
    block.eye_sample = {static_cast<int>(column), static_cast<int>(row), terrain.columns,
                        terrain.rows};
    block.viewport_size = {frozen.viewport.width, frozen.viewport.height, 0, 0};
    return block;
}

}  // namespace lodbench::gl
