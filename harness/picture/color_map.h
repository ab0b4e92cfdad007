#pragma once
// Colours for numbers: OKLab (Björn Ottosson, "A perceptual color space for image processing",
// 2020, bottosson.github.io/posts/oklab) and a map from error to colour that is a curve of even
// speed in it.

#include <cstdint>

namespace lodbench::picture {

/// 8-bit sRGB.
struct Rgb {
    std::uint8_t r = 0;
    std::uint8_t g = 0;
    std::uint8_t b = 0;
    friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// Equal distances look about equally large.
struct Oklab {
    double lightness = 0;  ///< 0 black .. 1 white
    double a = 0;          ///< green (-) to red (+), about -0.3..0.3
    double b = 0;          ///< blue (-) to yellow (+), about -0.3..0.3
};

[[nodiscard]] Oklab oklab_from_srgb(Rgb color);

/// Rounded to 8 bits; a channel that leaves the gamut is clamped.
[[nodiscard]] Rgb srgb_from_oklab(const Oklab& color);

/// The colour of an error that is `fraction` (clamped to 0..1, NaN is 0) of the scale's top: dark
/// violet through teal and green to light yellow. A helix about the lightness axis: lightness and
/// hue are linear in `fraction` and chroma is constant, so that the speed in OKLab is constant too.
/// Within sRGB's gamut throughout.
[[nodiscard]] Oklab error_oklab(double fraction);
[[nodiscard]] Rgb error_color(double fraction);

}  // namespace lodbench::picture
