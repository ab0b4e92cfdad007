// Rasters that lie: what a file does not say, or says otherwise than its samples, is read right,
// refused or warned of, never taken for heights without a word.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "api/error.h"
#include "raster_input.h"
#include "terrain/load_terrain.h"
#include "terrain/raster_reader.h"
#include "terrain/terrain_rows.h"
#include "terrain/world_file.h"

namespace lodbench::terrain {
namespace {

using test::packed16;
using test::png;
using test::Tiff;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr float kFloatMax = std::numeric_limits<float>::max();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::string floats(const std::vector<float>& samples) {
    test::Bytes bytes(false);
    for (const float sample : samples) bytes.real32(sample);
    return bytes.str();
}

class Traps : public RasterInput {
protected:
    LoadedTerrain load(const std::string& name, std::string_view bytes) {
        return load_terrain_with_provenance(source(name, bytes));
    }
    static std::vector<float> heights(const LoadedTerrain& loaded) {
        return {loaded.field->samples().begin(), loaded.field->samples().end()};
    }
};

class ElevationTraps : public Traps {
protected:
    void SetUp() override {
        // Loads the module: what follows is read in this process.
        EXPECT_THROW((void)open_with_gdal("none.asc"), InputError);
#ifndef LODBENCH_WITH_GDAL
        GTEST_SKIP() << "built without GDAL";
#endif
    }
};

class ImageTraps : public Traps {
protected:
    void SetUp() override {
        EXPECT_THROW((void)open_with_oiio("none.png"), InputError);
#ifndef LODBENCH_WITH_OIIO
        GTEST_SKIP() << "built without OpenImageIO";
#endif
    }
};

// -- no data

std::string four_floats(const std::vector<float>& samples, const std::string& no_data) {
    Tiff tiff = Tiff(2, 2, 32, 3, floats(samples)).place(10, 500000, 5200000, false);
    if (!no_data.empty()) tiff.ascii(42113, no_data);
    return tiff.str();
}

TEST_F(ElevationTraps, no_data_is_compared_within_the_rounding_of_its_type) {
    // Written with six digits, with the double that comes after, and beyond all floats.
    for (const char* text : {"-3.40282e+38", "-3.4028234663852886e+38", "-3.40282346638529e+38",
                             "-1.7976931348623157e+308", "-1.79769313486232e+308"}) {
        const LoadedTerrain loaded = load("a.tif", four_floats({1, 2, 3, -kFloatMax}, text));
        EXPECT_EQ(loaded.field->info().void_count, 1U) << text;
        EXPECT_EQ(loaded.field->samples()[3], 2.5F) << text;
    }
    EXPECT_EQ(load("b.tif", four_floats({1, 2, 3, -9999.9F}, "-9999.9")).field->info().void_count,
              1U);
    // As near as a millimetre is another height.
    EXPECT_EQ(load("c.tif", four_floats({1, 2, 3, 100.001F}, "100")).field->info().void_count, 0U);
}

TEST_F(ElevationTraps, a_float_made_a_double_is_still_its_no_data) {
    test::Bytes samples(false);
    for (const double sample : {1.0, 2.0, 3.0, double(-9999.9F)}) samples.real64(sample);
    const std::string file = Tiff(2, 2, 64, 3, samples.str())
                                 .place(10, 500000, 5200000, false)
                                 .ascii(42113, "-9999.9")
                                 .str();
    EXPECT_EQ(load("a.tif", file).field->info().void_count, 1U);
}

TEST_F(ElevationTraps, what_is_not_finite_beside_a_no_data_value_is_void) {
    for (const float other : {kNan, kInfinity, -kInfinity}) {
        const LoadedTerrain loaded = load("a.tif", four_floats({1, other, -9999, 4}, "-9999"));
        EXPECT_EQ(loaded.field->info().void_count, 2U) << other;
    }
}

TEST_F(ElevationTraps, infinity_may_be_given_as_no_data_as_its_refusal_says) {
    TerrainSource given = source("a.tif", four_floats({1, kInfinity, -kInfinity, 4}, ""));
    EXPECT_THAT(refusal(given), HasSubstr("row 0, column 1 is inf; every height must be finite, or "
                                          "its value given as no-data"));
    given.no_data = kInfinity;
    EXPECT_EQ(load_terrain(given)->info().void_count, 2U);
    given.no_data.reset();
    folder_.write("a.tif.toml", "no_data = -inf\n");
    EXPECT_EQ(load_terrain(given)->info().void_count, 2U);
}

TEST_F(ElevationTraps, a_number_that_is_no_height_anywhere_is_refused_with_its_place) {
    EXPECT_THAT(
        refusal("a.tif", four_floats({1, 2, -kFloatMax, 4}, "")),
        HasSubstr("the height at row 1, column 0 is -3.4028234663852886e+38, implausible on "
                  "any body: it marks a sample without data; give it as no-data"));
    EXPECT_THAT(refusal("b.tif", four_floats({1, 2, 1e20F, 4}, "")), HasSubstr("implausible"));
    EXPECT_EQ(load("c.tif", four_floats({1, 2, 9.9e6F, 4}, "")).field->info().max_height, 9.9e6F);
}

TEST_F(ElevationTraps, known_marks_far_from_all_heights_are_warned_of) {
    const auto warnings = [this](const std::vector<int>& samples) {
        return load("a.tif", Tiff(3, 2, 16, 2, packed16(samples, false))
                                 .place(10, 500000, 5200000, false)
                                 .str())
            .provenance.warnings;
    };
    EXPECT_THAT(
        warnings({1000, 1100, -9999, 1200, -9999, 1300}),
        ElementsAre(HasSubstr("a.tif: 2 samples are -9999, the first at row 0, column 2, far "
                              "from all others: taken for heights")));
    EXPECT_THAT(warnings({1000, 1100, 0, 1200, 1210, 1300}),
                ElementsAre(HasSubstr("1 samples are 0, the first at row 0, column 2")));
    EXPECT_THAT(warnings({-32768, 1100, 1000, 1200, 1210, 1300}),
                ElementsAre(HasSubstr("1 samples are -32768")));
    // A trench, and a coast below a cliff.
    EXPECT_THAT(warnings({-9999, -10500, -9800, -5000, -3000, -100}), IsEmpty());
    EXPECT_THAT(warnings({0, 200, 250, 400, 1000, 0}), IsEmpty());
}

TEST_F(ElevationTraps, heights_beyond_the_earths_are_warned_of_with_their_place) {
    EXPECT_THAT(
        load("a.tif", four_floats({1000, 2000, 848000, 900}, "")).provenance.warnings,
        ElementsAre(HasSubstr("the height at row 1, column 0 is 848000 m, higher than any on "
                              "the Earth")));
    EXPECT_THAT(load("a.tif", four_floats({8849, -10935, 0, 9}, "")).provenance.warnings,
                IsEmpty());
}

TEST_F(ElevationTraps, no_data_that_the_samples_cannot_hold_is_warned_of_where_its_bits_are_there) {
    const std::string file = Tiff(2, 2, 16, 1, packed16({1000, 1001, -9999, 1003}, false))
                                 .place(10, 500000, 5200000, false)
                                 .ascii(42113, "-9999")
                                 .str();
    EXPECT_THAT(
        load("a.tif", file).provenance.warnings,
        testing::Contains(HasSubstr("no-data is -9999, which no integer from 0 to 65535 can "
                                    "be, but 1 samples are 55537")));
}

TEST_F(ElevationTraps, warnings_of_rows_are_those_of_the_whole) {
    const std::string file = four_floats({1000, 1001, -9999, 1003}, "");
    Provenance rows_say;
    with_rows(source("a.tif", file), [&](TerrainRows& rows) {
        std::vector<float> row(2);
        for (int i = 0; i < rows.info().rows; ++i) rows.next(row);
        rows_say = rows.provenance();
    });
    EXPECT_EQ(rows_say.warnings.size(), 1U);
    EXPECT_EQ(load("a.tif", file).provenance.warnings, rows_say.warnings);
}

// -- masks

TEST_F(ElevationTraps, masks_inside_and_beside_a_tiff_make_voids) {
    const Tiff plain(2, 2, 32, 3, floats({1000, 0, 1100, 1200}));
    const std::string mask("\xff\x00\xff\xff", 4);
    const auto expect_void = [&](const std::string& name, const std::string& file) {
        const LoadedTerrain loaded = load(name, file);
        EXPECT_EQ(loaded.field->info().void_count, 1U) << name;
        EXPECT_EQ(loaded.field->info().min_height, 1000.0F) << name;
    };
    expect_void("placed.tif", Tiff(plain).place(10, 500000, 5200000, false).mask(mask).str());
    expect_void("plain.tif", Tiff(plain).mask(mask).str());
    folder_.write("beside.tif.msk",
                  Tiff(2, 2, 8, 1, mask)
                      .ascii(42112,
                             "<GDALMetadata><Item name=\"INTERNAL_MASK_FLAGS_1\">2</Item>"
                             "</GDALMetadata>")
                      .str());
    expect_void("beside.tif", plain.str());
    EXPECT_EQ(refusal("all.tif", Tiff(plain).mask(std::string(4, '\0')).str()),
              "all.tif: its mask rules out every sample; check the mask");
}

TEST_F(ImageTraps, alpha_of_an_image_makes_voids_and_leaves_heights_alone) {
    const std::string row1 = packed16({1000, 65535, 0, 0}, true);
    const std::string row2 = packed16({1100, 65535, 1200, 30000}, true);  // half opaque: not scaled
    const LoadedTerrain loaded = load("a.png", png(2, 2, 16, 4, {row1, row2}));
    EXPECT_EQ(heights(loaded), (std::vector<float>{1000, 1100, 1100, 1200}));
    EXPECT_EQ(loaded.field->info().void_count, 1U);
}

// -- place and spacing

TEST_F(ElevationTraps, a_map_that_is_not_true_to_length_is_taken_to_the_ground) {
    const auto place = [this](int epsg, double west, double north) {
        Tiff tiff(2, 2, 16, 2, packed16({1, 2, 3, 4}, false));
        tiff.doubles(33550, {10, 10, 0}).doubles(33922, {0, 0, 0, west, north, 0});
        tiff.shorts(34735, {1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, epsg});
        return load("a.tif", tiff.str());
    };
    // Web Mercator draws with the ellipsoid's longitude on a sphere of a = 6378137 m: at latitude
    // phi, tan(phi/2 + pi/4) = exp(y / a), a metre of the map is N cos(phi) / a east, with
    // N = a / (1 - e^2 sin^2 phi)^(1/2): 0.501244 at y = 8.4e6.
    const LoadedTerrain web = place(3857, -13000000, 8400000);
    EXPECT_NEAR(web.field->info().spacing.x, 5.01244, 2e-5);
    EXPECT_NEAR(web.field->info().origin.x, 0.501244 * -12999995, 30);
    EXPECT_THAT(web.provenance.warnings,
                ElementsAre(HasSubstr("WGS 84 / Pseudo-Mercator (EPSG:3857): a metre of the map is "
                                      "0.5012 m on the ground east")));
    const LoadedTerrain utm = place(32610, 500000, 5200000);
    EXPECT_EQ(utm.field->info().spacing, glm::dvec2(10));
    EXPECT_THAT(utm.provenance.warnings, IsEmpty());
    EXPECT_EQ(utm.provenance.reference, "WGS 84 / UTM zone 10N (EPSG:32610); metres");
    // Feet far outside of their zone: the map's, with a warning; and heights in what?
    const LoadedTerrain feet = place(2285, 500000, 5200000);
    EXPECT_NEAR(feet.field->info().spacing.x, 10 * 1200.0 / 3937, 1e-12);
    EXPECT_THAT(feet.provenance.warnings,
                ElementsAre(HasSubstr("and spacing is the map's"),
                            HasSubstr("the unit of its heights is not named")));
}

TEST_F(ElevationTraps, degrees_turned_into_metres_are_warned_of) {
    const LoadedTerrain loaded = load(
        "a.tif", Tiff(2, 2, 16, 2, packed16({1, 2, 3, 4}, false)).place(0.1, 6, 45, true).str());
    EXPECT_THAT(
        loaded.provenance.warnings,
        ElementsAre(HasSubstr("geographic (WGS 84 (EPSG:4326)): degrees became metres at the "
                              "centre latitude 44.9000")));
    EXPECT_THAT(loaded.provenance.reference, HasSubstr("degrees turned into metres at latitude"));
}

TEST_F(ElevationTraps, a_reference_without_projs_database_leaves_the_spacing_open) {
    // In a process of its own: PROJ looks for its database once.
    Tiff tiff(2, 2, 16, 2, packed16({1, 2, 3, 4}, false));
    tiff.doubles(33550, {10, 10, 0}).doubles(33922, {0, 0, 0, 1500000, 500000, 0});
    tiff.shorts(34735, {1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 2285});
    const std::string file = folder_.write("feet.tif", tiff.str()).string();
    const auto run = [&](const std::string& environment, const std::string& options) {
        const std::string output = (folder_.path() / "out").string();
        const std::string command = environment + " '" LODBENCH_BINARY "' terrain info '" + file +
                                    "' " + options + " > '" + output + "' 2>&1";
        EXPECT_NE(std::system(command.c_str()), -1);
        std::ifstream stream(output);
        return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    EXPECT_THAT(run("", ""), HasSubstr("spacing   3.04801 m east"));
    const std::string lost = "PROJ_LIB=/nonexistent PROJ_DATA=/nonexistent";
    EXPECT_THAT(run(lost, ""), HasSubstr("do PROJ_LIB or PROJ_DATA name another installation's "
                                         "folder?); give the spacing in metres"));
    EXPECT_THAT(run(lost, "--spacing 3"), HasSubstr("spacing   3 m east"));
}

TEST_F(ElevationTraps, heights_in_the_feet_of_a_compound_system_are_metres) {
    Tiff tiff(2, 2, 16, 2, packed16({1000, 2, 3, 4}, false));
    tiff.doubles(33550, {10, 10, 0}).doubles(33922, {0, 0, 0, 500000, 5200000, 0});
    // UTM 10 N with NAVD88 height (ftUS), EPSG:6360.
    tiff.shorts(34735, {1,    1, 0, 5,     1024, 0, 1, 1,    1025, 0, 1, 1,
                        3072, 0, 1, 32610, 4096, 0, 1, 6360, 4099, 0, 1, 9003});
    EXPECT_NEAR(load("a.tif", tiff.str()).field->info().max_height, 1000 * 1200.0 / 3937, 1e-4);
}

TEST_F(ElevationTraps, depths_need_a_scale_that_turns_them) {
    Tiff tiff(2, 2, 16, 2, packed16({1000, 2, 3, 4}, false));
    tiff.doubles(33550, {10, 10, 0}).doubles(33922, {0, 0, 0, 500000, 5200000, 0});
    // UTM 10 N with MSL depth, EPSG:5715.
    tiff.shorts(34735,
                {1, 1, 0, 4, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32610, 4096, 0, 1, 5715});
    TerrainSource given = source("a.tif", tiff.str());
    EXPECT_EQ(refusal(given),
              "a.tif: its heights count downwards, as depths, which a negative scale turns; give "
              "the vertical scale (metres per unit)");
    given.vertical_scale = -1;
    EXPECT_EQ(load_terrain(given)->info().min_height, -1000.0F);
}

TEST_F(ElevationTraps, samples_of_signed_bytes_are_signed) {
    const LoadedTerrain loaded =
        load("a.tif", Tiff(2, 2, 8, 2, "\xfb\x06\x07\x80").place(10, 0, 0, false).str());
    EXPECT_EQ(heights(loaded), (std::vector<float>{-5, 6, 7, -128}));
}

TEST_F(ElevationTraps, a_scale_of_0_in_the_file_is_refused) {
    const std::string words =
        "<GDALMetadata><Item name=\"SCALE\" sample=\"0\" role=\"scale\">0</Item></GDALMetadata>";
    EXPECT_EQ(refusal("a.tif", Tiff(2, 2, 16, 2, packed16({1, 2, 3, 4}, false))
                                   .place(10, 0, 0, false)
                                   .ascii(42112, words)
                                   .str()),
              "a.tif: vertical scale 0, offset 0; both must be finite, the scale not 0");
}

TEST_F(ElevationTraps, a_tiff_takes_its_place_from_a_world_file) {
    folder_.write("a.tfw", "10\n0\n0\n-10\n500005\n5199995\n");
    const LoadedTerrain loaded =
        load("a.tif", Tiff(2, 2, 16, 2, packed16({1, 2, 3, 4}, false)).str());
    EXPECT_EQ(loaded.field->info().spacing, glm::dvec2(10));
    EXPECT_EQ(loaded.field->info().origin, glm::dvec2(500005, 5199985));
    EXPECT_FALSE(loaded.provenance.spacing_assumed);
    // And what its numbers are from a .prj.
    folder_.write("b.tfw", "0.001\n0\n0\n-0.001\n6\n45\n");
    folder_.write("b.prj",
                  "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,"
                  "298.257223563]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]");
    const LoadedTerrain degrees =
        load("b.tif", Tiff(2, 2, 16, 2, packed16({1, 2, 3, 4}, false)).str());
    EXPECT_NEAR(degrees.field->info().spacing.y, 111.13, 0.01);
}

TEST_F(Traps, images_take_their_place_from_a_world_file) {
    const std::string image("P5 2 2 255\n\x01\x02\x03\x04", 15);
    const TerrainSource given = source("a.pgm", image);
    const auto with = [&](const std::string& name, const std::string& text) {
        folder_.write(name, text);
        const std::string said = refusal(given);
        const LoadedTerrain loaded =
            said == "accepted" ? load_terrain_with_provenance(given) : LoadedTerrain{};
        std::filesystem::remove(folder_.path() / name);
        return std::pair{said, loaded.field ? loaded.field->info().spacing : glm::dvec2(0)};
    };
    const std::string place = "10\n0\n0\n-20\n500005\n5199995\n";
    for (const char* name : {"a.wld", "a.pmw", "a.pgmw", "a.PMW"}) {
        EXPECT_EQ(with(name, place).second, glm::dvec2(10, 20)) << name;
    }
    EXPECT_EQ(with("a.wld", "10\n1\n1\n-10\n0\n0\n").first,
              "a.wld: rotated by terms 1 and 1; warp the image upright with gdalwarp");
    EXPECT_EQ(
        with("a.wld", "10\n0\n0\n10\n0\n0\n").first,
        "a.wld: pixels of 10 by 10; the first must be positive, the second negative: turn the "
        "image over, north to the top");
    EXPECT_EQ(
        with("a.wld", "10,5\n0\n0\n-10\n0\n0\n").first,
        "a.wld: number 1 of a world file is \"10,5\"; expected six numbers, with decimal points");
    EXPECT_EQ(with("a.wld", "10\n0\n0\n").first,
              "a.wld: number 4 of a world file is \"\"; expected six numbers, with decimal points");
    EXPECT_EQ(
        with("a.wld", "0.001\n0\n0\n-0.001\n6\n45\n").first,
        "a.pgm: pixels of 0.001 x 0.001 in a.wld look like degrees; give the spacing in metres");
    folder_.write("a.prj", "PROJCS[]");
    EXPECT_EQ(with("a.wld", place).first,
              "a.pgm: what the numbers of a.wld are stands in a.prj, which is not read beside an "
              "image; give the spacing in metres");
}

TEST(Degrees, are_told_from_metres_by_range_and_fineness) {
    EXPECT_TRUE(looks_like_degrees({-122, 46}, {1.0 / 12, 1.0 / 12}, 3, 4));
    EXPECT_TRUE(looks_like_degrees({0, 0}, {0.001, 0.001}, 10, 10));
    EXPECT_TRUE(looks_like_degrees({-179.5, -89.5}, {1, 1}, 180, 360));
    EXPECT_FALSE(looks_like_degrees({0, 0}, {0.5, 0.5}, 100, 100));
    EXPECT_FALSE(looks_like_degrees({0.25, 0.25}, {0.5, 0.5}, 100, 100));
    EXPECT_FALSE(looks_like_degrees({500000, 5200000}, {0.5, 0.5}, 100, 100));
    EXPECT_FALSE(looks_like_degrees({100, 20}, {30, 30}, 2, 2));
}

// -- the bytes themselves

TEST_F(Traps, swapped_bytes_are_warned_of) {
    std::vector<int> samples;
    for (int i = 0; i < 64 * 64; ++i) samples.push_back(1000 + i / 64 * 5 + i % 64 * 3);
    const auto warnings = [this](const std::string& bytes, const std::string& type) {
        folder_.write("a.raw.toml",
                      "rows = 64\ncolumns = 64\nendian = \"little\"\nspacing = 10\n"
                      "type = \"" +
                          type + "\"\n");
        return load("a.raw", bytes).provenance.warnings;
    };
    for (const char* type : {"int16", "uint16"}) {
        EXPECT_THAT(warnings(packed16(samples, true), type),
                    testing::Contains(HasSubstr("check the order of bytes")))
            << type;
        EXPECT_THAT(warnings(packed16(samples, false), type), IsEmpty()) << type;
    }
    // Eight bits moved up by eight are right as they are.
    for (int& sample : samples) sample = (sample / 100) << 8;
    EXPECT_THAT(warnings(packed16(samples, false), "int16"), IsEmpty());
}

TEST_F(ElevationTraps, srtm_tiles_are_refused_for_what_is_wrong_with_them) {
    EXPECT_THAT(
        refusal("N46W123.hgt", std::string(200000, '\1')),
        HasSubstr("it has 200000 bytes, and SRTM tiles have 2884802 (1201 x 1201 samples, 3 "
                  "seconds apart) or 25934402 (3601 x 3601, 1 second): it is truncated"));
    EXPECT_THAT(refusal("rainier.hgt", std::string(std::size_t(2) * 1201 * 1201, '\1')),
                HasSubstr("its name must say where it lies: N46W122.hgt"));
    EXPECT_THAT(refusal("a.flt", std::string(24, '\0')),
                HasSubstr("its header a.hdr does not lie beside it"));
}

TEST_F(ElevationTraps, blocks_that_are_not_in_the_file_are_warned_of) {
    // No block: offset and size of the strip are 0.
    std::string file =
        Tiff(2, 2, 16, 2, packed16({1, 2, 3, 4}, false)).place(10, 0, 0, false).str();
    for (const int tag : {273, 279}) {
        const std::string entry =
            test::Bytes(false).number(std::uint64_t(tag), 2).number(4, 2).number(1, 4).str();
        file.replace(file.find(entry) + entry.size(), 4, std::string(4, '\0'));
    }
    EXPECT_THAT(load("a.tif", file).provenance.warnings,
                testing::Contains(HasSubstr("100 % of its blocks are not in the file")));
}

TEST_F(Traps, what_was_fetched_in_a_rasters_place_is_named) {
    for (const char* name : {"a.tif", "b.asc", "N46W122.hgt", "c.png"}) {
        const auto said = [&](std::string_view bytes) {
            return refusal(name, bytes).substr(std::string(name).size());
        };
        EXPECT_EQ(
            said("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 3\n"),
            ": is a pointer of Git LFS, not the raster itself; fetch that with `git lfs pull`");
        EXPECT_THAT(said("<!DOCTYPE html><title>404"), StartsWith(": is a web page"));
        EXPECT_THAT(said("<HTML>"), StartsWith(": is a web page"));
        EXPECT_EQ(said("\x1f\x8b\x08"), ": is compressed by gzip; unpack it first");
        EXPECT_EQ(said("PK\x03\x04"), ": is a zip archive; unpack it first");
    }
}

// -- ASCII grids

const std::string kHead =
    "ncols 3\nnrows 2\nxllcorner 500\nyllcorner 800\ncellsize 25\nNODATA_value -9999\n";
const std::string kCells = "1.5 2 3\n4 -9999 6\n";

std::string replaced(std::string text, const std::string& one, const std::string& other) {
    return text.replace(text.find(one), one.size(), other);
}

TEST_F(ElevationTraps, ascii_grids_in_other_encodings_are_refused) {
    EXPECT_EQ(
        refusal("a.asc", "\xEF\xBB\xBF" + kHead + kCells),
        "a.asc: begins with a byte order mark of UTF-8; save the grid as plain text without one");
    for (const char* mark : {"\xFF\xFE", "\xFE\xFF", ""}) {
        std::string wide = mark;
        for (const char c : kHead + kCells) wide += {c, '\0'};
        EXPECT_THAT(refusal("a.asc", wide), StartsWith("a.asc: is text of UTF-16")) << mark;
    }
    EXPECT_EQ(refusal("a.asc", "ncols 3\rnrows 2\r1 2\r"),
              "a.asc: line 1: lines end in a carriage return alone; end them in line feeds");
}

TEST_F(ElevationTraps, ascii_grids_are_held_to_their_grammar) {
    const auto changed = [this](const std::string& one, const std::string& other) {
        return refusal("a.asc", replaced(kHead + kCells, one, other));
    };
    EXPECT_EQ(changed("nrows", " nrows"),
              "a.asc: line 2: nrows is indented; begin header lines in the first column");
    EXPECT_EQ(changed("6\n", "abc\n"),
              "a.asc: the cell at row 1, column 2 is \"abc\", which is no number; write one with a "
              "decimal point, or the no-data value");
    EXPECT_THAT(changed("1.5", "1,5"), HasSubstr("the cell at row 0, column 0 is \"1,5\""));
    EXPECT_THAT(changed("1.5", "1.5D+03"), HasSubstr("is no number"));
    EXPECT_THAT(changed("1.5", "*****"), HasSubstr("is no number"));
    EXPECT_THAT(changed("1.5", std::string(5000, '1')), HasSubstr("is no number"));
    EXPECT_THAT(changed(" 6", ""), HasSubstr("ends after 5 cells, but 2 rows x 3 columns make 6"));
    EXPECT_THAT(changed("6\n", "6 7\n"), HasSubstr("more cells than the 2 rows x 3 columns"));
    EXPECT_THAT(changed("cellsize 25\n", ""), HasSubstr("the header has no cellsize"));
    EXPECT_THAT(changed("yllcorner 800\n", ""), HasSubstr("neither yllcorner nor yllcenter"));
    EXPECT_THAT(changed("nrows 2", "nrows 2.5"),
                HasSubstr("nrows is 2.5; expected a whole number"));
    EXPECT_THAT(changed("nrows 2", "nrows 2 3"),
                HasSubstr("nrows is \"2 3\"; expected one number"));
    EXPECT_THAT(changed("nrows 2", "ncols 3"), HasSubstr("line 2: ncols is given twice"));
    EXPECT_THAT(changed("NODATA_value", "NODATE"), HasSubstr("line 6: \"NODATE\" is neither"));
}

TEST_F(ElevationTraps, ascii_grids_in_every_allowed_form_are_read) {
    const std::vector<float> expected = {1.5, 2, 3, 4, 4, 6};
    const auto read = [this](const std::string& text) { return heights(load("a.asc", text)); };
    EXPECT_EQ(read(kHead + " 1.5  2\t3\n 4 -9999 6"), expected);
    EXPECT_EQ(read(kHead + "1.5\n2\n3\n+4\n-9999\n6e0\n\n"), expected);
    EXPECT_EQ(read(replaced(kHead + kCells, "-9999 6", "nan 6")), expected);
    EXPECT_EQ(read(replaced(kHead, "cellsize 25", "dx 25\ndy 25") + kCells), expected);
    std::string lines;
    for (const char c : kHead + kCells)
        lines += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_EQ(read(lines), expected);
}

TEST_F(ElevationTraps, cells_of_an_ascii_grid_keep_their_value) {
    const auto read = [this](const std::string& cells) {
        return heights(load("a.asc", kHead + cells));
    };
    // GDAL's driver fails at a nan among integers, and reads the rest as float32.
    EXPECT_EQ(read("1 nan 3\n4 5 6\n")[1], 3.0F);
    EXPECT_EQ(read("1 2 3\n4 5 6.75\n")[5], 6.75F);
    TerrainSource given =
        source("b.asc", kHead + "16777211 16777212 16777213\n16777214 16777215 16777217.5\n");
    given.vertical_offset = -16777210;
    EXPECT_EQ(load_terrain(given)->samples()[5], 7.5F);
    given = source("c.asc", kHead + "1 2 3\n4 5 3000000000\n");
    given.vertical_scale = 0.001;
    EXPECT_EQ(load_terrain(given)->samples()[5], 3e6F);
}

// A cell may lie across two of the pieces in which the file is read.
TEST_F(ElevationTraps, cells_across_the_pieces_of_a_long_grid_are_whole) {
    const int rows = 700;
    const int columns = 999;
    std::string text = "ncols 999\nnrows 700\nxllcorner 500\nyllcorner 800\ncellsize 25\n";
    for (int i = 0; i < rows * columns; ++i) text += i % 7 == 0 ? "12 " : "123456 ";
    EXPECT_EQ(load("a.asc", text).field->info().columns, columns);
    text.resize(text.size() - 8);
    EXPECT_THAT(refusal("a.asc", text), HasSubstr("ends after 699299 cells"));
}

}  // namespace
}  // namespace lodbench::terrain
