// Rasters that a module reads: in a process of their own, and the same as in this one.

#include "terrain/raster.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <sstream>

#include "api/error.h"
#include "base/modules.h"
#include "support/raster_files.h"
#include "terrain/raster_reader.h"

namespace lodbench::terrain {
namespace {

using testing::HasSubstr;
using testing::Not;

/// What this process has mapped.
std::string maps() {
    std::ostringstream text;
    text << std::ifstream("/proc/self/maps").rdbuf();
    return text.str();
}

std::vector<std::uint32_t> bits_of(const std::vector<float>& heights) {
    std::vector<std::uint32_t> bits;
    for (const float height : heights) bits.push_back(std::bit_cast<std::uint32_t>(height));
    return bits;
}

void expect_equal(const Raster& one, const Raster& other) {
    EXPECT_EQ(one.info.name, other.info.name);
    EXPECT_EQ(one.info.rows, other.info.rows);
    EXPECT_EQ(one.info.columns, other.info.columns);
    EXPECT_EQ(one.info.spacing, other.info.spacing);
    EXPECT_EQ(one.info.origin, other.info.origin);
    EXPECT_EQ(one.info.void_count, other.info.void_count);
    EXPECT_EQ(one.provenance.kind, other.provenance.kind);
    EXPECT_EQ(one.provenance.spacing_assumed, other.provenance.spacing_assumed);
    EXPECT_EQ(one.provenance.reference, other.provenance.reference);
    EXPECT_EQ(one.provenance.warnings, other.provenance.warnings);
    EXPECT_EQ(one.all_void, other.all_void);
    EXPECT_EQ(bits_of(one.heights), bits_of(other.heights));
}

std::string refusal(const TerrainSource& source) {
    try {
        (void)read_raster(source);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

class RasterFile : public testing::Test {
protected:
    /// Read before and after the module is here: apart, then in this process.
    static void expect_the_same_apart_and_here(const TerrainSource& source, const char* library,
                                               const auto& load_module) {
        if (maps().find(library) != std::string::npos) {
            GTEST_SKIP() << library << " is here by another test; ctest runs each by itself";
        }
        const auto before = base::loaded_modules();
        const Raster apart = read_raster(source);
        EXPECT_EQ(base::loaded_modules(), before);
        EXPECT_THAT(maps(), Not(HasSubstr(library)));
        load_module();
        EXPECT_EQ(base::loaded_modules().size(), before.size() + 1);
        EXPECT_THAT(maps(), HasSubstr(library));
        expect_equal(apart, read_raster(source));
    }
    test::TemporaryFolder folder_;
};

#ifdef LODBENCH_WITH_OIIO
TEST_F(RasterFile, of_an_image_leaves_no_library_behind) {
    TerrainSource source;
    const int side = 120;
    std::vector<std::string> rows;
    for (int row = 0; row < side; ++row) {
        std::vector<int> numbers;
        for (int column = 0; column < side; ++column) {
            numbers.push_back((row * 31 + column * 7) % 60000);
        }
        rows.push_back(test::packed16(numbers, true));
    }
    // A name of bytes that are no UTF-8.
    source.file = folder_.write("h\xff\xc3\xa4.png", test::png(side, side, 16, 0, rows));
    source.vertical_scale = 0.1;
    source.spacing_x = source.spacing_y = 1.0 / 3;
    source.no_data = 7;
    expect_the_same_apart_and_here(
        source, "OpenImageIO", [] { EXPECT_THROW((void)open_with_oiio("none.png"), InputError); });
}

TEST_F(RasterFile, that_is_damaged_is_refused_in_the_same_words) {
    TerrainSource source;
    source.file =
        folder_.write("t.png", test::png(3, 2, 16, 0, {test::packed16({1, 2, 3}, true), "short"}));
    const std::string apart = refusal(source);
    EXPECT_THAT(apart, HasSubstr("t.png: "));
    EXPECT_THROW((void)open_with_oiio("none.png"), InputError);
    EXPECT_EQ(refusal(source), apart);
}
#endif

TEST_F(RasterFile, that_the_memory_is_refused_is_not_put_down_to_the_file) {
#ifdef LODBENCH_WITH_OIIO
    const int side = 120;
    const std::vector<std::string> rows(side, std::string(2 * side, '\1'));
    TerrainSource source;
    source.file = folder_.write("a.png", test::png(side, side, 16, 0, rows));
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit little{4096, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &little);
    const bool apart = base::loaded_modules().empty();
    try {
        (void)read_raster(source);
        EXPECT_FALSE(apart) << "no limit was met";
    } catch (const EnvironmentError& error) {
        EXPECT_THAT(error.what(),
                    HasSubstr("a.png: its heights cannot be held in memory: File too"));
    }
    setrlimit(RLIMIT_FSIZE, &before);
#else
    GTEST_SKIP() << "built without OpenImageIO";
#endif
}

#ifdef LODBENCH_WITH_GDAL
TEST_F(RasterFile, of_elevations_leaves_no_library_behind) {
    TerrainSource source;
    source.file = folder_.write("a.asc",
                                "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 30\n"
                                "NODATA_value -9999\n1 2.5 3\n4 -9999 6\n");
    expect_the_same_apart_and_here(
        source, "libgdal", [] { EXPECT_THROW((void)open_with_gdal("none.asc"), InputError); });
    EXPECT_TRUE(std::isnan(read_raster(source).heights[4]));
}

TEST_F(RasterFile, of_a_place_that_is_none_is_refused_where_it_is_looked_at) {
    for (const char* corner : {"nan", "inf"}) {
        TerrainSource source;
        source.file = folder_.write(
            "n.asc", fmt::format("ncols 3\nnrows 2\nxllcorner {}\nyllcorner 200\ncellsize 30\n"
                                 "1 2 3\n4 5 6\n",
                                 corner));
        EXPECT_FALSE(std::isfinite(read_raster(source).info.origin.x)) << corner;
        EXPECT_THROW((void)load_terrain(source), InputError) << corner;
    }
}

TEST_F(RasterFile, of_more_than_comes_at_once_comes_whole) {
    const int side = 2100;
    std::vector<int> numbers;
    for (int i = 0; i < side * side; ++i) numbers.push_back(i * 7 % 30000);
    TerrainSource source;
    source.file =
        folder_.write("a.tif", test::Tiff(side, side, 16, 2, test::packed16(numbers, false))
                                   .place(30, 500000, 4000000, false)
                                   .str());
    const Raster raster = read_raster(source);
    ASSERT_EQ(raster.heights.size(), numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        ASSERT_EQ(raster.heights[i], float(numbers[i])) << i;
    }
}
#endif

}  // namespace
}  // namespace lodbench::terrain
