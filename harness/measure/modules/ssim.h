#pragma once
// The symbols of the module that knows libwebp.

#include <cstdint>
#include <vector>

#include "measure/image_difference.h"

/// Of two pictures of the same size, as ImageDifference::ssim says; NaN where there is no memory.
extern "C" __attribute__((visibility("default"))) double lodbench_ssim(
    const lodbench::measure::RgbPicture& a, const lodbench::measure::RgbPicture& b);

/// A picture as a lossy WebP file, quality 0 .. 100; false where there is no memory, or it is
/// larger than the format allows (16383 pixels a side).
extern "C" __attribute__((visibility("default"))) bool lodbench_encode_webp(
    const lodbench::measure::RgbPicture& picture, float quality, std::vector<std::uint8_t>& file);
