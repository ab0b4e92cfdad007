// What waits for its errors makes no other error in real time than in lockstep.

#include "support/realtime_truth.h"

namespace lodbench::test {
namespace {

// Flown in real time like any setting of the method: waiting for its errors in `select`, it draws
// there what it draws in lockstep.
TEST_F(RealtimeTruth, is_the_lockstep_error_where_a_setting_waits) {
    const fs::path out =
        run("out", {"--method", "multi-context", "--set", "multi-context.async=false", "--set",
                    "multi-context.k=17", "--set", "multi-context.delta=1.8"});
    const Json::Value cell = cells_of(out).at(0);
    EXPECT_GT(cell["pixel_error_px"]["max"].asDouble(), 0.1) << "too good to judge by";
    // Means are summed in another order.
    for (const char* figure : {"count", "max", "p999", "p99"}) {
        EXPECT_EQ(cell["pixel_error_realtime_px"][figure], cell["pixel_error_px"][figure])
            << figure;
    }
}

}  // namespace
}  // namespace lodbench::test
