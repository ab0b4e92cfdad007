// What is measured in real time of a method with background work: the surface that it draws, not
// the one that it prepares.

#include <gtest/gtest.h>

#include "measure/pixel_errors.h"
#include "run/frame_measurer.h"
#include "support/method_fixture.h"

namespace lodbench::test {
namespace {

class RealtimeTruth : public testing::Test {
protected:
    /// `east`: metres between the eye and where it was at first.
    void measure(int frame, double east) {
        Camera camera = camera_at({512100 + east, -3300, 500}, 40, -35);
        camera.viewport = {320, 240};
        flight_.select(camera);
        run::Stage& stage = flight_.stage();
        stage.pause_background();
        measurer_.measure_realtime(frame);
        stage.resume_background();
    }
    results::CellRecord truth() {
        results::CellRecord cell;
        measurer_.finish(cell);
        return cell;
    }

    std::shared_ptr<const terrain::HeightField> terrain_ = hills(65, 65);
    Flight flight_{terrain_, "../broken-plugins/lags/lags", "lags", {{"work_ms", "1000"}}};
    run::FrameMeasurer measurer_{flight_.stage(), std::nullopt, terrain_};
};

TEST_F(RealtimeTruth, is_that_of_the_surface_that_is_drawn) {
    measure(0, 0);  // waits: there is nothing yet that could be drawn
    EXPECT_LE(truth().pixel_error_realtime_px->max, measure::kSettledPx);
    measure(1, 40);  // raised by 4 m, and seen from less than 1 km
    const results::CellRecord behind = truth();
    EXPECT_GT(behind.pixel_error_realtime_px->p99, 1);
    EXPECT_EQ(behind.pixel_error_realtime_px->worst->frame, 1);
    EXPECT_FALSE(behind.pixel_error_px) << "no frame of the lockstep replay";
}

TEST_F(RealtimeTruth, is_exact_again_where_the_work_is_done) {
    measure(0, 0);
    flight_.select(camera_at({512140, -3300, 500}, 40, -35));
    flight_.stage().settle();
    flight_.stage().pause_background();
    measurer_.measure_realtime(1);
    flight_.stage().resume_background();
    EXPECT_LE(truth().pixel_error_realtime_px->max, measure::kSettledPx);
}

}  // namespace
}  // namespace lodbench::test
