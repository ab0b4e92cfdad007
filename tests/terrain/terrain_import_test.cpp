// Images and raw files: samples come as they were written, and what is wrong is said in one line.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "api/error.h"
#include "support/raster_files.h"
#include "terrain/height_field.h"
#include "terrain/raster_reader.h"

namespace lodbench::terrain {
namespace {

using test::packed16;
using test::png;

class Import : public testing::Test {
protected:
    TerrainSource source(const std::string& name, std::string_view bytes,
                         std::string_view sidecar = {}) {
        TerrainSource made;
        made.file = folder_.write(name, bytes);
        if (!sidecar.empty()) folder_.write(name + ".toml", sidecar);
        return made;
    }
    /// The message, without the folder.
    std::string refusal(const TerrainSource& given) {
        try {
            (void)load_terrain(given);
        } catch (const InputError& error) {
            std::string text = error.what();
            const std::string folder = folder_.path().string() + "/";
            for (auto at = text.find(folder); at != std::string::npos; at = text.find(folder)) {
                text.erase(at, folder.size());
            }
            EXPECT_EQ(text.find('\n'), std::string::npos) << text;
            return text;
        }
        return "accepted";
    }
    static std::vector<float> heights(const TerrainSource& given) {
        const auto field = load_terrain(given);
        return {field->samples().begin(), field->samples().end()};
    }
    test::TemporaryFolder folder_;
};

class ImageImport : public Import {
protected:
    void SetUp() override {
        // Loads the module: what follows is read in this process.
        EXPECT_THROW((void)open_with_oiio("none.png"), InputError);
#ifndef LODBENCH_WITH_OIIO
        GTEST_SKIP() << "built without OpenImageIO";
#endif
    }
};

const std::string kRow1 = packed16({0, 1, 43798}, true);
const std::string kRow2 = packed16({65535, 256, 2}, true);

TEST_F(ImageImport, png_of_16_bits_is_read_natively) {
    EXPECT_EQ(heights(source("a.png", png(3, 2, 16, 0, {kRow1, kRow2}))),
              (std::vector<float>{0, 1, 43798, 65535, 256, 2}));
}

TEST_F(ImageImport, png_of_8_bits_is_read_natively) {
    EXPECT_EQ(heights(source("a.png", png(2, 2, 8, 0, {"\x01\x02", "\x03\xff"}))),
              (std::vector<float>{1, 2, 3, 255}));
}

TEST_F(ImageImport, sidecar_gives_what_the_image_cannot_say) {
    const auto field = load_terrain(source("a.png", png(3, 2, 16, 0, {kRow1, kRow2}),
                                           "name = \"Sound\"\nspacing = [160, 90.5]\n"
                                           "vertical_scale = 0.1\nvertical_offset = -5\n"
                                           "origin = [1000, -2000]\nno_data = 65535\n"));
    EXPECT_EQ(field->info().name, "Sound");
    EXPECT_EQ(field->info().spacing, glm::dvec2(160, 90.5));
    EXPECT_EQ(field->info().origin, glm::dvec2(1000, -2000));
    EXPECT_EQ(field->info().void_count, 1U);
    EXPECT_EQ(field->info().max_height, float(43798 * 0.1 - 5));
}

TEST_F(ImageImport, source_goes_before_the_sidecar) {
    TerrainSource given = source("a.png", png(3, 2, 16, 0, {kRow1, kRow2}),
                                 "spacing = 160\nvertical_scale = 0.1\nvertical_offset = 7\n");
    given.spacing_y = 30;
    given.vertical_scale = 2;
    const auto field = load_terrain(given);
    EXPECT_EQ(field->info().spacing, glm::dvec2(160, 30));
    EXPECT_EQ(field->samples()[1], 9.0F);
}

TEST_F(ImageImport, colours_and_stretched_bits_are_refused) {
    // Terrain-RGB turned to grey would be read, and be no terrain.
    const std::string text = refusal(source("a.png", png(2, 2, 8, 2, {"abcdef", "abcdef"})));
    EXPECT_EQ(text.find("a.png: 3 channels; a height map has one: heights coded in colours, as "
                        "terrain-RGB and terrarium tiles hold them, must be decoded first"),
              0U)
        << text;
    EXPECT_EQ(refusal(source("b.png", png(2, 2, 4, 0, {"\x12", "\x34"}))),
              "b.png: 4 bits a sample; convert it to 8 or 16");
}

TEST_F(ImageImport, damaged_and_absurd_images_are_refused_in_one_line) {
    testing::internal::CaptureStderr();
    const std::string whole = png(3, 2, 16, 0, {kRow1, kRow2});
    for (std::size_t length = 0; length < whole.size() - 16; length += 3) {
        const std::string text =
            refusal(source("t.png", std::string_view(whole).substr(0, length)));
        EXPECT_EQ(text.find("t.png: "), 0U) << length << ": " << text;
    }
    EXPECT_EQ(refusal(source("t.png", std::string_view(whole).substr(0, 60))),
              "t.png: is truncated: it ends before its end chunk; fetch or convert it anew");
    EXPECT_EQ(refusal(source("z.png", png(0, 0, 16, 0, {}))),
              "z.png: 0 rows x 0 columns are no size of a PNG; fetch or convert it anew");
    EXPECT_EQ(refusal(source("l.png", png(3, 1, 16, 0, {kRow1}))),
              "l.png: 1 rows x 3 columns make no surface; at least 2 x 2 samples are needed");
    EXPECT_EQ(
        refusal(source("h.png", png(1000000, 1000000, 16, 0, {kRow1}))),
        "h.png: 1000000 rows x 1000000 columns are more than the 68719476736 samples that are "
        "read; crop or thin it");
    EXPECT_EQ(refusal(source("e.png", "GIF89a, in truth")),
              "e.png: is no PNG (its first bytes say so); fetch or convert it anew");
    std::string changed = whole;
    changed[50] = char(changed[50] ^ 1);
    EXPECT_EQ(refusal(source("c.png", changed)).find("c.png: is damaged: a chunk before byte "),
              0U);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    // Whole chunks with too few rows in them: libpng finds out.
    EXPECT_EQ(refusal(source("s.png", png(3, 3, 16, 0, {kRow1, kRow2})))
                  .find("s.png: rows from 0 cannot be read"),
              0U);
}

TEST_F(ImageImport, every_sample_no_data_is_refused) {
    TerrainSource given = source("a.png", png(2, 2, 8, 0, {"\x07\x07", "\x07\x07"}));
    given.no_data = 7;
    EXPECT_EQ(refusal(given), "a.png: every sample is no-data (7); check the no-data value");
}

TEST_F(ImageImport, exr_of_floats_is_read_as_it_lies) {
    EXPECT_EQ(heights(source("a.exr", test::exr(3, 2, {-1.5F, 2, 3, 1e6F, 0.1F, -0.25F}))),
              (std::vector<float>{-1.5F, 2, 3, 1e6F, 0.1F, -0.25F}));
}

TEST_F(ImageImport, nan_is_refused_unless_it_is_the_no_data) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    TerrainSource given = source("a.exr", test::exr(3, 2, {1, 2, 3, 4, nan, 6}));
    EXPECT_EQ(
        refusal(given),
        "a.exr: the height at row 1, column 1 is nan; every height must be finite, or its value "
        "given as no-data");
    given.no_data = std::numeric_limits<double>::quiet_NaN();
    const auto field = load_terrain(given);
    EXPECT_EQ(field->info().void_count, 1U);
    EXPECT_EQ(field->samples()[4], 4.0F);  // (4 + 6 + 2) / 3
}

TEST_F(ImageImport, tiff_without_georeference_is_an_image) {
    const std::string tiff = test::Tiff(2, 2, 16, 2, packed16({-5, 6, 7, -32768}, false)).str();
    EXPECT_EQ(heights(source("a.tif", tiff)), (std::vector<float>{-5, 6, 7, -32768}));
}

TEST_F(Import, raw_of_16_bits_follows_its_sidecar) {
    const std::string words = "rows = 2\ncolumns = 3\n";
    const std::vector<int> samples = {1, 258, -2, 32767, -32768, 0};
    const auto load = [&](bool big, const std::string& type) {
        return heights(source(
            "a.raw", packed16(samples, big),
            words + "type = \"" + type + "\"\nendian = \"" + (big ? "big" : "little") + "\"\n"));
    };
    const std::vector<float> is_signed = {1, 258, -2, 32767, -32768, 0};
    const std::vector<float> is_unsigned = {1, 258, 65534, 32767, 32768, 0};
    EXPECT_EQ(load(false, "int16"), is_signed);
    EXPECT_EQ(load(true, "int16"), is_signed);
    EXPECT_EQ(load(false, "uint16"), is_unsigned);
    EXPECT_EQ(load(true, "uint16"), is_unsigned);
}

TEST_F(Import, raw_needs_a_sidecar_that_fits) {
    EXPECT_EQ(refusal(source("n.raw", "12345678")),
              "n.raw: a raw file needs n.raw.toml beside it, with rows, columns, type and endian");
    EXPECT_EQ(refusal(source("a.raw", "12345678", "rows = 2\ncolumns = 2\ntype = \"int16\"\n")),
              "a.raw.toml: endian is missing; a raw file needs rows, columns, type (int16, uint16, "
              "float32) and endian (little, big)");
    EXPECT_EQ(
        refusal(source("a.raw", "1234567",
                       "rows = 2\ncolumns = 2\ntype = \"int16\"\nendian = \"big\"\n")),
        "a.raw: 7 bytes, but 2 rows x 2 columns of 2 bytes make 8; the file is truncated or its "
        "size is given wrongly");
    EXPECT_EQ(
        refusal(source("a.raw", "12345678",
                       "rows = 2000000000\ncolumns = 2000000000\ntype = \"int16\"\n"
                       "endian = \"big\"\n")),
        "a.raw: 2000000000 rows x 2000000000 columns are more than the 68719476736 samples that "
        "are read; crop or thin it");
}

TEST_F(Import, sidecar_mistakes_name_their_line) {
    const auto mistake = [this](const std::string& line) {
        return refusal(source("a.raw", "12345678", "rows = 2\n" + line + "\n"));
    };
    EXPECT_EQ(mistake("colums = 2"),
              "a.raw.toml:2: unknown key \"colums\"; known: name, spacing, origin, vertical_scale, "
              "vertical_offset, no_data, voids_filled, rows, columns, type, endian");
    EXPECT_EQ(mistake("columns = 1"), "a.raw.toml:2: columns = 1; it must lie in 2 to 2147483647");
    EXPECT_EQ(mistake("columns = 2.0"), "a.raw.toml:2: columns must be a whole number");
    EXPECT_EQ(mistake("spacing = 0"), "a.raw.toml:2: spacing = 0; it must be greater than 0");
    EXPECT_EQ(mistake("spacing = [1]"), "a.raw.toml:2: spacing must hold two numbers, [x, y]");
    EXPECT_EQ(mistake("spacing = \"1\""), "a.raw.toml:2: spacing must be a finite number");
    EXPECT_EQ(mistake("spacing = true"), "a.raw.toml:2: spacing must be a finite number");
    EXPECT_EQ(mistake("vertical_scale = inf"),
              "a.raw.toml:2: vertical_scale must be a finite number");
    EXPECT_EQ(mistake("type = \"int8\""),
              "a.raw.toml:2: type = \"int8\"; known: int16, uint16, float32");
    EXPECT_EQ(mistake("endian = \"middle\""),
              "a.raw.toml:2: endian = \"middle\"; known: little, big");
    EXPECT_EQ(mistake("origin = 3"), "a.raw.toml:2: origin must hold two numbers, [x, y]");
    EXPECT_EQ(mistake("rows =").find("a.raw.toml:2: not TOML: "), 0U);
}

// OpenImageIO would stretch a maximum of 1000 to 65535.
TEST_F(Import, pgm_is_read_natively_whatever_its_maximum) {
    EXPECT_EQ(heights(source("a.pgm", "P5\n# a comment\n3 2\n1000\n" +
                                          packed16({0, 1, 1000, 500, 2, 3}, true))),
              (std::vector<float>{0, 1, 1000, 500, 2, 3}));
    EXPECT_EQ(heights(source("b.pgm", "P5 2 2 100\n\x01\x02\x03\x64")),
              (std::vector<float>{1, 2, 3, 100}));
}

TEST_F(Import, damaged_pgm_is_refused) {
    EXPECT_EQ(refusal(source("a.pgm", "P2 2 2 9 1 2 3 4")),
              "a.pgm: not a binary PGM (it does not begin with P5); convert it to one");
    EXPECT_EQ(refusal(source("a.pgm", "P5 2")), "a.pgm: the PGM header ends before its width");
    EXPECT_EQ(refusal(source("a.pgm", "P5 2 x")), "a.pgm: the PGM header ends before its height");
    EXPECT_EQ(refusal(source("a.pgm", "P5 2 2 70000\n1234")),
              "a.pgm: maximal value 70000; a PGM has 1 to 65535");
    EXPECT_EQ(
        refusal(source("a.pgm", "P5 2 2 255\n123")),
        "a.pgm: 14 bytes, but 2 rows x 2 columns of 1 bytes after a header of 11 make 15; the "
        "file is truncated or its size is given wrongly");
    EXPECT_EQ(refusal(source("a.pgm", "P5 999999999999999999 999999999999999999 255\n1")),
              "a.pgm: 999999999999999999 rows x 999999999999999999 columns are more than the "
              "68719476736 samples that are read; crop or thin it");
}

TEST_F(Import, what_is_no_raster_is_refused) {
    const std::string known = refusal(source("a.vrt", "<VRTDataset/>"));
    EXPECT_TRUE(known.starts_with("a.vrt: unknown extension '.vrt'; known: hgt, ")) << known;
    EXPECT_TRUE(known.find(", tiff, png, ") != known.npos) << known;
    EXPECT_EQ(refusal(source("a.tif.gz", "\x1f\x8b\x08")),
              "a.tif.gz: is compressed by gzip; unpack it first");
    EXPECT_TRUE(refusal(source("a", "P5")).starts_with("a: unknown extension ''; known: "));
    TerrainSource missing;
    missing.file = folder_.path() / "missing.png";
    missing.where = "scenario.toml:4";
    EXPECT_EQ(refusal(missing), "scenario.toml:4: missing.png: no such file");
    TerrainSource directory;
    directory.file = folder_.path() / "";
    EXPECT_NE(refusal(directory), "accepted");
    EXPECT_EQ(refusal(TerrainSource{}), "terrain: neither a file nor a synthetic form is named");
}

TEST_F(Import, overrides_that_are_not_numbers_are_refused) {
    TerrainSource given;
    given.synthetic = "plane";
    given.spacing_x = -1;
    EXPECT_EQ(refusal(given), "terrain: spacing (x) = -1; it must be positive and finite");
    given.spacing_x = 1;
    given.origin_y = std::numeric_limits<double>::infinity();
    EXPECT_EQ(refusal(given), "terrain: origin (y) = inf; it must be finite");
    given.origin_y.reset();
    given.vertical_scale = 2;
    EXPECT_EQ(refusal(given),
              "synthetic terrain 'plane': vertical scale, vertical offset and no-data belong to "
              "files; use the form's own parameters");
}

}  // namespace
}  // namespace lodbench::terrain
