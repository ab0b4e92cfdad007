#pragma once
// How fine a block has to be for a camera: Zhang 2019, 3.3.1.

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "api/camera.h"
#include "stitching_strips/block_tree.h"

namespace lodbench::stitching_strips {

enum class StraightDown { block, zero };
enum class Distance { centre, box };

struct MetricOptions {
    double tau = 1;          ///< pixels, > 0
    bool view_angle = true;  ///< the factor sin(theta) of (3); false: (2)
    StraightDown straight_down = StraightDown::block;
    Distance distance = Distance::centre;
};

/// rho = lambda * delta / d * sin(theta), (3): d from the viewpoint to the block's centre, theta
/// between that direction and the vertical. From straight above, (3) says 0 of any error: absent
/// from the paper, sin(theta) is at least what it is at the block's border (StraightDown::block).
class BlockMetric {
public:
    BlockMetric(const MetricOptions& options, const Camera& camera)
        : options_(options), eye_(camera.position), lambda_(camera.lambda()) {}

    /// The greatest object-space error, in metres, of which rho is not above tau; below 0 where the
    /// viewpoint is at the block (d = 0), so that no error is small enough.
    [[nodiscard]] double allowed_error(const Block& block) const {
        const double distance =
            options_.distance == Distance::box ? to_box(block) : to_centre(block);
        if (distance <= 0) return -1;
        const double sine = options_.view_angle ? sine_of_view(block) : 1.0;
        if (sine <= 0) return std::numeric_limits<double>::infinity();
        return options_.tau * distance / (lambda_ * sine);
    }

private:
    [[nodiscard]] double to_centre(const Block& block) const {
        return glm::length(block.centre - eye_);
    }
    [[nodiscard]] double to_box(const Block& block) const {
        return glm::length(glm::clamp(eye_, block.box.low, block.box.high) - eye_);
    }
    [[nodiscard]] double sine_of_view(const Block& block) const {
        const glm::dvec3 towards = block.centre - eye_;
        const double distance = glm::length(towards);
        if (distance <= 0) return 1;
        const double sine = glm::length(glm::dvec2(towards)) / distance;
        if (options_.straight_down == StraightDown::zero) return sine;
        const glm::dvec2 half = 0.5 * glm::dvec2(block.box.high - block.box.low);
        return std::max(sine, std::min(1.0, std::max(half.x, half.y) / distance));
    }

    MetricOptions options_;
    glm::dvec3 eye_;
    double lambda_;
};

/// The factor at which the error is the allowed one: (4), between the greatest of the factors 2, 4
/// ... 64 of which the error is too large and the next one. From 64 downwards, since errors do not
/// always fall with the factor. 2 where none is too large; 64 where that of 64 is, and the block
/// cannot be split.
[[nodiscard]] inline float tessellation_factor(const BlockErrors& errors, double allowed) {
    if (double(errors.back()) > allowed) return float(factor_of_error(kErrorCount - 1));
    for (int i = kErrorCount - 2; i >= 0; --i) {
        const double error = double(errors[std::size_t(i)]);
        if (error <= allowed) continue;
        const double finer = double(errors[std::size_t(i) + 1]);
        return float((error - allowed) / (error - finer) * 2.0 + factor_of_error(i));
    }
    return 2;
}

}  // namespace lodbench::stitching_strips
