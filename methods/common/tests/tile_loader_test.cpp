// Tiles read in the background, and the pool that they go to.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <set>
#include <thread>

#include "common/tile_loader.h"
#include "common/tile_pool.h"
#include "support/fake_terrain.h"

namespace lodbench::common {
namespace {

using namespace std::chrono_literals;
using test::FakeTerrain;

std::vector<TileId> row_of_tiles(int count, int level = 0) {
    std::vector<TileId> tiles;
    for (int i = 0; i < count; ++i) tiles.push_back({level, 0, i});
    return tiles;
}

std::vector<LoadedTile> take_all(TileLoader& loader, std::size_t count) {
    std::vector<LoadedTile> all;
    while (all.size() < count) {
        loader.wait();
        auto some = loader.take(100);
        if (some.empty() && loader.outstanding() == 0) break;
        std::move(some.begin(), some.end(), std::back_inserter(all));
    }
    return all;
}

TEST(TileLoader, gives_what_the_terrain_gives_most_urgent_first) {
    FakeTerrain terrain(65, 2049);
    terrain.height = [](int row, int column) { return float(10000 * row + column); };
    TileLoader loader(terrain, 1, 100);
    loader.request(row_of_tiles(20));
    const std::vector<LoadedTile> loaded = take_all(loader, 20);
    ASSERT_EQ(loaded.size(), 20U);
    std::vector<float> expected(kTileSampleCount);
    for (int i = 0; i < 20; ++i) {
        const LoadedTile& tile = loaded[std::size_t(i)];
        EXPECT_EQ(tile.tile, (TileId{0, 0, i}));
        terrain.read_tile(tile.tile, expected);
        EXPECT_EQ(tile.heights, expected);
    }
}

TEST(TileLoader, a_new_request_replaces_what_was_not_begun_and_reads_nothing_twice) {
    FakeTerrain terrain(65, 4097);
    std::promise<void> begun, go_on;
    std::shared_future<void> may_go_on = go_on.get_future();
    std::atomic<bool> first = true;
    terrain.before_read = [&](const TileId&) {
        if (!first.exchange(false)) return;
        begun.set_value();
        may_go_on.wait();
    };
    TileLoader loader(terrain, 1, 100);
    loader.request(row_of_tiles(50));
    begun.get_future().wait();
    // Tile 0 is being read; of the others only 30 and 31 are still wanted.
    loader.request(std::vector<TileId>{{0, 0, 0}, {0, 0, 30}, {0, 0, 31}});
    EXPECT_EQ(loader.outstanding(), 3U);
    go_on.set_value();
    EXPECT_EQ(take_all(loader, 3).size(), 3U);
    EXPECT_EQ(terrain.read_so_far(), (std::vector<TileId>{{0, 0, 0}, {0, 0, 30}, {0, 0, 31}}));
}

TEST(TileLoader, holds_no_more_tiles_than_allowed_until_they_are_taken) {
    const FakeTerrain terrain(65, 6401);
    TileLoader loader(terrain, 3, 5);
    loader.request(row_of_tiles(100));
    std::this_thread::sleep_for(50ms);
    EXPECT_EQ(terrain.tiles_served(), 5U);
    EXPECT_EQ(take_all(loader, 100).size(), 100U);
}

TEST(TileLoader, an_error_of_its_threads_reaches_whoever_takes_with_its_words) {
    FakeTerrain terrain(65, 2049);
    terrain.before_read = [](const TileId& tile) {
        if (tile.column == 7) {
            throw EnvironmentError("moon.tiles: tile (level 0, row 0, column 7) is damaged");
        }
    };
    TileLoader loader(terrain, 2, 100);
    loader.request(row_of_tiles(20));
    const auto take_until_it_fails = [&] {
        for (;;) {
            loader.wait();
            static_cast<void>(loader.take(1));
        }
    };
    for (int i = 0; i < 2; ++i) {
        try {
            take_until_it_fails();
            FAIL();
        } catch (const EnvironmentError& error) {
            EXPECT_STREQ(error.what(), "moon.tiles: tile (level 0, row 0, column 7) is damaged");
        }
    }
    // No more is begun.
    const std::uint64_t served = terrain.tiles_served();
    loader.request(row_of_tiles(20));
    std::this_thread::sleep_for(20ms);
    EXPECT_EQ(terrain.tiles_served(), served);
}

TEST(TileLoader, is_shut_down_under_load_after_the_tiles_being_read) {
    for (int i = 0; i < 20; ++i) {
        FakeTerrain terrain(65, 6401);
        terrain.before_read = [](const TileId&) { std::this_thread::sleep_for(1ms); };
        {
            TileLoader loader(terrain, 4, 3);
            loader.request(row_of_tiles(100));
            std::this_thread::sleep_for(i * 300us);
        }
        EXPECT_LE(terrain.tiles_served(), 40U);
    }
}

TEST(TileLoader, begins_nothing_while_paused) {
    FakeTerrain terrain(65, 2049);
    TileLoader loader(terrain, 2, 100);
    loader.pause();
    loader.request(row_of_tiles(10));
    std::this_thread::sleep_for(20ms);
    EXPECT_EQ(terrain.tiles_served(), 0U);
    loader.resume();
    EXPECT_EQ(take_all(loader, 10).size(), 10U);
}

TEST(TileLoader, clear_leaves_nothing_on_its_way) {
    FakeTerrain terrain(65, 2049);
    terrain.before_read = [](const TileId&) { std::this_thread::sleep_for(2ms); };
    TileLoader loader(terrain, 2, 100);
    loader.request(row_of_tiles(20));
    std::this_thread::sleep_for(5ms);
    loader.clear();
    EXPECT_EQ(loader.outstanding(), 0U);
    EXPECT_TRUE(loader.take(100).empty());
    const std::uint64_t served = terrain.tiles_served();
    std::this_thread::sleep_for(10ms);
    EXPECT_EQ(terrain.tiles_served(), served);
}

TEST(TilePool, the_tile_that_was_used_before_all_others_makes_room) {
    TilePool pool(3);
    EXPECT_EQ(pool.place(10, 1), 0);
    EXPECT_EQ(pool.place(11, 2), 1);
    EXPECT_EQ(pool.place(12, 3), 2);
    pool.touch(0, 4);
    EXPECT_EQ(pool.place(13, 5), 1) << "tile 11 is the oldest";
    EXPECT_FALSE(pool.find(11));
    EXPECT_EQ(pool.find(10), 0);
    EXPECT_EQ(pool.find(13), 1);
    EXPECT_EQ(pool.resident(), 3);
}

TEST(TilePool, nothing_that_was_used_since_makes_room_nor_what_is_pinned) {
    TilePool pool(2);
    pool.pin(pool.place(10, 1).value());
    EXPECT_EQ(pool.place(11, 5), 1);
    EXPECT_FALSE(pool.place(12, 5)) << "used at the same time";
    EXPECT_FALSE(pool.place(12, 4));
    EXPECT_EQ(pool.place(12, 6), 1);
    pool.clear();
    EXPECT_EQ(pool.find(10), 0) << "pinned";
    EXPECT_FALSE(pool.find(12));
    EXPECT_EQ(pool.place(13, 1), 1);
}

}  // namespace
}  // namespace lodbench::common
