// Elevation models through GDAL: place, spacing, units and no-data come from the file.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "api/error.h"
#include "raster_input.h"
#include "terrain/height_field.h"
#include "terrain/raster_reader.h"

namespace lodbench::terrain {
namespace {

using test::packed16;
using test::Tiff;

class Elevation : public RasterInput {
protected:
    void SetUp() override {
        // Loads the module: what follows is read in this process.
        EXPECT_THROW((void)open_with_gdal("none.asc"), InputError);
#ifndef LODBENCH_WITH_GDAL
        GTEST_SKIP() << "built without GDAL";
#endif
        testing::internal::CaptureStderr();
        capturing_ = true;
    }
    void TearDown() override {
        if (capturing_) {
            EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "GDAL spoke for itself";
        }
    }
    std::unique_ptr<HeightField> load(const std::string& name, std::string_view bytes) {
        return load_terrain(source(name, bytes));
    }
    static std::vector<float> heights(const HeightField& field) {
        return {field.samples().begin(), field.samples().end()};
    }
    bool capturing_ = false;
};

const std::vector<int> kSix = {10, 20, 30, 40, 50, 60};  // 2 rows x 3 columns

Tiff six() {
    return Tiff(3, 2, 16, 2, packed16(kSix, false));
}

TEST_F(Elevation, projected_geotiff_keeps_spacing_and_origin) {
    const auto field = load("a.tif", six().place(30, 376000, 3808000, false).str());
    EXPECT_EQ(heights(*field), (std::vector<float>{10, 20, 30, 40, 50, 60}));
    EXPECT_EQ(field->info().spacing, glm::dvec2(30, 30));
    // A sample stands at its pixel's centre; the south-west one is half a pixel east, one and a
    // half south.
    EXPECT_EQ(field->info().origin, glm::dvec2(376015, 3807955));
}

// Arc lengths of WGS 84 at 45 degrees, from the meridian radius a(1-e^2)/(1-e^2/2)^1.5 and the
// normal one a/(1-e^2/2)^0.5 worked out apart: 111131.777414 m and 78846.835094 m a degree.
TEST_F(Elevation, degrees_become_metres_at_the_centre_latitude) {
    const auto field = load("a.tif", six().place(0.001, 6, 45.001, true).str());
    EXPECT_NEAR(field->info().spacing.x, 78.846835094, 1e-6);
    EXPECT_NEAR(field->info().spacing.y, 111.131777414, 1e-6);
    EXPECT_NEAR(field->info().origin.x, 6.0005 * 78846.835094, 0.01);
    EXPECT_NEAR(field->info().origin.y, 44.9995 * 111131.777414, 0.01);
}

TEST_F(Elevation, south_up_rasters_are_turned_over) {
    Tiff tiff = six();
    tiff.doubles(34264, {10, 0, 0, 500, 0, 10, 0, 800, 0, 0, 0, 0, 0, 0, 0, 1}).keys(false);
    const auto field = load("a.tif", tiff.str());
    EXPECT_EQ(heights(*field), (std::vector<float>{40, 50, 60, 10, 20, 30}));
    EXPECT_EQ(field->info().origin, glm::dvec2(505, 805));
}

TEST_F(Elevation, rotated_rasters_are_refused) {
    Tiff tiff = six();
    tiff.doubles(34264, {10, 2, 0, 500, 2, -10, 0, 800, 0, 0, 0, 0, 0, 0, 0, 1}).keys(false);
    EXPECT_EQ(refusal("a.tif", tiff.str()),
              "a.tif: a rotated geotransform (terms 2 and 2); warp it upright with gdalwarp");
}

TEST_F(Elevation, no_data_of_the_file_is_filled_and_counted) {
    const auto field =
        load("a.tif", Tiff(3, 2, 16, 2, packed16({10, -9999, 30, 40, 50, -9999}, false))
                          .place(1, 0, 100, false)
                          .ascii(42113, "-9999")
                          .str());
    EXPECT_EQ(field->info().void_count, 2U);
    EXPECT_EQ(field->samples()[1], 30.0F);  // (10 + 30 + 50) / 3
    EXPECT_EQ(field->samples()[5], 40.0F);  // (50 + 30) / 2
}

TEST_F(Elevation, no_data_of_the_source_goes_before_that_of_the_file) {
    TerrainSource given = source("a.tif", six().place(1, 0, 100, false).ascii(42113, "10").str());
    given.no_data = 60;
    const auto field = load_terrain(given);
    EXPECT_EQ(field->samples()[0], 10.0F);
    EXPECT_EQ(field->samples()[5], 40.0F);
}

// 1.70141e38 is no float: the file's text and its samples agree only once both are rounded.
TEST_F(Elevation, no_data_of_float_rasters_is_compared_in_float) {
    test::Bytes samples(false);
    for (const float sample : {1.0F, 2.0F, 3.0F, 1.70141e38F}) samples.real32(sample);
    const auto field = load(
        "a.tif",
        Tiff(2, 2, 32, 3, samples.str()).place(1, 0, 100, false).ascii(42113, "1.70141e38").str());
    EXPECT_EQ(field->info().void_count, 1U);
    EXPECT_EQ(field->samples()[3], 2.5F);
}

TEST_F(Elevation, nan_is_refused_with_its_place_unless_it_is_the_no_data) {
    test::Bytes samples(false);
    for (const float sample : {1.0F, 2.0F, std::numeric_limits<float>::quiet_NaN(), 4.0F}) {
        samples.real32(sample);
    }
    Tiff tiff = Tiff(2, 2, 32, 3, samples.str()).place(1, 0, 100, false);
    EXPECT_EQ(
        refusal("a.tif", tiff.str()),
        "a.tif: the height at row 1, column 0 is nan; every height must be finite, or its value "
        "given as no-data");
    EXPECT_EQ(load("b.tif", tiff.ascii(42113, "nan").str())->info().void_count, 1U);
}

TEST_F(Elevation, all_no_data_is_refused) {
    EXPECT_EQ(refusal("a.tif", Tiff(2, 2, 16, 2, packed16({-1, -1, -1, -1}, false))
                                   .place(1, 0, 100, false)
                                   .ascii(42113, "-1")
                                   .str()),
              "a.tif: every sample is no-data (-1); check the no-data value");
}

TEST_F(Elevation, scale_offset_and_unit_of_the_file_are_applied) {
    const std::string words =
        "<GDALMetadata><Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.5</Item>"
        "<Item name=\"OFFSET\" sample=\"0\" role=\"offset\">100</Item>"
        "<Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">@</Item>"
        "</GDALMetadata>";
    const auto with_unit = [&](const std::string& unit) {
        std::string text = words;
        text.replace(text.find('@'), 1, unit);
        return six().place(1, 0, 100, false).ascii(42112, text).str();
    };
    EXPECT_EQ(load("m.tif", with_unit("metre"))->samples()[0], 105.0F);
    EXPECT_EQ(load("f.tif", with_unit("ft"))->samples()[0], float(105 * 0.3048));
    TerrainSource unknown = source("u.tif", with_unit("cubit"));
    EXPECT_EQ(
        refusal(unknown),
        "u.tif: heights in 'cubit', which is no unit known here; give the vertical scale (metres "
        "per unit)");
    unknown.vertical_scale = 0.5;
    unknown.vertical_offset = 0;
    EXPECT_EQ(load_terrain(unknown)->samples()[0], 5.0F);
}

TEST_F(Elevation, arc_ascii_grids_are_read) {
    const auto field = load("a.asc",
                            "ncols 3\nnrows 2\nxllcorner 500\nyllcorner 800\ncellsize 25\n"
                            "NODATA_value -1\n1.5 2 3\n4 -1 6\n");
    EXPECT_EQ(heights(*field), (std::vector<float>{1.5, 2, 3, 4, 4, 6}));
    EXPECT_EQ(field->info().spacing, glm::dvec2(25));
    EXPECT_EQ(field->info().origin, glm::dvec2(512.5, 812.5));
}

TEST_F(Elevation, numbers_that_look_like_degrees_without_a_system_need_a_spacing) {
    TerrainSource given = source("a.asc",
                                 "ncols 2\nnrows 2\nxllcorner 6\nyllcorner 45\n"
                                 "cellsize 0.001\n1 2\n3 4\n");
    EXPECT_EQ(refusal(given),
              "a.asc: no coordinate system, and pixels of 0.001 x 0.001 look like "
              "degrees; give the spacing in metres");
    given.spacing_x = given.spacing_y = 90;
    EXPECT_EQ(load_terrain(given)->info().spacing, glm::dvec2(90));
}

TEST_F(Elevation, srtm_tiles_are_read_with_their_voids) {
    std::vector<int> samples(std::size_t(1201) * 1201, 500);
    samples[1201 * 600 + 600] = -32768;
    const auto field = load("N45E006.hgt", packed16(samples, true));
    EXPECT_EQ(field->info().rows, 1201);
    EXPECT_EQ(field->info().void_count, 1U);
    EXPECT_EQ(field->info().max_height, 500.0F);
    EXPECT_NEAR(field->info().spacing.y, 92.6173,
                1e-3);  // 3 seconds of the meridian at 45.5 degrees
}

TEST_F(Elevation, damaged_files_are_refused_in_one_line) {
    const std::string whole = six().place(30, 376000, 3808000, false).str();
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const std::string text = refusal("t.tif", std::string_view(whole).substr(0, length));
        EXPECT_EQ(text.find("t.tif: "), 0U) << length << ": " << text;
    }
    EXPECT_EQ(
        refusal("t.tif", std::string_view(whole).substr(0, whole.size() - 1)),
        "t.tif: the data of tag 34735 lies beyond its end, at byte 285; it is truncated, fetch it "
        "anew");
    EXPECT_EQ(refusal("n.hgt", "short").find("n.hgt: is no elevation model that can be read; "),
              0U);
    EXPECT_EQ(refusal("e.asc", "").find("e.asc: is no elevation model that can be read; "), 0U);
    EXPECT_EQ(refusal("l.asc", "ncols 3\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n"),
              "l.asc: 1 rows x 3 columns make no surface; at least 2 x 2 samples are needed");
}

// A VRT could name any other file, or an address; its driver is never registered.
TEST_F(Elevation, virtual_rasters_in_disguise_are_refused) {
    EXPECT_EQ(refusal("v.asc", "<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"></VRTDataset>")
                  .find("v.asc: is no elevation model that can be read; "),
              0U);
}

}  // namespace
}  // namespace lodbench::terrain
