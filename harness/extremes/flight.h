#pragma once
// What a probe's child process does.

#include <functional>
#include <memory>
#include <vector>

#include "extremes/probe.h"
#include "measure/capture.h"
#include "run/vital_signs.h"
#include "terrain/height_field.h"

namespace lodbench::extremes {

/// A world for methods to fly in: the scenario's, or its copy, moved and scaled.
struct World {
    std::shared_ptr<const terrain::HeightField> terrain;
    std::vector<Camera> cameras;  ///< one a frame
    std::vector<Clock> clocks;
};

/// The scenario's world. Camera positions are rounded to 2^-20 m and to the nearest float above
/// zero height: so a shift by up to 2^32 m, and any scaling by a power of two, moves them exactly.
[[nodiscard]] World make_world(const scenario::Scenario& scenario);
/// Its copy.
[[nodiscard]] World changed(const World& world, const WorldChange& change);

/// How a surface differs from what it should be a copy of.
struct SurfaceChange {
    std::uint64_t triangles = 0;  ///< that differ in a bit, or are there once
    double moved_m = 0;           ///< greatest distance, in metres of the world as it is
};
/// `copy` in the changed world against `original`: vertex by vertex where both are the same in
/// number, and by their heights at the samples; the lesser counts.
[[nodiscard]] SurfaceChange compare_surfaces(const measure::CapturedSurface& original,
                                             const measure::CapturedSurface& copy,
                                             const World& world, const World& changed_world,
                                             double scale);

/// Flies the probe here; whatever the method does may end this process. Throws as run::Stage.
/// `outcome` is filled as far as it comes.
void fly_here(const Probe& probe, const scenario::Scenario& scenario, run::VitalSigns& signs,
              ProbeOutcome& outcome);

}  // namespace lodbench::extremes
