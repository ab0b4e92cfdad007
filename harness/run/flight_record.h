#pragma once
// Where a flight's cameras stood, over which ground, and how much of it their views need: once for
// each scenario of a campaign, whatever the methods do.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "api/camera.h"
#include "api/terrain.h"
#include "picture/canvas.h"

namespace lodbench::run {

/// The ground from above, lit from the north-west, at most `largest` pixels wide and high: each
/// pixel shows the mean height of its samples, of a large terrain those of a coarser level.
[[nodiscard]] picture::Image hillshade(const Terrain& terrain, int largest);

/// Writes flights/<name>.json and flights/<name>__hillshade.png into the results folder `out`,
/// unless they are there. `camera_at` gives the camera of each of the frames. Returns what is to be
/// said of the flight, see FlightCheck, or what the file that is there says.
std::vector<std::string> record_flight(const std::filesystem::path& out, const std::string& name,
                                       const Terrain& terrain, int frames,
                                       const std::function<Camera(int)>& camera_at);

}  // namespace lodbench::run
