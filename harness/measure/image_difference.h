#pragma once
// How far a method's shaded picture is from the reference picture.

#include <cstdint>
#include <optional>
#include <span>

namespace lodbench::measure {

/// A picture of someone else's: three bytes a pixel (red, green, blue), row by row without gaps.
struct RgbPicture {
    std::span<const std::uint8_t> bytes;
    int width = 0;
    int height = 0;
};

struct ImageDifference {
    /// Mean over all pixels and channels of the squared difference, in squared levels of 0 .. 255.
    /// Exact before its one division. Pooled over frames of equal size it is the plain mean, which
    /// decibels are not.
    double mean_squared_error = 0;

    /// Structural similarity: mean over pixels and channels, 0 .. 1, 1 for equal pictures; nothing
    /// where lodbench was built or installed without its module (LODBENCH_WITH_WEBP).
    ///
    /// Wang, Bovik, Sheikh and Simoncelli, Image quality assessment: from error visibility to
    /// structural similarity, 2004, as libwebp computes it. Its departures from the paper: a window
    /// of 7 x 7 pixels, the product of the weights 1 2 3 4 3 2 1 (the paper: 11 x 11, Gaussian,
    /// sigma 1.5), cut off at the picture's border; C1 = 20 and C2 = 60 (6.5 and 58.5); a negative
    /// covariance counts as 0; a window darker than about 6 levels in both pictures counts as
    /// equal. On pictures of the demo (0.91 to 0.96) it lay 0.001 to 0.007 above scikit-image 0.19
    /// with the paper's window and constants.
    std::optional<double> ssim;
};

/// Symmetric in its arguments but for rounding. Throws ContractError for pictures of different
/// sizes, an empty one, or a span that is not 3 * width * height long; EnvironmentError where there
/// is no memory, or the module for SSIM is there but does not load.
[[nodiscard]] ImageDifference image_difference(const RgbPicture& a, const RgbPicture& b);

/// Peak signal-to-noise ratio in decibels, 10 log10(255^2 / mean squared error); +infinity for
/// equal pictures (error 0), which results write as "inf".
[[nodiscard]] double psnr_db(double mean_squared_error);

}  // namespace lodbench::measure
