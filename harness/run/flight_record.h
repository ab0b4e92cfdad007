#pragma once
// Where a flight's cameras stood and over which ground, once for each scenario of a campaign: for
// the map in its report.

#include <filesystem>
#include <string>

#include "api/terrain.h"
#include "report/canvas.h"
#include "scenario/flight_path.h"

namespace lodbench::run {

/// The ground from above, lit from the north-west, at most `largest` pixels wide and high: each
/// pixel shows the mean height of its samples, of a large terrain those of a coarser level.
[[nodiscard]] report::Image hillshade(const Terrain& terrain, int largest);

/// Writes flights/<name>.json and flights/<name>__hillshade.png into the results folder `out`,
/// unless they are there.
void record_flight(const std::filesystem::path& out, const std::string& name,
                   const Terrain& terrain, const scenario::FlightPath& path, int frames);

}  // namespace lodbench::run
