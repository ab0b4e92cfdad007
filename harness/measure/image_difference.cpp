#include "measure/image_difference.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "api/error.h"
#include "base/modules.h"
#include "measure/modules/ssim.h"

namespace lodbench::measure {

namespace {

void check(const RgbPicture& a, const RgbPicture& b) {
    if (a.width != b.width || a.height != b.height) {
        throw ContractError(
            fmt::format("pictures of {} x {} and {} x {} pixels: expected equal sizes", a.width,
                        a.height, b.width, b.height));
    }
    for (const RgbPicture& picture : {a, b}) {
        if (picture.width < 1 || picture.height < 1 ||
            picture.bytes.size() != 3 * std::size_t(picture.width) * std::size_t(picture.height)) {
            throw ContractError(
                fmt::format("a picture of {} x {} pixels in {} bytes: expected 3 a "
                            "pixel, and at least one pixel",
                            picture.width, picture.height, picture.bytes.size()));
        }
    }
}

/// A sum of whole numbers: 64 bits hold 2^47 pixels.
double mean_squared_error(const RgbPicture& a, const RgbPicture& b) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < a.bytes.size(); ++i) {
        const int difference = int(a.bytes[i]) - int(b.bytes[i]);
        sum += std::uint64_t(difference * difference);
    }
    return double(sum) / double(a.bytes.size());
}

std::optional<double> ssim(const RgbPicture& a, const RgbPicture& b) {
    void* symbol = base::find_in_module("webp", "lodbench_ssim");
    if (symbol == nullptr) return std::nullopt;
    const double value = reinterpret_cast<decltype(&lodbench_ssim)>(symbol)(a, b);
    if (std::isnan(value)) {
        throw EnvironmentError(
            fmt::format("libwebp has no memory for the SSIM of {} x {} pixels", a.width, a.height));
    }
    return value;
}

}  // namespace

ImageDifference image_difference(const RgbPicture& a, const RgbPicture& b) {
    check(a, b);
    return {mean_squared_error(a, b), ssim(a, b)};
}

double psnr_db(double mean_squared_error) {
    if (mean_squared_error == 0) return std::numeric_limits<double>::infinity();
    return 10 * std::log10(255.0 * 255.0 / mean_squared_error);
}

}  // namespace lodbench::measure
