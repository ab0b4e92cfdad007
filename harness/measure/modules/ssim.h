#pragma once
// The one symbol of the module that computes SSIM.

#include "measure/image_difference.h"

/// Of two pictures of the same size, as ImageDifference::ssim says; NaN where there is no memory.
extern "C" __attribute__((visibility("default"))) double lodbench_ssim(
    const lodbench::measure::RgbPicture& a, const lodbench::measure::RgbPicture& b);
