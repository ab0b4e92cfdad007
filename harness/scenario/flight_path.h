#pragma once
// Flight paths: a camera for each frame index, never for a time of the wall clock.

#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "api/camera.h"
#include "api/terrain.h"

namespace lodbench::terrain {
class HeightField;
}

namespace lodbench::scenario {

/// World position in metres, or (x, y) as fractions 0..1 of the terrain's extent when `relative`; heights
/// are metres above the ground below when `above_ground`, else above zero. Angles in degrees: heading clockwise from north, pitch
/// positive upward, roll positive clockwise as the pilot sees it.
struct Keyframe {
    glm::dvec3 position{0.0};
    double heading = 0, pitch = 0, roll = 0;
};

enum class PathKind { line, spline, orbit, terrain_following, recorded };

/// A path as written in a scenario; which fields count depends on the kind.
struct PathSpec {
    PathKind kind = PathKind::line;
    bool relative = false;
    bool above_ground = false;
    std::vector<Keyframe> keyframes;  ///< line: start (and end, or start with heading and speed); spline: >= 2
    double speed = 0;                 ///< m/s; 0: the path is spread evenly over the frames
    glm::dvec3 centre{0.0};           ///< orbit
    double radius = 0, height = 0;    ///< orbit: metres; height above `centre`; terrain_following: above ground
    double turns = 1;                 ///< orbit: over all frames
    double pitch = 0;                 ///< degrees; line with speed, terrain_following
    std::filesystem::path recorded;   ///< CSV: frame,x,y,z,heading,pitch,roll
    std::string where;
};

/// Evaluates a path on one terrain.
class FlightPath {
public:
    virtual ~FlightPath() = default;
    /// Position and orientation for frame index 0 <= frame < frames.
    virtual void place(int frame, Camera& camera) const = 0;
};

/// Throws InputError when the specification does not make a path.
[[nodiscard]] std::unique_ptr<FlightPath> make_path(const PathSpec& spec, int frames, double rate_hz,
                                                    const terrain::HeightField& terrain);

}  // namespace lodbench::scenario
