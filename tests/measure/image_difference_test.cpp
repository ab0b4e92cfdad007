// Differences of pictures, against closed forms and another library's SSIM.

#include "measure/image_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "api/error.h"
#include "base/hash.h"

namespace lodbench::test {
namespace {

using measure::image_difference;
using measure::ImageDifference;
using measure::psnr_db;
using measure::RgbPicture;

constexpr int kWidth = 67, kHeight = 41;  // no multiple of anybody's block

using Bytes = std::vector<std::uint8_t>;

ImageDifference difference(const Bytes& a, const Bytes& b, int width = kWidth,
                           int height = kHeight) {
    return image_difference({a, width, height}, {b, width, height});
}

/// Waves of 64 to 191 in all channels, different in each.
Bytes waves() {
    Bytes bytes;
    for (int row = 0; row < kHeight; ++row) {
        for (int column = 0; column < kWidth; ++column) {
            for (int channel = 0; channel < 3; ++channel) {
                bytes.push_back(std::uint8_t(128 + 63 * std::sin(0.3 * column + channel) *
                                                       std::cos(0.2 * row - channel)));
            }
        }
    }
    return bytes;
}

/// Each byte `amplitude` up or down, seeded; the mean squared error is amplitude^2.
Bytes with_noise(Bytes bytes, int amplitude) {
    base::SplitMix64 random(7);
    for (std::uint8_t& byte : bytes) {
        byte = std::uint8_t(byte + (random.next() % 2 == 0 ? amplitude : -amplitude));
    }
    return bytes;
}

TEST(ImageDifference, of_equal_pictures_is_none) {
    const ImageDifference same = difference(waves(), waves());
    EXPECT_EQ(same.mean_squared_error, 0);
    EXPECT_EQ(psnr_db(same.mean_squared_error), HUGE_VAL);
#ifdef LODBENCH_WITH_WEBP
    EXPECT_EQ(same.ssim, 1);
    EXPECT_EQ(difference({9, 8, 7}, {9, 8, 7}, 1, 1).ssim, 1) << "smaller than the window";
#endif
}

TEST(ImageDifference, of_one_level_everywhere_is_48_decibels) {
    Bytes brighter = waves();
    for (std::uint8_t& byte : brighter) ++byte;
    const double error = difference(waves(), brighter).mean_squared_error;
    EXPECT_EQ(error, 1);
    EXPECT_DOUBLE_EQ(psnr_db(error), 20 * std::log10(255));
    EXPECT_NEAR(psnr_db(error), 48.1308, 5e-5);
    EXPECT_EQ(difference(brighter, waves()).mean_squared_error, 1);
}

TEST(ImageDifference, counts_every_pixel_and_every_channel_alike) {
    const Bytes black(3 * kWidth * kHeight, 0);
    for (const std::size_t byte : {std::size_t{0}, black.size() / 2, black.size() - 1}) {
        Bytes one = black;
        one[byte] = 255;
        EXPECT_DOUBLE_EQ(difference(black, one).mean_squared_error,
                         255.0 * 255.0 / double(black.size()));
    }
    const Bytes white(black.size(), 255);
    EXPECT_EQ(psnr_db(difference(black, white).mean_squared_error), 0) << "the worst there is";
}

TEST(ImageDifference, of_known_noise_is_its_power) {
    for (const int amplitude : {1, 4, 16}) {
        EXPECT_EQ(difference(waves(), with_noise(waves(), amplitude)).mean_squared_error,
                  amplitude * amplitude);
    }
}

TEST(ImageDifference, refuses_pictures_that_do_not_fit_each_other_or_their_size) {
    const Bytes six(18), other(18), short_of_one(17);
    EXPECT_THROW(static_cast<void>(image_difference({six, 3, 2}, {other, 2, 3})), ContractError);
    EXPECT_THROW(static_cast<void>(image_difference({six, 3, 2}, {short_of_one, 3, 2})),
                 ContractError);
    EXPECT_THROW(static_cast<void>(image_difference({short_of_one, 3, 2}, {six, 3, 2})),
                 ContractError);
    EXPECT_THROW(static_cast<void>(image_difference({{}, 0, 0}, {{}, 0, 0})), ContractError);
    EXPECT_THROW(static_cast<void>(image_difference({six, -3, -2}, {six, -3, -2})), ContractError);
    try {
        static_cast<void>(image_difference({six, 3, 2}, {other, 2, 3}));
    } catch (const ContractError& error) {
        EXPECT_EQ(std::string(error.what()),
                  "pictures of 3 x 2 and 2 x 3 pixels: expected equal sizes");
    }
}

#ifdef LODBENCH_WITH_WEBP

double ssim(const Bytes& a, const Bytes& b) {
    const auto value = difference(a, b).ssim;
    return value ? *value : throw ContractError("no module webp.so beside the test");
}

TEST(StructuralSimilarity, falls_as_noise_grows) {
    double before = 1;
    for (const int amplitude : {1, 2, 4, 8, 16, 32, 64}) {
        const double now = ssim(waves(), with_noise(waves(), amplitude));
        EXPECT_LT(now, before - 0.001) << amplitude;
        EXPECT_GE(now, 0);
        EXPECT_NEAR(ssim(with_noise(waves(), amplitude), waves()), now, 1e-7);
        before = now;
    }
    EXPECT_LT(before, 0.5);
}

// scikit-image 0.19.3, structural_similarity(gaussian_weights=True, sigma=1.5,
// use_sample_covariance=False, data_range=255), on the same bytes. Window and borders differ, see
// the header: 0.01 is what they may make.
TEST(StructuralSimilarity, is_near_the_papers) {
    EXPECT_NEAR(ssim(waves(), with_noise(waves(), 4)), 0.967883, 0.01);
    EXPECT_NEAR(ssim(waves(), with_noise(waves(), 16)), 0.663301, 0.01);
}

// Without structure only the means differ: SSIM = (2 x y + C1) / (x^2 + y^2 + C1), with libwebp's
// C1 = 20. The sum of the pixels passes through a float: 6e-8 of it.
TEST(StructuralSimilarity, of_flat_pictures_is_the_closed_form) {
    for (const auto& [x, y] : {std::pair{100, 101}, {100, 150}, {20, 250}}) {
        const Bytes a(3 * kWidth * kHeight, std::uint8_t(x)), b(a.size(), std::uint8_t(y));
        EXPECT_NEAR(ssim(a, b), (2.0 * x * y + 20) / (x * x + y * y + 20), 1e-7);
    }
}

// One channel of three that has nothing in common with its counterpart.
TEST(StructuralSimilarity, is_the_mean_of_the_channels) {
    const Bytes a = waves();
    Bytes b = a;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        for (std::size_t i = channel; i < b.size(); i += 3) b[i] = std::uint8_t(255 - a[i]);
        EXPECT_LT(ssim(a, b), 1 - 0.25 * double(channel + 1));
        EXPECT_GT(ssim(a, b), 1 - 0.34 * double(channel + 1));
    }
}

#else

TEST(StructuralSimilarity, is_not_measured_without_its_library) {
    EXPECT_EQ(difference(waves(), waves()).ssim, std::nullopt);
}

#endif

}  // namespace
}  // namespace lodbench::test
