// Where strips of patches are kept: the cache, its pool of blocks, and the limits of memory.

#include <gtest/gtest.h>

#include "hybrid_flight.h"

namespace lodbench::hybrid_patches {
namespace {

constexpr SphereOfValidity kEverywhere{.scale = 1, .radius = 1e9};

TEST(PatchCache, gives_up_after_freeing_four_times_the_room_asked_for) {
    constexpr std::uint32_t kSmall = BlockPool::kSmallest / 2;  // indices
    constexpr std::uint32_t kLarge = BlockPool::kLargest / 2;
    constexpr std::uint32_t kInOne = BlockPool::kLargest / BlockPool::kSmallest;
    constexpr std::uint32_t kCount = 16 * kInOne;
    PatchCache cache(kCount + 2, 16 * BlockPool::kLargest, Metric::euclidean);
    cache.begin_frame(1);
    for (std::uint32_t i = 0; i < kCount; ++i) {
        ASSERT_NE(cache.insert(i, kEverywhere, kSmall, 1), nullptr);
    }
    cache.begin_frame(1);
    // One in each of the largest blocks is needed now.
    for (std::uint32_t i = 0; i < kCount; i += kInOne) {
        ASSERT_NE(cache.find(i), nullptr);
    }
    EXPECT_EQ(cache.insert(kCount, kEverywhere, kLarge, 1), nullptr);
    EXPECT_EQ(cache.evicted(), 4 * kInOne);
    EXPECT_EQ(cache.used_bytes(), 12 * BlockPool::kLargest);
    // What was freed serves others; the longest unselected were taken, not more.
    EXPECT_NE(cache.insert(kCount + 1, kEverywhere, kLarge / 2, 1), nullptr);
    EXPECT_EQ(cache.evicted(), 4 * kInOne);
    EXPECT_EQ(cache.find(1), nullptr);
    EXPECT_NE(cache.find(kCount - 1), nullptr);
}

TEST(PatchCache, drops_all_strips_of_another_scale) {
    PatchCache cache(3, BlockPool::kLargest, Metric::euclidean);
    const std::vector<std::uint32_t> patches = {0, 1, 2};
    std::vector<std::uint8_t> holds;
    cache.begin_frame(1);
    ASSERT_NE(cache.insert(0, kEverywhere, 100, 1), nullptr);
    ASSERT_NE(cache.insert(2, kEverywhere, 100, 1), nullptr);
    cache.begin_frame(1);
    cache.test(patches, {1, 2, 3}, {}, holds);
    EXPECT_EQ(holds, (std::vector<std::uint8_t>{1, 0, 1}));
    cache.drop(2);
    cache.test(patches, {1, 2, 3}, {}, holds);
    EXPECT_EQ(holds, (std::vector<std::uint8_t>{1, 0, 0}));
    cache.begin_frame(1.001);
    cache.test(patches, {1, 2, 3}, {}, holds);
    EXPECT_EQ(holds, (std::vector<std::uint8_t>{0, 0, 0}));
    EXPECT_EQ(cache.find(0), nullptr);
    EXPECT_EQ(cache.used_bytes(), 0U);
    EXPECT_EQ(cache.evicted(), 0U) << "not for want of room";
}

TEST(PatchHierarchy, refuses_more_patches_than_memory_is_meant_for) {
    TerrainInfo info;
    info.name = "wide";
    info.rows = 2;
    info.columns = 32769;
    EXPECT_NO_THROW(PatchHierarchy::require_few(info, 16));
    info.columns = 16385;
    EXPECT_NO_THROW(PatchHierarchy::require_few(info, 8));
    info.columns = 16386;
    try {
        PatchHierarchy::require_few(info, 8);
        ADD_FAILURE() << "not refused";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "terrain 'wide' has 67108860 patches of 9 samples an edge, at most 16777216 "
                     "are taken: use a larger patch_samples");
    }
    for (const auto& terrain : terrains()) {
        const Flight flight(*terrain, {}, 8, 0);
        EXPECT_EQ(PatchHierarchy::count_of(terrain->info(), 8), flight.hierarchy().size());
    }
}

TEST(BlockPool, gives_places_that_do_not_overlap_and_takes_them_back) {
    constexpr std::size_t kBytes = 4 * BlockPool::kLargest;
    BlockPool pool(kBytes);
    std::mt19937 random(13);
    std::vector<BlockPool::Block> blocks;
    std::vector<char> taken(kBytes, 0);
    std::size_t refused = 0;
    for (int i = 0; i < 4000; ++i) {
        if (!blocks.empty() && random() % 5 < 2) {
            const std::size_t which = random() % blocks.size();
            std::fill_n(taken.begin() + std::ptrdiff_t(blocks[which].offset), blocks[which].bytes(),
                        char(0));
            pool.release(blocks[which]);
            blocks[which] = blocks.back();
            blocks.pop_back();
            continue;
        }
        const std::size_t bytes = 1 + random() % (random() % 8 == 0 ? BlockPool::kLargest : 3000);
        const auto block = pool.allocate(bytes);
        if (!block) {
            ++refused;
            continue;
        }
        ASSERT_GE(block->bytes(), bytes);
        ASSERT_LE(block->offset + block->bytes(), kBytes);
        for (std::size_t b = 0; b < block->bytes(); ++b) {
            ASSERT_EQ(taken[block->offset + b], 0);
            taken[block->offset + b] = 1;
        }
        blocks.push_back(*block);
        ASSERT_EQ(pool.used(), std::size_t(std::count(taken.begin(), taken.end(), char(1))));
    }
    EXPECT_GT(refused, 0U);
    for (const BlockPool::Block& block : blocks) pool.release(block);
    EXPECT_EQ(pool.used(), 0U);
    for (int i = 0; i < 4; ++i) {
        EXPECT_TRUE(pool.allocate(BlockPool::kLargest)) << "halves did not join again";
    }
    EXPECT_FALSE(pool.allocate(1));
}

}  // namespace
}  // namespace lodbench::hybrid_patches
