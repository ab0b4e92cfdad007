// Heights written as raw files: they read back to the bit, and are there whole or not at all.

#include "terrain/export_raw.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "api/error.h"
#include "support/raster_files.h"

namespace lodbench::terrain {
namespace {

TEST(ExportRaw, reads_back_to_the_bit) {
    const test::TemporaryFolder folder;
    TerrainInfo info;
    info.name = "a \"quoted\\\" name\nof two lines";
    info.rows = 2;
    info.columns = 3;
    info.spacing = {63.968827647644254, 1.0 / 3};
    info.origin = {-9365036.367615119, 1e-300};
    info.void_count = 4;
    const HeightField field(info, {0.1F, 0.0F, 1e-42F, 9.9e6F, -8848.86F, 1.0F / 3});
    write_raw(field, folder.path() / "a.raw");

    TerrainSource source;
    source.file = folder.path() / "a.raw";
    const auto back = load_terrain(source);
    EXPECT_TRUE(std::ranges::equal(back->samples(), field.samples()));
    EXPECT_EQ(back->info().checksum, field.info().checksum);
    EXPECT_EQ(back->info().name, info.name);
    EXPECT_EQ(back->info().spacing, info.spacing);
    EXPECT_EQ(back->info().origin, info.origin);
    EXPECT_EQ(back->info().void_count, 4U);
}

TEST(ExportRaw, replaces_what_was_there_and_leaves_nothing_beside_it) {
    const test::TemporaryFolder folder;
    TerrainSource source;
    source.synthetic = "ramp";
    source.rows = source.columns = 5;
    write_raw(*load_terrain(source), folder.path() / "a.raw");
    source.rows = 3;
    write_raw(*load_terrain(source), folder.path() / "a.raw");
    TerrainSource written;
    written.file = folder.path() / "a.raw";
    EXPECT_EQ(load_terrain(written)->info().rows, 3);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

TEST(ExportRaw, refuses_other_names_and_missing_folders) {
    const test::TemporaryFolder folder;
    TerrainSource source;
    source.synthetic = "plane";
    const auto field = load_terrain(source);
    EXPECT_THROW(write_raw(*field, folder.path() / "a.tif"), InputError);
    EXPECT_THROW(write_raw(*field, folder.path() / "none" / "a.raw"), InputError);
    std::filesystem::create_directory(folder.path() / "a.raw");
    EXPECT_THROW(write_raw(*field, folder.path() / "a.raw"), InputError);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace lodbench::terrain
