// A store gives what a terrain in memory gives, to the bit.

#include "terrain/tile_store.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <set>
#include <thread>

#include "api/error.h"
#include "support/pyramid_tiles.h"
#include "support/tile_store_files.h"
#include "terrain/open_terrain.h"
#include "terrain/tile_store_check.h"
#include "terrain/tile_store_writer.h"

namespace lodbench::test {
namespace {

using terrain::HeightField;
using terrain::StoredTerrain;
using testing::HasSubstr;

constexpr std::pair<int, int> kSizes[] = {{2, 2},    {2, 300},  {65, 65},   {66, 65},  {64, 129},
                                          {100, 70}, {129, 66}, {257, 257}, {200, 65}, {131, 391}};

class TileStore : public testing::Test {
protected:
    [[nodiscard]] std::filesystem::path file(const std::string& name = "a.tiles") const {
        return folder_.path() / name;
    }
    TemporaryFolder folder_;
};

TEST_F(TileStore, of_float32_gives_what_the_field_gives) {
    for (const auto& [rows, columns] : kSizes) {
        SCOPED_TRACE(testing::Message() << rows << " x " << columns);
        const HeightField field = rough_field(rows, columns, 5);
        const TerrainInfo written = terrain::write_store(field, std::nullopt, file());
        EXPECT_EQ(written.checksum, field.info().checksum);
        const StoredTerrain store(file());
        expect_equal(store, field);
        const terrain::StoreReport report = terrain::check_tiles(store);
        EXPECT_THAT(report.faults, testing::IsEmpty());
        EXPECT_EQ(report.tiles, field.tiles().count());
    }
}

TEST_F(TileStore, of_steps_gives_the_nearest_multiples_and_all_that_follows_from_them) {
    for (const auto& [rows, columns] : kSizes) {
        for (const double step : {0.05, 0.5, 3.0}) {
            SCOPED_TRACE(testing::Message() << rows << " x " << columns << ", " << step);
            const HeightField field = rough_field(rows, columns, 6);
            terrain::write_store(field, step, file());
            const StoredTerrain store(file());
            std::vector<float> rounded;
            for (const float height : field.samples()) {
                rounded.push_back(float(step * std::nearbyint(double(height) / step)));
                // Half a step, and what float32 cannot hold of heights below 2048 m.
                EXPECT_NEAR(rounded.back(), height, step / 2 + 0x1p-13);
            }
            const HeightField served(field.info(), rounded);
            expect_equal(store, served);
            EXPECT_THAT(terrain::check_tiles(store).faults, testing::IsEmpty());
            // Written once more it is the same file.
            terrain::write_store(served, step, file("b.tiles"));
            EXPECT_EQ(bytes_of(file()), bytes_of(file("b.tiles")));
        }
    }
}

TEST_F(TileStore, of_steps_reaches_over_65535_of_them_wherever_they_lie) {
    for (const float base : {0.0F, -65535.0F, 40000.0F, -12345.0F}) {
        const TerrainInfo info = grid("range", 2, 2);
        const HeightField field(info, {base, base + 65535, base + 1, base + 32768});
        terrain::write_store(field, 1, file());
        expect_equal(StoredTerrain(file()), field);
        const HeightField wider(info, {base, base + 65536, base, base});
        try {
            terrain::write_store(wider, 1, file("b.tiles"));
            ADD_FAILURE();
        } catch (const InputError& error) {
            EXPECT_THAT(
                error.what(),
                HasSubstr(
                    "more than 65535 steps of 1 m apart: these rows alone need a step of 1.01"));
        }
    }
    const HeightField high(grid("high", 2, 2), {9e6F, 9e6F, 9e6F, 9e6F});
    EXPECT_THROW(terrain::write_store(high, 1, file("b.tiles")), InputError);
    for (const double step : {0.0, -1.0, 1e-7, 2e6, double(NAN)}) {
        EXPECT_THROW(terrain::write_store(high, step, file("b.tiles")), InputError);
    }
    EXPECT_FALSE(std::filesystem::exists(file("b.tiles")));
}

TEST_F(TileStore, has_no_negative_zero) {
    const std::vector<float> row = {-0.0F, 0.0F, -0.1F};
    for (const std::optional<double> step : {std::optional<double>(), std::optional(1.0)}) {
        terrain::StoreWriter writer(grid("zeros", 2, 3), step, file());
        writer.push(row);
        writer.push(row);
        const TerrainInfo info = writer.finish();
        const HeightField field(grid("zeros", 2, 3),
                                {0, 0, step ? 0 : -0.1F, 0, 0, step ? 0 : -0.1F});
        EXPECT_EQ(info.checksum, field.info().checksum);
        expect_equal(StoredTerrain(file()), field);
    }
}

TEST_F(TileStore, tiles_lie_in_z_order_level_upon_level_from_the_coarsest) {
    const HeightField field = rough_field(200, 300, 1);  // 4 x 5, 2 x 3, 1 x 2, 1 x 1
    terrain::write_store(field, std::nullopt, file());
    const StoredTerrain store(file());
    const auto place = [&](const TileId& tile) {
        return (store.layout().offset(tile) - store.layout().data_offset()) / (65 * 65 * 4);
    };
    EXPECT_EQ(place({3, 0, 0}), 0U);
    EXPECT_EQ(place({2, 0, 0}), 1U);
    EXPECT_EQ(place({2, 0, 1}), 2U);
    EXPECT_EQ(place({1, 0, 0}), 3U);
    EXPECT_EQ(place({1, 1, 0}), 5U);
    EXPECT_EQ(place({1, 0, 2}), 7U);
    const std::pair<int, int> order[] = {{0, 0}, {0, 1}, {1, 0}, {1, 1}, {0, 2}, {0, 3}, {1, 2},
                                         {1, 3}, {2, 0}, {2, 1}, {3, 0}, {3, 1}, {2, 2}, {2, 3},
                                         {3, 2}, {3, 3}, {0, 4}, {1, 4}, {2, 4}, {3, 4}};
    for (std::size_t i = 0; i < std::size(order); ++i) {
        EXPECT_EQ(place({0, order[i].first, order[i].second}), 9 + i);
    }
    std::set<std::uint64_t> places;
    for (const TileId& tile : all_tiles(field.tiles())) places.insert(place(tile));
    EXPECT_EQ(places.size(), field.tiles().count());
    EXPECT_EQ(*places.rbegin() + 1, field.tiles().count());
}

TEST_F(TileStore, reads_nothing_that_nobody_asks_for) {
    const HeightField field = rough_field(300, 300, 2);
    terrain::write_store(field, 0.5, file());
    const StoredTerrain store(file());
    constexpr std::uint64_t kTile = 65 * 65 * 2;
    EXPECT_EQ(store.bytes_read(), 0U);
    for (const TileId& tile : all_tiles(field.tiles())) (void)store.tile_summary(tile);
    EXPECT_EQ(store.bytes_read(), 0U);
    std::vector<float> heights(kTileSampleCount);
    store.read_tile({1, 0, 1}, heights);
    EXPECT_EQ(store.bytes_read(), kTile);
    std::vector<float> four(4);
    store.read({63, 63, 2, 2}, four);  // samples 63 and 64: the latter are the next tiles' own
    EXPECT_EQ(store.bytes_read(), 5 * kTile);
    for (int i = 0; i < 60; ++i) store.read({i, i, 2, 2}, four);
    EXPECT_EQ(store.bytes_read(), 5 * kTile) << "read has a cache";
    store.read_tile({0, 0, 0}, heights);
    EXPECT_EQ(store.bytes_read(), 6 * kTile) << "read_tile has none";
    // The cache is bounded: over the whole grid and again, and each tile is read anew.
    const HeightField wide = rough_field(2, 64 * 70, 2);
    terrain::write_store(wide, 0.5, file("w.tiles"));
    const StoredTerrain strip(file("w.tiles"));
    std::vector<float> row(64 * 70);
    strip.read({0, 0, 1, 64 * 70}, row);
    strip.read({0, 0, 1, 64 * 70}, row);
    EXPECT_EQ(strip.bytes_read(), 2 * 70 * kTile);
}

TEST_F(TileStore, serves_several_threads_at_once) {
    const HeightField field = rough_field(520, 390, 3);
    terrain::write_store(field, std::nullopt, file());
    const StoredTerrain store(file());
    std::atomic<int> wrong = 0;
    std::vector<std::thread> threads;
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        threads.emplace_back([&, seed] {
            base::SplitMix64 random(seed);
            const std::vector<TileId> tiles = all_tiles(field.tiles());
            std::vector<float> a(kTileSampleCount), b(kTileSampleCount);
            for (int i = 0; i < 200; ++i) {
                if (i % 2 == 0) {
                    const TileId tile = tiles[random.below(tiles.size())];
                    store.read_tile(tile, a);
                    field.read_tile(tile, b);
                } else {
                    const SampleRect rect{int(random.below(520 - 64)), int(random.below(390 - 64)),
                                          65, 65};
                    store.read(rect, a);
                    field.read(rect, b);
                }
                if (!same_bits(a, b)) ++wrong;
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, 0);
}

TEST_F(TileStore, names_the_tile_when_the_disk_fails_under_it) {
    const HeightField field = rough_field(300, 300, 4);
    terrain::write_store(field, std::nullopt, file());
    const StoredTerrain store(file());
    std::vector<float> heights(kTileSampleCount);
    std::vector<float> one(1);
    const auto failure = [&](const TileId& tile) -> std::string {
        try {
            store.read_tile(tile, heights);
        } catch (const TerrainError& error) {
            return error.what();
        }
        return "";
    };
    // Cut while it is open, within tile (0, 1, 3), which lies behind three quarters of its level.
    const std::uint64_t cut = store.layout().offset({0, 1, 3}) + 100;
    std::filesystem::resize_file(file(), cut);
    EXPECT_EQ(failure({0, 1, 2}), "");
    EXPECT_EQ(failure({0, 1, 3}),
              file().string() + ": tile (level 0, row 1, column 3): its bytes " +
                  std::to_string(cut - 100) + " to " + std::to_string(cut - 100 + 16900) +
                  " lie beyond the end of the file, which has been truncated; fetch or build it "
                  "anew");
    EXPECT_THROW(store.read({299, 299, 1, 1}, one), TerrainError);
    // The descriptor becomes that of a folder, which cannot be read: as good as a broken disk.
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
        std::error_code error;
        const auto target = std::filesystem::read_symlink(entry.path(), error);
        if (target != file()) continue;
        const int folder = open("/", O_RDONLY);
        dup2(folder, std::stoi(entry.path().filename()));
        close(folder);
        break;
    }
    EXPECT_EQ(failure({1, 0, 0}), file().string() +
                                      ": tile (level 1, row 0, column 0): cannot be read: Is a "
                                      "directory");
}

TEST_F(TileStore, is_written_whole_or_not_at_all) {
    const HeightField field = rough_field(100, 100, 7);
    write_bytes(file(), "what was there");
    {
        terrain::StoreWriter writer(field.info(), std::nullopt, file());
        for (int row = 0; row < 60; ++row) writer.push(field.samples().subspan(0, 100));
        EXPECT_THROW(writer.finish(), ContractError);
        std::vector<float> bad(100, 1.0F);
        bad[7] = NAN;
        try {
            writer.push(bad);
            ADD_FAILURE();
        } catch (const InputError& error) {
            EXPECT_STREQ(error.what(),
                         "terrain 'rough': the height at row 60, column 7 is nan; every height "
                         "must be finite");
        }
    }
    EXPECT_EQ(bytes_of(file()), "what was there");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
    terrain::write_store(field, std::nullopt, file());
    expect_equal(StoredTerrain(file()), field);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
    EXPECT_THROW(terrain::write_store(field, std::nullopt, file("a.raw")), InputError);
    EXPECT_THROW(terrain::write_store(field, std::nullopt, file("none/a.tiles")), InputError);
    EXPECT_THROW(terrain::write_store(field, std::nullopt, "/proc/a.tiles"), EnvironmentError);
    // A file does not take the place of a folder.
    std::filesystem::create_directory(file("d.tiles"));
    EXPECT_THROW(terrain::write_store(field, std::nullopt, file("d.tiles")), InputError);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 2);
    TerrainInfo info = field.info();
    info.name = std::string(257, 'n');
    EXPECT_THROW(terrain::StoreWriter(info, std::nullopt, file()), InputError);
    info = field.info();
    info.spacing.x = 0;
    EXPECT_THROW(terrain::StoreWriter(info, std::nullopt, file()), InputError);
    expect_equal(StoredTerrain(file()), field);
}

TEST_F(TileStore, is_opened_where_a_terrain_is_and_loaded_where_the_whole_is_needed) {
    const HeightField field = rough_field(150, 100, 8);
    terrain::write_store(field, std::nullopt, file());
    terrain::TerrainSource source;
    source.file = file();
    source.cold = true;
    const std::shared_ptr<const Terrain> opened = terrain::open_terrain(source);
    EXPECT_NE(dynamic_cast<const StoredTerrain*>(opened.get()), nullptr);
    EXPECT_EQ(opened->bytes_read(), 0U);
    const auto whole = terrain::whole_field(opened);
    expect_equal(*opened, *whole);
    EXPECT_TRUE(same_bits(whole->samples(), field.samples()));
    EXPECT_EQ(terrain::whole_field(std::shared_ptr<const Terrain>(whole)), whole);
    EXPECT_TRUE(same_bits(terrain::load_terrain(source)->samples(), field.samples()));

    source.spacing_x = 5;
    source.where = "s.toml:3";
    for (const auto& use :
         {+[](const terrain::TerrainSource& s) { (void)terrain::open_terrain(s); },
          +[](const terrain::TerrainSource& s) { (void)terrain::load_terrain(s); }}) {
        try {
            use(source);
            ADD_FAILURE();
        } catch (const InputError& error) {
            EXPECT_EQ(error.what(), "s.toml:3: " + file().string() +
                                        ": spacing is given, but a tiled store says that itself; "
                                        "leave it out, or import its original file with it");
        }
    }
    terrain::TerrainSource plane;
    plane.synthetic = "plane";
    plane.cold = true;
    EXPECT_THROW((void)terrain::open_terrain(plane), InputError);
}

TEST_F(TileStore, whole_is_refused_where_the_memory_does_not_hold_it) {
    const TerrainInfo info = grid("vast", 65537, 65537);
    try {
        terrain::require_room_for_whole(info);
        ADD_FAILURE();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "terrain 'vast' as a whole: 65537 rows x 65537 columns are more than the "
                     "2147483648 samples that are held in memory; leave it on disk (out_of_core = "
                     "true), or fly without what needs the whole (--no-truth)");
    }
}

}  // namespace
}  // namespace lodbench::test
