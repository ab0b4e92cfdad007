#include "stitching_strips/tess_coordinates.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace lodbench::stitching_strips {
namespace {

using Fixed = std::uint32_t;  ///< 16 bits before the point, 16 behind it
constexpr Fixed kOne = 1U << 16U, kHalf = kOne / 2;

/// Half an edge, which the other half mirrors. A factor between two even numbers is a blend of the
/// edges at these two; the finer has one segment more, which grows out of one vertex of the
/// coarser.
struct HalfEdge {
    Fixed coarse_segments, fine_segments;  ///< of the half
    Fixed share;                           ///< of the fine edge in the blend, below 1
    Fixed split;  ///< vertices behind this one are one further than on the coarse edge
};

/// Nearest, ties to even.
Fixed to_fixed(float factor) {
    return Fixed(std::nearbyint(double(std::clamp(factor, kMinFactor, kMaxFactor)) * double(kOne)));
}

HalfEdge half_edge(float factor) {
    const Fixed half = (to_fixed(factor) + 1) / 2;
    const Fixed coarse = half / kOne;
    // The bits below the highest, doubled: where a segment grows leaps from place to place, as in a
    // radical inverse, so that growing segments are far from each other.
    return {coarse, (half + kOne - 1) / kOne, half % kOne,
            2 * (coarse - std::bit_floor(coarse)) + 1};
}

/// 1 / (2 * half_segments), nearest.
Fixed segment_length(Fixed half_segments) {
    const Fixed segments = 2 * half_segments;
    return (kOne + segments / 2) / segments;
}

/// `index` up to the middle.
Fixed place(const HalfEdge& half, Fixed index) {
    if (index == half.fine_segments) return kHalf;
    const Fixed on_fine = index * segment_length(half.fine_segments);
    const bool behind = half.share > 0 && index > half.split;
    const Fixed on_coarse = (behind ? index - 1 : index) * segment_length(half.coarse_segments);
    const Fixed blended = (on_coarse * (kOne - half.share) + on_fine * half.share + kHalf) / kOne;
    // 3 segments of 1/6, rounded, are longer than a half, and 15 of 1/30: Direct3D's vertex that
    // has just begun to leave the middle is beyond it, at factors just above 6 and up to 30.007.
    return std::min(blended, kHalf);
}

}  // namespace

int tess_segments(float factor) {
    return int(2 * half_edge(factor).fine_segments);
}

float tess_coordinate(int index, float factor) {
    const HalfEdge half = half_edge(factor);
    const auto segments = int(2 * half.fine_segments);
    const bool mirrored = index > segments / 2;
    const Fixed at = place(half, Fixed(mirrored ? segments - index : index));
    return float(mirrored ? kOne - at : at) / float(kOne);
}

std::vector<float> tess_coordinates(float factor) {
    std::vector<float> places;
    for (int index = 0; index <= tess_segments(factor); ++index) {
        places.push_back(tess_coordinate(index, factor));
    }
    return places;
}

std::size_t quad_vertex_count(const QuadFactors& factors) {
    std::size_t count = 0;
    for (const float factor : factors.outer) count += std::size_t(tess_segments(factor));
    return count + std::size_t(tess_segments(factors.inner[0]) - 1) *
                       std::size_t(tess_segments(factors.inner[1]) - 1);
}

std::vector<glm::vec2> quad_coordinates(const QuadFactors& factors) {
    std::vector<glm::vec2> points;
    points.reserve(quad_vertex_count(factors));
    // Each edge without its last corner, around the quad.
    const auto add_edge = [&](float factor, const auto& point_at) {
        const std::vector<float> places = tess_coordinates(factor);
        for (std::size_t i = 0; i + 1 < places.size(); ++i) points.push_back(point_at(places[i]));
    };
    add_edge(factors.outer[1], [](float at) { return glm::vec2(at, 0); });
    add_edge(factors.outer[2], [](float at) { return glm::vec2(1, at); });
    add_edge(factors.outer[3], [](float at) { return glm::vec2(1 - at, 1); });
    add_edge(factors.outer[0], [](float at) { return glm::vec2(0, 1 - at); });
    const std::vector<float> along_u = tess_coordinates(factors.inner[0]);
    const std::vector<float> along_v = tess_coordinates(factors.inner[1]);
    for (std::size_t row = 1; row + 1 < along_v.size(); ++row) {
        for (std::size_t column = 1; column + 1 < along_u.size(); ++column) {
            points.emplace_back(along_u[column], along_v[row]);
        }
    }
    return points;
}

}  // namespace lodbench::stitching_strips
