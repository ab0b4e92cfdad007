#pragma once
// Errors at the pixels: what a viewer of the drawn image sees, against rays through the true
// surface.
//
// Two surfaces are compared with what a rasteriser made of one of them, so two slacks are needed:
//
// - kSlackPx: OpenGL snaps vertices to a subpixel grid of at least 4 bits (llvmpipe, and every GPU
// known,
//   8), half a step of which is 1/32 px; a ray that only this moves across an edge proves nothing.
//   A verdict on a pixel (crack, sky against terrain) stands only if the rays kSlackPx to each side
//   give it too.
// - kDepthSlack: depth is interpolated in float32 from the differences between a triangle's
// vertices,
//   so that a pixel's depth is uncertain by some hundreds of units of 2^-24.
// - kSliverSlack: at a sliver, a triangle seen thinner than kSlackPx, depth says nothing.
// Rasterisers
//   decide with snapped vertices whether a pixel is covered, but interpolate between unsnapped
//   ones: at a triangle thinner than the subpixel grid they extrapolate, by hundreds of metres at
//   15 km (1 to 9 % of the depth were seen on llvmpipe, at a pixel in ten million). kSliverSlack is
//   how far l_f is looked for.
//
// A drawn point that lies within kSettledPx of l_f is taken as it is. One that does not is looked
// for on l_f, where a ray within kSlackPx meets it within kDepthSlack, or within kSliverSlack where
// a sliver of l_f passes within kSlackPx of the pixel: so the noise of depth makes no error, and a
// method that draws every sample has at most kSettledPx. Where no such ray meets l_f the point
// stays what it is: the rasteriser drew what was not sent to it.

#include <cstdint>
#include <span>
#include <vector>

#include "api/camera.h"
#include "measure/drawn_surface.h"
#include "measure/error_pool.h"
#include "measure/reference_terrain.h"

namespace lodbench::measure {

inline constexpr double kSlackPx = 1.0 / 16;
inline constexpr double kDepthSlack = 1.0 / 4096;
inline constexpr double kSliverSlack = 1.0 / 4;
inline constexpr double kSettledPx = 1.0 / 64;

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
    double silhouette_max = 0;   ///< offset of the first terrain row of a column, pixels
    double silhouette_mean = 0;  ///< over all columns
};

/// `depth`: the drawn image's reversed depth buffer, near / depth along the view axis and 0 for
/// sky, row by row from the top. `pool` takes the errors of both directions. Parallel; the same to
/// the bit each time. Throws ContractError where `depth` has another size than the camera's
/// viewport.
[[nodiscard]] PixelErrors measure_pixels(const ReferenceTerrain& terrain,
                                         const DrawnSurface& surface, const Camera& camera,
                                         std::span<const float> depth, double bound,
                                         ErrorPool& pool);

}  // namespace lodbench::measure
