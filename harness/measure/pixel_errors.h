#pragma once
// Errors at the pixels: what a viewer of the drawn image sees, against rays through the true
// surface.
//
// Two surfaces are compared with what a rasteriser made of one of them, so slacks are needed:
//
// - kSlackPx: OpenGL snaps vertices to a subpixel grid of at least 4 bits (llvmpipe, and every GPU
//   known, 8), half a step of which is 1/32 px; a ray that only this moves across an edge proves
//   nothing. A verdict on a pixel (crack, sky against terrain) stands only if the rays kSlackPx to
//   each side give it too.
// - kDepthSlack: depth is interpolated in float32 from the differences between a triangle's
//   vertices, so that a pixel's depth is uncertain by some hundreds of units of 2^-24.
// - kInterpolation: those units are of the greatest value in the triangle, which is near / depth at
//   its nearest end: 2^-14, a thousand units (960 were seen), times depth / nearest depth. It is
//   more than kDepthSlack where a triangle reaches from the near plane to 4 times as far and more.
// - kRoundingUnits of the largest coordinate of a triangle's corners, relative to the eye: the
//   transform to clip space rounds its products. Beside a corner 10^6 m up, a point at 100 m may be
//   drawn half a metre aside.
// - kSliverSlack: at a sliver, a triangle seen thinner than kSlackPx, depth says nothing.
//   Rasterisers decide with snapped vertices whether a pixel is covered, but interpolate between
//   unsnapped ones: at a triangle thinner than the subpixel grid they extrapolate, by hundreds of
//   metres at 15 km (1 to 9 % of the depth were seen on llvmpipe, at a pixel in ten million).
//   kSliverSlack is how far l_f is looked for.
//
// The pixel error (measurement.md, "Truth") unprojects a drawn pixel and asks the true height at
// that place. On ground with a slope s, what moves the place by d moves that height by s d: a cliff
// of 1000 m in 1 m makes 10 m of a centimetre, and an exact surface would read whatever the slope
// makes of the rasteriser's and float32's rounding. So
//
// - a drawn point that lies within kSettledPx of l_f is taken as it is. One that does not is looked
//   for on l_f, where a ray within the slack of the pixel's meets it within the slack of the depth
//   (on a face seen at a small angle between two such rays, one of which meets it before and one
//   behind the depth), or within kSliverSlack where a sliver of l_f passes within kSlackPx of the
//   pixel: then the depth tells no more than l_f does, and l_f is judged, which is known in double.
// - positions on l_f are themselves rounded to float32. From an error over kSettledPx is taken off
//   what the true heights within that rounding make of it, where that is over kRoundingPx; on
//   slopes below 10 it never is. What remains is a lower bound, and exact to slope times rounding.
// - where no such ray meets l_f, the rasteriser drew what was not sent to it, and the point stays
//   what it is, unless the slacks leave its error uncertain by more than kJudgedPx to either side:
//   then the pixel is left out and counted (`undecided_pixels`). The other direction, from the
//   reference's true point, does not depend on depth and still judges l_f there.
//
// A method that draws every sample has at most kSettledPx + kRoundingPx.

#include <cstdint>
#include <span>
#include <vector>

#include "api/camera.h"
#include "measure/drawn_surface.h"
#include "measure/error_pool.h"
#include "measure/reference_terrain.h"
#include "measure/reference_view.h"

namespace lodbench::measure {

inline constexpr double kSlackPx = 1.0 / 16;
inline constexpr double kDepthSlack = 1.0 / 4096;
inline constexpr double kInterpolation = 1.0 / 16384;
inline constexpr double kSliverSlack = 1.0 / 4;
inline constexpr double kSettledPx = 1.0 / 64;
inline constexpr double kJudgedPx = 1;
inline constexpr double kRoundingPx = 1.0 / 1024;

/// What was found at a pixel, as bits.
enum PixelMark : std::uint8_t {
    kCrackMark = 1,       ///< the ray passes below l_f before what was drawn there
    kSkirtMark = 2,       ///< a skirt was drawn there
    kSilhouetteMark = 4,  ///< one of drawn and reference image shows sky, the other terrain
};

/// One frame's pixels, row by row from the top.
struct PixelErrors {
    /// From the drawn pixel: its point against the true height there. NaN where sky or a skirt was
    /// drawn.
    std::vector<float> drawn_px;
    /// From the reference: its true point against l_f there, +infinity where nothing covers it. NaN
    /// where the reference shows sky.
    std::vector<float> reference_px;
    std::vector<std::uint8_t> marks;
    std::uint64_t crack_pixels = 0, skirt_pixels = 0, silhouette_pixels = 0;
    std::uint64_t clipped = 0;  ///< segments that were clipped at near depth
    /// Pixels whose ray starts below l_f: whether it passes a crack cannot be told; no crack is.
    std::uint64_t unjudged_pixels = 0;
    /// Drawn pixels whose error their depth cannot tell, see kJudgedPx: NaN in `drawn_px`.
    std::uint64_t undecided_pixels = 0;
    double silhouette_max = 0;   ///< offset of the first terrain row of a column, pixels
    double silhouette_mean = 0;  ///< over all columns
};

/// `depth`: the drawn image's reversed depth buffer, near / depth along the view axis and 0 for
/// sky, row by row from the top; `hits` as of reference_hits. `pool` takes the errors of both
/// directions. Parallel; the same to the bit each time. Throws ContractError where `depth` has
/// another size than the camera's viewport.
[[nodiscard]] PixelErrors measure_pixels(const ReferenceTerrain& terrain,
                                         const DrawnSurface& surface, const Camera& camera,
                                         std::span<const ReferenceHit> hits,
                                         std::span<const float> depth, double bound,
                                         ErrorPool& pool);

}  // namespace lodbench::measure
