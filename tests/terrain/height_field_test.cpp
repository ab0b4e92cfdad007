// A height field in memory: what it refuses, what it computes, what it serves.

#include "terrain/height_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "api/error.h"

namespace lodbench::terrain {
namespace {

TerrainInfo info_of(int rows, int columns) {
    TerrainInfo info;
    info.name = "test";
    info.rows = rows;
    info.columns = columns;
    info.spacing = {10, 20};
    info.origin = {1000, 2000};
    return info;
}

std::vector<float> counting(int count) {
    std::vector<float> heights(static_cast<std::size_t>(count));
    std::iota(heights.begin(), heights.end(), 0.0F);
    return heights;
}

std::string refusal(const TerrainInfo& info, std::vector<float> heights) {
    try {
        const HeightField field(info, std::move(heights));
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(HeightField, computes_the_height_range) {
    const HeightField field(info_of(2, 3), {5, -2, 7, 0, 1, 2});
    EXPECT_EQ(field.info().min_height, -2.0F);
    EXPECT_EQ(field.info().max_height, 7.0F);
}

TEST(HeightField, row_0_is_the_north_edge) {
    const HeightField field(info_of(3, 4), counting(12));
    EXPECT_EQ(field.info().position(2, 0), glm::dvec2(1000, 2000));
    EXPECT_EQ(field.info().position(0, 3), glm::dvec2(1030, 2040));
    EXPECT_EQ(field.info().extent_max(), glm::dvec2(1030, 2040));
}

TEST(HeightField, serves_a_rectangle_row_by_row) {
    const HeightField field(info_of(3, 4), counting(12));
    std::vector<float> block(4);
    field.read({1, 2, 2, 2}, block);
    EXPECT_EQ(block, (std::vector<float>{6, 7, 10, 11}));
    EXPECT_THROW(field.read({2, 2, 2, 2}, block), ContractError);
}

TEST(HeightField, rejects_nan_with_row_and_column) {
    std::vector<float> heights = counting(12);
    heights[6] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(refusal(info_of(3, 4), heights),
              "terrain 'test': the height at row 1, column 2 is nan; every height must be finite");
    heights[6] = -std::numeric_limits<float>::infinity();
    EXPECT_EQ(refusal(info_of(3, 4), heights),
              "terrain 'test': the height at row 1, column 2 is -inf; every height must be finite");
}

TEST(HeightField, rejects_a_grid_without_a_cell) {
    EXPECT_EQ(
        refusal(info_of(1, 4), counting(4)),
        "terrain 'test': 1 rows x 4 columns make no surface; at least 2 x 2 samples are needed");
    EXPECT_NE(refusal(info_of(0, 0), {}), "accepted");
}

TEST(HeightField, rejects_a_spacing_that_is_not_positive_and_finite) {
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()}) {
        TerrainInfo info = info_of(2, 2);
        info.spacing.y = bad;
        EXPECT_NE(refusal(info, counting(4)), "accepted") << bad;
    }
}

TEST(HeightField, a_wrong_number_of_heights_is_the_programmers_mistake) {
    EXPECT_THROW(HeightField(info_of(2, 2), counting(5)), ContractError);
}

// FNV-1a over the little-endian words 2, 2, and the bits of 0.0, 1.0, 2.0, 3.0, computed apart in
// Python.
TEST(HeightField, checksum_is_fnv_1a_over_dimensions_and_float_bits) {
    EXPECT_EQ(HeightField(info_of(2, 2), counting(4)).info().checksum, "ea1d0dad7a593b48");
}

TEST(HeightField, equal_heights_have_equal_bits) {
    EXPECT_EQ(HeightField(info_of(2, 2), {-0.0F, 1, 2, 3}).info().checksum,
              HeightField(info_of(2, 2), {0.0F, 1, 2, 3}).info().checksum);
}

TEST(HeightField, checksum_tells_apart_shape_and_value_but_not_place) {
    const std::string base = HeightField(info_of(2, 6), counting(12)).info().checksum;
    EXPECT_NE(HeightField(info_of(6, 2), counting(12)).info().checksum, base);
    std::vector<float> heights = counting(12);
    heights[11] = std::nextafter(heights[11], 0.0F);
    EXPECT_NE(HeightField(info_of(2, 6), heights).info().checksum, base);
    TerrainInfo moved = info_of(2, 6);
    moved.origin = {0, 0};
    EXPECT_EQ(HeightField(moved, counting(12)).info().checksum, base);
}

}  // namespace
}  // namespace lodbench::terrain
