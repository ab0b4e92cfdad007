#include "scenario/camera_track.h"

namespace lodbench::scenario {

CameraTrack::CameraTrack(const Scenario& scenario, const Terrain& terrain)
    : rate_hz_(scenario.rate_hz),
      lead_(scenario.warmup_flies ? scenario.warmup_frames : 0),
      path_(make_path(scenario.path, lead_ + scenario.frames, scenario.rate_hz, terrain)) {
    lens_.vertical_fov = scenario.vertical_fov;
    lens_.viewport = scenario.viewport;
    lens_.near_plane = scenario.near_plane;
}

Camera CameraTrack::camera(int frame) const {
    Camera camera = lens_;
    path_->place(lead_ + frame, camera);
    return camera;
}

Clock CameraTrack::clock(int frame) const {
    return {lead_ + frame, (lead_ + frame) / rate_hz_};
}

}  // namespace lodbench::scenario
