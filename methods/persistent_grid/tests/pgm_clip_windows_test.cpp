// What the clip windows put into their texture, without a GPU: the texture is an array.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <random>
#include <thread>

#include "persistent_grid/clip_windows.cpp"  // the room is a plugin, not a library
#include "support/fake_terrain.h"
#include "support/method_fixture.h"

namespace lodbench::persistent_grid {
namespace {

/// Stands for the texture.
struct FakeTexture {
    explicit FakeTexture(const ClipWindows& windows)
        : size(windows.texture_size()),
          texels(std::size_t(size.x) * std::size_t(size.y), std::nanf("")) {}

    [[nodiscard]] ClipWindows::Write writer() {
        return [this](glm::ivec2 texel, glm::ivec2 extent, std::span<const float> heights) {
            ASSERT_EQ(heights.size(), std::size_t(extent.x) * std::size_t(extent.y));
            ASSERT_TRUE(glm::all(glm::greaterThanEqual(texel, glm::ivec2(0))));
            ASSERT_TRUE(glm::all(glm::lessThanEqual(texel + extent, size)));
            for (int row = 0; row < extent.y; ++row) {
                std::copy_n(heights.begin() + std::ptrdiff_t(row) * extent.x, extent.x,
                            texels.begin() + std::ptrdiff_t(texel.y + row) * size.x + texel.x);
            }
        };
    }
    [[nodiscard]] float at(glm::ivec2 texel) const {
        return texels[std::size_t(texel.y) * std::size_t(size.x) + std::size_t(texel.x)];
    }

    glm::ivec2 size;
    std::vector<float> texels;
};

constexpr int kTexels = 64;

class PgmClipWindows : public testing::Test {
protected:
    /// As the shader reads it.
    [[nodiscard]] static glm::ivec2 texel_of(const ClipWindows& windows, int level,
                                             glm::ivec2 sample) {
        return windows.corner(level) + (sample & (kTexels - 1));
    }
    /// All that is held of every level is what the pyramid has there, to the bit.
    void expect_held(const ClipWindows& windows, const FakeTexture& texture) const {
        for (int level = 0; level < windows.level_count(); ++level) {
            const common::LevelRect held = windows.held(level);
            for (int y = held.low.y; y < held.high.y; ++y) {
                for (int x = held.low.x; x < held.high.x; ++x) {
                    const Level& whole = levels_[std::size_t(level)];
                    ASSERT_EQ(texture.at(texel_of(windows, level, {x, y})),
                              whole.at(std::min(y, whole.rows - 1), std::min(x, whole.columns - 1)))
                        << "level " << level << ": " << y << ", " << x;
                }
            }
        }
    }

    std::shared_ptr<const terrain::HeightField> terrain_ = test::hills(700, 1100);
    std::vector<Level> levels_ =
        make_pyramid(Level{1100, 700, {terrain_->samples().begin(), terrain_->samples().end()}});
    MeanPyramid pyramid_{*terrain_, {}};
};

TEST_F(PgmClipWindows, lie_apart_and_stand_about_the_viewpoint_as_far_as_the_terrain_goes) {
    ClipWindows windows(pyramid_, {.texels = kTexels});
    FakeTexture texture(windows);
    windows.start(texture.writer());
    const glm::dvec2 places[] = {{550, 350}, {0, 0},       {1099, 699},
                                 {-1e12, 3}, {1e12, 1e12}, {551.25, 350.75}};
    for (const glm::dvec2& place : places) {
        windows.load(place, texture.writer());
        std::vector<bool> used(texture.texels.size());
        for (int level = 0; level < windows.level_count(); ++level) {
            const glm::ivec2 size = level_size(terrain_->info(), level);
            const common::LevelRect target = windows.target(level);
            EXPECT_TRUE(windows.held(level) == target);
            for (int axis = 0; axis < 2; ++axis) {
                const double texel = (place[axis] + 0.5) / std::exp2(level) - 0.5;
                const int most = std::max(0, size[axis] - kTexels);
                ASSERT_GE(target.low[axis], 0);
                ASSERT_LE(target.low[axis], most);
                // As many texels on one side as on the other, but for the terrain's border.
                if (target.low[axis] > 0 && target.low[axis] < most) {
                    EXPECT_LE(std::abs(target.low[axis] + (kTexels - 1) / 2.0 - texel), 0.5);
                }
            }
            for (int y = 0; y < kTexels; ++y) {
                for (int x = 0; x < kTexels; ++x) {
                    const glm::ivec2 texel =
                        texel_of(windows, level, target.low + glm::ivec2(x, y));
                    const std::size_t place_in_texture =
                        std::size_t(texel.y) * std::size_t(texture.size.x) + std::size_t(texel.x);
                    ASSERT_FALSE(used[place_in_texture]) << level;
                    used[place_in_texture] = true;
                }
            }
        }
        expect_held(windows, texture);
    }
}

/// A walk of 1,000 steps: slow, fast, as far as it goes, in all directions, beyond the border.
class RandomWalk {
public:
    glm::dvec2 next() {
        const double kind = uniform(0, 1);
        if (kind < 0.02) {
            place_ = {uniform(-300, 1400), uniform(-300, 1000)};
        } else {
            const double step = kind < 0.5 ? 0.3 : kind < 0.9 ? 8 : 90;
            place_ += glm::dvec2(uniform(-step, step), uniform(-step, step));
        }
        place_ = glm::clamp(place_, glm::dvec2(-400), glm::dvec2(1500, 1100));
        return place_;
    }

private:
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    std::mt19937_64 random_{17};
    glm::dvec2 place_{550, 350};
};

TEST_F(PgmClipWindows, after_any_walk_hold_what_the_entire_update_writes_to_the_bit) {
    ClipWindows followed(pyramid_, {.texels = kTexels});
    ClipWindows rewritten(pyramid_, {.texels = kTexels, .entire = true});
    FakeTexture by_strips(followed), whole(rewritten);
    followed.start(by_strips.writer());
    rewritten.start(whole.writer());
    RandomWalk walk;
    std::int64_t texels_by_strips = 0, texels_whole = 0;
    for (int step = 0; step < 1000; ++step) {
        const glm::dvec2 place = walk.next();
        followed.load(place, by_strips.writer());
        texels_by_strips += followed.counts().texels;
        ASSERT_EQ(followed.counts().missing, 0);
        ASSERT_EQ(followed.counts().windows_behind, 0);
        if (step % 10 != 9) continue;
        rewritten.load(place, whole.writer());
        ASSERT_EQ(rewritten.counts().texels, kTexels * kTexels * rewritten.level_count());
        texels_whole += rewritten.counts().texels;
        // As bits: what neither has written is NaN in both.
        ASSERT_EQ(std::memcmp(by_strips.texels.data(), whole.texels.data(),
                              whole.texels.size() * sizeof(float)),
                  0)
            << "step " << step;
    }
    EXPECT_LT(texels_by_strips, 10 * texels_whole / 4);
    expect_held(followed, by_strips);
}

TEST_F(PgmClipWindows, write_at_most_the_lines_of_their_budget_and_catch_up) {
    ClipWindows windows(pyramid_, {.texels = kTexels, .lines_per_frame = 5});
    FakeTexture texture(windows);
    windows.start(texture.writer());
    windows.load({550, 350}, texture.writer());
    for (const glm::dvec2& place : {glm::dvec2(590, 360), glm::dvec2(100, 600)}) {
        bool caught_up = false;
        std::int64_t missing = 0;
        for (int frame = 0; frame < 200 && !caught_up; ++frame) {
            windows.update(place, texture.writer());
            const ClipCounts& counts = windows.counts();
            ASSERT_LE(counts.lines, 5);
            ASSERT_LE(counts.texels, 5 * kTexels);
            // Tiles are at hand sooner or later; each frame writes as much as they allow.
            if (counts.lines == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            expect_held(windows, texture);
            if (frame > 0 && counts.lines > 0) {
                ASSERT_LT(counts.missing, missing);
            }
            missing = counts.missing;
            caught_up = counts.windows_behind == 0;
        }
        EXPECT_TRUE(caught_up);
        EXPECT_EQ(missing, 0);
    }
}

TEST_F(PgmClipWindows, of_two_levels_that_lack_something_the_coarser_is_filled_first) {
    ClipWindows windows(pyramid_, {.texels = kTexels, .lines_per_frame = 4});
    FakeTexture texture(windows);
    windows.start(texture.writer());
    windows.load({550, 350}, texture.writer());
    // 16 samples east, over tiles that were read with those beside them: 16, 8, 4, 2 and 1 columns.
    windows.update({566, 350}, texture.writer());
    EXPECT_TRUE(windows.held(3) == windows.target(3)) << "one column of level 4, two of level 3";
    EXPECT_EQ(windows.held(2).size().x, kTexels - 4 + 1) << "one of four of level 2";
    EXPECT_EQ(windows.held(1).size().x, kTexels - 8);
    EXPECT_EQ(windows.held(0).size().x, kTexels - 16);
    EXPECT_EQ(windows.counts().windows_behind, 3);
    EXPECT_EQ(windows.counts().missing, (3 + 8 + 16) * kTexels);
}

/// A texel a step east: the finest window takes a column a step, each coarser one half as many.
TEST_F(PgmClipWindows, a_move_writes_what_it_brings_in_and_no_more) {
    ClipWindows windows(pyramid_, {.texels = kTexels});
    FakeTexture texture(windows);
    windows.start(texture.writer());
    windows.load({300.25, 350}, texture.writer());
    std::int64_t texels = 0;
    for (int step = 1; step <= 64; ++step) {
        windows.load({300.25 + step, 350}, texture.writer());
        texels += windows.counts().texels;
    }
    // Levels 0 to 4 are larger than their window: 64 + 32 + 16 + 8 + 4 columns; those of level 4,
    // of 69 texels, stop at the terrain's border.
    const std::int64_t columns = 64 + 32 + 16 + 8;
    EXPECT_GE(texels, columns * kTexels);
    EXPECT_LE(texels, (columns + 4) * kTexels);
}

// Where a disk does not answer, a frame goes on without it.
TEST(PgmClipWindowsOverASlowDisk, never_wait_for_it) {
    test::FakeTerrain terrain(1000, 1000);
    terrain.height = [](int row, int column) { return float(1000 * row + column); };
    const MeanPyramid pyramid(terrain, {});
    std::mutex mutex;
    std::condition_variable opened;
    bool open = true;
    terrain.before_read = [&](const TileId&) {
        std::unique_lock lock(mutex);
        opened.wait(lock, [&] { return open; });
    };
    ClipWindows windows(pyramid, {.texels = kTexels});
    FakeTexture texture(windows);
    windows.start(texture.writer());
    windows.load({200, 200}, texture.writer());
    {
        const std::lock_guard lock(mutex);
        open = false;
    }
    // The coarser levels lie in the pyramid's file, which answers; level 0 is the terrain's.
    for (int frame = 0; frame < 400 && windows.counts().windows_behind != 1; ++frame) {
        windows.update({800, 800}, texture.writer());
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(windows.counts().windows_behind, 1);
    EXPECT_TRUE(windows.held(0).empty());
    EXPECT_TRUE(windows.held(1) == windows.target(1));
    {
        const std::lock_guard lock(mutex);
        open = true;
    }
    opened.notify_all();
    windows.load({800, 800}, texture.writer());
    EXPECT_TRUE(windows.held(0) == windows.target(0));
    EXPECT_EQ(texture.at(windows.corner(0) + (glm::ivec2(800, 801) & (kTexels - 1))), 801800);
}

TEST(PgmClipWindowsOverASlowDisk, tell_what_the_disk_says) {
    test::FakeTerrain terrain(1000, 1000);
    const MeanPyramid pyramid(terrain, {});
    ClipWindows windows(pyramid, {.texels = kTexels});
    FakeTexture texture(windows);
    windows.start(texture.writer());
    terrain.before_read = [](const TileId&) { throw TerrainError("the disk is gone"); };
    EXPECT_THROW(windows.load({200, 200}, texture.writer()), TerrainError);
}

}  // namespace
}  // namespace lodbench::persistent_grid
