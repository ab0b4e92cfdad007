// The pyramid of means that lies in a file, against the one in memory.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

// The room is a plugin, not a library.
#include "persistent_grid/cache_file.cpp"
#include "persistent_grid/mean_pyramid.cpp"
#include "support/fake_terrain.h"
#include "support/method_fixture.h"
#include "support/run_lodbench.h"

namespace lodbench::persistent_grid {
namespace {

namespace fs = std::filesystem;
using test::ScratchFolder;

std::vector<Level> in_memory(const terrain::HeightField& terrain) {
    return make_pyramid(Level{terrain.info().columns,
                              terrain.info().rows,
                              {terrain.samples().begin(), terrain.samples().end()}});
}

/// Every texel of every level, to the bit, and the repeated edge.
void expect_means(const MeanPyramid& pyramid, const std::vector<Level>& levels) {
    ASSERT_EQ(pyramid.level_count(), int(levels.size()));
    std::vector<float> tile(kTileSampleCount);
    const TilePyramid tiles = pyramid.tiles();
    for (int l = 0; l < tiles.levels(); ++l) {
        const Level& level = levels[std::size_t(l)];
        for (int row = 0; row < tiles.rows(l); ++row) {
            for (int column = 0; column < tiles.columns(l); ++column) {
                pyramid.read_tile({l, row, column}, tile);
                for (int r = 0; r < kTileSamples; ++r) {
                    for (int c = 0; c < kTileSamples; ++c) {
                        ASSERT_EQ(tile[std::size_t(r * kTileSamples + c)],
                                  level.at(std::min(row * kTileCells + r, level.rows - 1),
                                           std::min(column * kTileCells + c, level.columns - 1)))
                            << "level " << l << ", tile " << row << ", " << column << ": " << r
                            << ", " << c;
                    }
                }
            }
        }
    }
    for (int l = tiles.levels(); l < int(levels.size()); ++l) {
        EXPECT_EQ(pyramid.small(l).heights, levels[std::size_t(l)].heights) << l;
    }
}

TEST(PgmMeanPyramid, holds_the_means_of_the_one_in_memory_to_the_bit) {
    for (const auto& [rows, columns] : {std::pair{2, 2},
                                        {65, 65},
                                        {66, 66},
                                        {129, 257},
                                        {130, 2},
                                        {200, 1026},
                                        {513, 191},
                                        {640, 640}}) {
        const ScratchFolder folder;
        const auto terrain = test::hills(rows, columns);
        const MeanPyramid pyramid(*terrain, {folder.path()});
        SCOPED_TRACE(fmt::format("{} x {}", rows, columns));
        expect_means(pyramid, in_memory(*terrain));
        EXPECT_FALSE(pyramid.was_cached());
        if (pyramid.tiles().levels() == 1) {
            EXPECT_TRUE(fs::is_empty(folder.path())) << "small enough for memory";
        } else {
            EXPECT_EQ(fs::file_size(pyramid.file()), pyramid.file_bytes());
        }
    }
}

class CachedPyramid : public testing::Test {
protected:
    void change_byte(std::uint64_t place) const {
        std::fstream file(file_, std::ios::in | std::ios::out | std::ios::binary);
        file.seekg(std::streamoff(place));
        const char byte = char(file.get());
        file.seekp(std::streamoff(place));
        file.put(char(byte ^ 16));
        ASSERT_TRUE(file.good());
    }
    void expect_made_again() const {
        const MeanPyramid pyramid(*terrain_, {folder_.path()});
        EXPECT_FALSE(pyramid.was_cached());
        expect_means(pyramid, in_memory(*terrain_));
        EXPECT_TRUE(MeanPyramid(*terrain_, {folder_.path()}).was_cached());
    }

    ScratchFolder folder_;
    std::shared_ptr<const terrain::HeightField> terrain_ = test::hills(200, 150);
    fs::path file_ = MeanPyramid(*terrain_, {folder_.path()}).file();
};

TEST_F(CachedPyramid, is_found_again_and_the_only_file) {
    const MeanPyramid pyramid(*terrain_, {folder_.path()});
    EXPECT_TRUE(pyramid.was_cached());
    EXPECT_EQ(pyramid.file(), file_);
    expect_means(pyramid, in_memory(*terrain_));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "nothing unfinished";
}

TEST_F(CachedPyramid, is_made_again_when_a_byte_has_changed) {
    const std::uint64_t size = fs::file_size(file_);
    for (const std::uint64_t place : {std::uint64_t(3), std::uint64_t(35), std::uint64_t(57),
                                      std::uint64_t(66), size / 2, size - 1}) {
        change_byte(place);
        SCOPED_TRACE(place);
        expect_made_again();
    }
}

TEST_F(CachedPyramid, is_made_again_when_it_was_cut_short_or_has_grown) {
    const std::uint64_t size = fs::file_size(file_);
    for (const std::uint64_t length : {std::uint64_t(0), std::uint64_t(40), size - 1, size + 1}) {
        fs::resize_file(file_, length);
        SCOPED_TRACE(length);
        expect_made_again();
    }
}

TEST_F(CachedPyramid, is_not_taken_for_that_of_another_terrain) {
    const auto other = test::flat(200, 150, 7);
    const MeanPyramid pyramid(*other, {folder_.path()});
    EXPECT_FALSE(pyramid.was_cached());
    // Not even under its name.
    fs::copy_file(file_, pyramid.file(), fs::copy_options::overwrite_existing);
    const MeanPyramid again(*other, {folder_.path()});
    EXPECT_FALSE(again.was_cached());
    expect_means(again, in_memory(*other));
}

TEST_F(CachedPyramid, is_made_where_a_folder_can_be_written_to) {
    const ScratchFolder second;
    const fs::path not_a_folder = folder_.path() / "file";
    std::ofstream(not_a_folder) << "x";
    const MeanPyramid pyramid(*test::flat(100, 100, 3), {not_a_folder, second.path() / "new"});
    EXPECT_EQ(pyramid.file().parent_path(), second.path() / "new");
    try {
        const MeanPyramid nowhere(*test::flat(100, 100, 4), {not_a_folder});
        FAIL() << "was made in a file";
    } catch (const EnvironmentError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr(not_a_folder.string()));
        EXPECT_THAT(error.what(), testing::HasSubstr("set XDG_CACHE_HOME"));
    }
}

TEST_F(CachedPyramid, leaves_nothing_behind_when_the_terrain_cannot_be_read) {
    struct Failing : Terrain {
        Failing() {
            info_ = test::flat(500, 500, 1)->info();
            info_.checksum = "0123456789abcdef";
        }
        void copy_samples(const SampleRect& rect, std::span<float>) const override {
            if (rect.row > 200) throw TerrainError("the disk is gone");
        }
        void copy_tile(const TileId&, std::span<float>) const override {}
        TileSummary find_summary(const TileId&) const override { return {}; }
    } const terrain;
    const ScratchFolder empty;
    EXPECT_THROW(MeanPyramid(terrain, {empty.path()}), TerrainError);
    EXPECT_TRUE(fs::is_empty(empty.path()));
}

TEST_F(CachedPyramid, without_a_folder_or_a_checksum_no_file_is_left) {
    const MeanPyramid unnamed(*terrain_, {});
    EXPECT_EQ(unnamed.file(), "");
    expect_means(unnamed, in_memory(*terrain_));
    const ScratchFolder empty;
    test::FakeTerrain terrain(300, 300);
    terrain.height = [](int row, int) { return float(row); };
    const MeanPyramid pyramid(terrain, {empty.path()});
    std::vector<float> tile(kTileSampleCount);
    pyramid.read_tile({1, 0, 0}, tile);
    EXPECT_EQ(tile[kTileSamples], 2.5F);  // rows 2 and 3
    EXPECT_TRUE(fs::is_empty(empty.path()));
}

// What changes under an open pyramid is seen when it is read.
TEST_F(CachedPyramid, a_tile_that_is_damaged_later_is_refused_by_name) {
    const MeanPyramid pyramid(*terrain_, {folder_.path()});
    change_byte(pyramid.file_bytes() - 1);
    std::vector<float> tile(kTileSampleCount);
    try {
        pyramid.read_tile(pyramid.tiles().root(), tile);
        FAIL() << "was read";
    } catch (const TerrainError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr(file_.string()));
        EXPECT_THAT(error.what(), testing::HasSubstr("tile (level 2, row 0, column 0)"));
    }
}

TEST(PgmCacheFolders, begin_with_the_users_own) {
    ASSERT_EQ(setenv("XDG_CACHE_HOME", "/tmp/of-mine", 1), 0);
    EXPECT_EQ(cache_folders().front(), "/tmp/of-mine/lodbench");
    // A path that is not absolute is to be passed over (XDG base directory specification).
    ASSERT_EQ(setenv("XDG_CACHE_HOME", "relative", 1), 0);
    ASSERT_EQ(setenv("HOME", "/home/of-mine", 1), 0);
    EXPECT_EQ(cache_folders().front(), "/home/of-mine/.cache/lodbench");
}

}  // namespace
}  // namespace lodbench::persistent_grid
