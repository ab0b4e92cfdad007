// The only file that knows libwebp. Of what Debian 12 has, it is the library with SSIM that brings
// nothing along (OpenCV's brings some 20 more; ImageMagick 6 has no SSIM, and there is no
// libvmaf), and it was there already, for OpenImageIO.

#include <webp/encode.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "measure/modules/ssim.h"

double lodbench_ssim(const lodbench::measure::RgbPicture& a,
                     const lodbench::measure::RgbPicture& b) {
    constexpr int kChannels = 3;
    constexpr int kSsim = 1;  // of WebPPlaneDistortion's types
    const std::size_t row_bytes = kChannels * std::size_t(a.width);
    double sum = 0;
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
        float similarity = 0;  // summed over the pixels
        float decibels = 0;
        if (WebPPlaneDistortion(a.bytes.data() + channel, row_bytes, b.bytes.data() + channel,
                                row_bytes, a.width, a.height, kChannels, kSsim, &similarity,
                                &decibels) == 0) {
            return std::nan("");
        }
        sum += double(similarity);
    }
    // The library hands its sum over as a float, which beyond 2^24 pixels may be rounded upward.
    return std::min(1.0, sum / (kChannels * double(a.width) * double(a.height)));
}

bool lodbench_encode_webp(const lodbench::measure::RgbPicture& picture, float quality,
                          std::vector<std::uint8_t>& file) {
    std::uint8_t* bytes = nullptr;
    const std::size_t size = WebPEncodeRGB(picture.bytes.data(), picture.width, picture.height,
                                           3 * picture.width, quality, &bytes);
    if (size > 0) file.assign(bytes, bytes + size);
    WebPFree(bytes);
    return size > 0;
}
