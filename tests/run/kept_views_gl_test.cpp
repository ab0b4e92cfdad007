// What a frame shows of the true terrain is found by the first method that is measured, and taken
// from what is kept by every other one.

#include <gtest/gtest.h>

#include <algorithm>

#include "run/frame_measurer.h"
#include "support/method_fixture.h"
#include "support/raster_files.h"

namespace lodbench::test {
namespace {

class KeptViews : public testing::Test {
protected:
    [[nodiscard]] measure::FrameTruth measured(const run::ViewCache& views) const {
        Flight flight(terrain_, "template_method", "template", {{"step", "2"}});
        flight.select(camera_);
        run::FrameMeasurer measurer(flight.stage(), std::nullopt, terrain_, views);
        results::FrameRecord record;
        record.triangles = flight.stage().count_primitives();
        measurer.take(7, record, nullptr);
        measurer.measure(record);
        return record;
    }

    const std::shared_ptr<const terrain::HeightField> terrain_ = hills(65, 65);
    const Camera camera_ = camera_at({512100, -3300, 260}, 40, -10);
    const TemporaryFolder folder_;
    run::ViewCache cache_{folder_.path(), "hills", "checksum", "driver"};
};

TEST_F(KeptViews, give_the_figures_that_are_found_without_them) {
    ASSERT_FALSE(cache_.find(7, camera_));
    const measure::FrameTruth alone = measured({});
    const measure::FrameTruth first = measured(cache_);
    ASSERT_TRUE(cache_.find(7, camera_));
    const measure::FrameTruth other = measured(cache_);
    ASSERT_GT(alone.visible_max_px.value(), 0.1);
    for (const measure::FrameTruth& truth : {first, other}) {
        EXPECT_EQ(truth.visible_max_px, alone.visible_max_px);
        EXPECT_EQ(truth.visible_p999_px, alone.visible_p999_px);
        EXPECT_EQ(truth.pixel_p999_px, alone.pixel_p999_px);
        EXPECT_EQ(truth.silhouette_pixels, alone.silhouette_pixels);
        EXPECT_EQ(truth.psnr_db, alone.psnr_db);
    }
}

TEST_F(KeptViews, are_what_another_method_is_held_against) {
    const measure::FrameTruth first = measured(cache_);
    // Another view than the terrain's, which no search could find, shows that none is made.
    measure::ReferenceView view = cache_.find(7, camera_).value();
    std::ranges::fill(view.seen, 0);
    std::ranges::fill(view.picture, std::uint8_t{0});
    for (measure::ReferenceHit& hit : view.hits) hit = {hit.possible / 2, hit.certain / 2};
    cache_.keep(7, camera_, view);
    const measure::FrameTruth other = measured(cache_);
    EXPECT_FALSE(other.visible_max_px) << "no sample is in sight";
    EXPECT_LT(other.psnr_db.value(), first.psnr_db.value()) << "of a black picture";
    EXPECT_NE(other.pixel_rms_px.value(), first.pixel_rms_px.value()) << "of points in the air";
}

}  // namespace
}  // namespace lodbench::test
