#pragma once
// The cameras of a scenario over its terrain, those of a warm-up that flies among them.

#include <memory>

#include "api/camera.h"
#include "api/method.h"
#include "scenario/flight_path.h"
#include "scenario/scenario.h"

namespace lodbench::scenario {

/// Frames are counted from the first that counts: a warm-up that flies has those below 0, and the
/// path begins with it.
class CameraTrack {
public:
    /// Throws InputError where the path cannot be flown over the terrain, which must outlive this.
    CameraTrack(const Scenario& scenario, const Terrain& terrain);

    /// -first_frame() warm-up frames lead to frame 0; 0 where the warm-up stands there.
    [[nodiscard]] int first_frame() const { return -lead_; }
    /// first_frame() <= frame < frames of the scenario; anything else throws ContractError.
    [[nodiscard]] Camera camera(int frame) const;
    [[nodiscard]] Clock clock(int frame) const;

private:
    Camera lens_;  ///< what all cameras share
    double rate_hz_;
    int lead_;
    std::unique_ptr<FlightPath> path_;
};

}  // namespace lodbench::scenario
