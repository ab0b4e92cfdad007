#include "picture/color_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lodbench::picture {
namespace {

// The helix. Teal, half way, is where sRGB is narrowest: at that lightness and hue it ends at a
// chroma of 0.100. Violet to yellow leaves magenta and red, in which marks are drawn, to the marks.
constexpr double kFirstLightness = 0.28;
constexpr double kLastLightness = 0.93;
constexpr double kFirstHue = 300 * std::numbers::pi / 180;
constexpr double kLastHue = 105 * std::numbers::pi / 180;
constexpr double kChroma = 0.098;

double linear_from_srgb(std::uint8_t channel) {
    const double value = channel / 255.0;
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

std::uint8_t srgb_from_linear(double linear) {
    const double value =
        linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    return std::uint8_t(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

}  // namespace

Oklab oklab_from_srgb(Rgb color) {
    const double r = linear_from_srgb(color.r);
    const double g = linear_from_srgb(color.g);
    const double b = linear_from_srgb(color.b);
    const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
    const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
    const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
    return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
            1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
            0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

Rgb srgb_from_oklab(const Oklab& color) {
    const auto cube = [](double value) { return value * value * value; };
    const double l = cube(color.lightness + 0.3963377774 * color.a + 0.2158037573 * color.b);
    const double m = cube(color.lightness - 0.1055613458 * color.a - 0.0638541728 * color.b);
    const double s = cube(color.lightness - 0.0894841775 * color.a - 1.2914855480 * color.b);
    return {srgb_from_linear(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
            srgb_from_linear(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
            srgb_from_linear(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

Oklab error_oklab(double fraction) {
    const double t = fraction > 0 ? std::min(fraction, 1.0) : 0.0;
    const double hue = std::lerp(kFirstHue, kLastHue, t);
    return {std::lerp(kFirstLightness, kLastLightness, t), kChroma * std::cos(hue),
            kChroma * std::sin(hue)};
}

Rgb error_color(double fraction) {
    return srgb_from_oklab(error_oklab(fraction));
}

}  // namespace lodbench::picture
