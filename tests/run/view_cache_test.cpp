// Views of the terrain that one cell keeps for the next: the same to the bit, or nothing.
#include "run/view_cache.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <limits>
#include <string>

#include "base/files.h"
#include "base/hash.h"
#include "support/raster_files.h"

namespace lodbench::run {
namespace {

namespace fs = std::filesystem;

class ViewCacheTest : public ::testing::Test {
protected:
    ViewCacheTest() {
        camera_.position = {1.5, -2, 300.25};
        camera_.viewport = {7, 3};
        base::SplitMix64 random(1);
        view_.seen.resize(1000);
        for (std::size_t i = 100; i < 130; ++i) view_.seen[i] = random.next();
        view_.seen[0] = 1;
        view_.seen.back() = std::uint64_t{1} << 63U;
        for (int i = 0; i < 21; ++i) {
            view_.hits.push_back({double(i) / 3, std::numeric_limits<double>::infinity()});
        }
        for (int i = 0; i < 63; ++i) view_.picture.push_back(std::uint8_t(random.next()));
    }

    [[nodiscard]] ViewCache cache(const std::string& terrain = "0123456789abcdef",
                                  const std::string& device = "llvmpipe") const {
        return {folder_, "demo", terrain, device};
    }
    [[nodiscard]] fs::path file() const { return folder_ / "demo__5.view"; }

    void expect_same(const std::optional<measure::ReferenceView>& found) const {
        ASSERT_TRUE(found);
        EXPECT_EQ(found->seen, view_.seen);
        EXPECT_EQ(found->picture, view_.picture);
        ASSERT_EQ(found->hits.size(), view_.hits.size());
        EXPECT_EQ(std::memcmp(found->hits.data(), view_.hits.data(),
                              view_.hits.size() * sizeof view_.hits[0]),
                  0);
    }

    const test::TemporaryFolder scratch_;
    const fs::path& folder_ = scratch_.path();
    Camera camera_;
    measure::ReferenceView view_;
};

TEST_F(ViewCacheTest, gives_back_what_it_keeps_to_the_bit) {
    EXPECT_FALSE(cache().find(5, camera_));
    cache().keep(5, camera_, view_);
    expect_same(cache().find(5, camera_));
    EXPECT_FALSE(cache().find(6, camera_));
    EXPECT_LT(fs::file_size(file()), 1000U) << "of 8000 bytes of samples few are not zero";
}

TEST_F(ViewCacheTest, keeps_for_one_camera_one_terrain_and_one_driver) {
    cache().keep(5, camera_, view_);
    for (const auto& change : std::initializer_list<void (*)(Camera&)>{
             [](Camera& c) { c.position.x = std::nextafter(c.position.x, 9); },
             [](Camera& c) { c.orientation.w = 0.5; }, [](Camera& c) { c.near_plane = 2; },
             [](Camera& c) { c.vertical_fov = 1; }, [](Camera& c) { c.viewport.width = 8; }}) {
        Camera other = camera_;
        change(other);
        EXPECT_FALSE(cache().find(5, other));
    }
    EXPECT_FALSE(cache("fedcba9876543210").find(5, camera_));
    EXPECT_FALSE(cache("0123456789abcdef", "another driver").find(5, camera_));
    expect_same(cache().find(5, camera_));
}

TEST_F(ViewCacheTest, damage_is_seen_and_replaced) {
    cache().keep(5, camera_, view_);
    const std::string whole = base::read_text(file());
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = char(damaged[i] ^ 0x10);
        base::write_whole(file(), damaged);
        ASSERT_FALSE(cache().find(5, camera_)) << "byte " << i;
        base::write_whole(file(), whole.substr(0, i));
        ASSERT_FALSE(cache().find(5, camera_)) << "cut to " << i;
    }
    cache().keep(5, camera_, view_);
    expect_same(cache().find(5, camera_));
}

TEST_F(ViewCacheTest, what_cannot_be_kept_is_not) {
    // No folder.
    ViewCache nowhere(folder_ / "absent", "demo", "0", "");
    nowhere.keep(5, camera_, view_);
    EXPECT_FALSE(nowhere.find(5, camera_));
    EXPECT_FALSE(fs::exists(folder_ / "absent"));
    ViewCache().keep(5, camera_, view_);
    EXPECT_FALSE(ViewCache().find(5, camera_));
    // No file through a link.
    const fs::path elsewhere = folder_ / "elsewhere";
    base::write_whole(elsewhere, "a user's");
    fs::create_symlink(elsewhere, file());
    EXPECT_FALSE(cache().find(5, camera_));
    fs::remove(file());
    // No more than the bound: the hole of a sparse file counts.
    fs::resize_file(elsewhere, ViewCache::kMostBytes);
    cache().keep(5, camera_, view_);
    EXPECT_FALSE(fs::exists(file()));
}

}  // namespace
}  // namespace lodbench::run
