#pragma once
// Flight paths: a camera for each frame index, never for a time of the wall clock.

#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/camera.h"
#include "api/terrain.h"

namespace lodbench::scenario {

/// World position in metres, or (x, y) as fractions of the terrain's extent (0, 0 the south-west
/// corner, 1, 1 the north-east) when the path is `relative`; heights are metres above the ground
/// below when it is `above_ground`, else above zero. Angles in degrees: heading clockwise from
/// north, pitch positive upward, roll positive clockwise as the pilot sees it (the right wing goes
/// down).
struct Keyframe {
    glm::dvec3 position{0.0};
    std::optional<double> heading;  ///< nothing: the direction of flight
    double pitch = 0, roll = 0;
};

enum class PathKind { line, spline, orbit, terrain_following, recorded, still };

/// A path as written in a scenario; which fields count depends on the kind.
///
/// line               keyframes: start and end, or start alone with its heading and `speed`. The
/// view keeps
///                    the start's heading (default: from start to end), pitch and roll; flying with
///                    a heading and a speed keeps the height. With an end and a speed the camera
///                    stops there.
/// spline             keyframes: >= 2, all or none with a heading. Centripetal Catmull-Rom through
/// them,
///                    travelled at a constant speed; C1 in position and angles (headings and rolls
///                    go the shorter way round). Without headings the camera looks along the curve.
/// orbit              around `centre`, always looking at it, clockwise from above for positive
/// `turns`;
///                    frame f stands at turns * f / frames, so that whole turns close without a
///                    double frame.
/// terrain_following  keyframes as for line or spline, their z ignored: `height` above the ground.
/// recorded           `recorded`: CSV, world metres and degrees, one row a frame.
/// still              every frame from `standing`, whose lens is the scenario's.
///
/// A line, spline or terrain-following path without speed is spread evenly over the frames, first
/// frame on the first keyframe, last frame on the last.
struct PathSpec {
    PathKind kind = PathKind::line;
    bool relative = false;
    bool above_ground = false;
    std::vector<Keyframe> keyframes;
    double speed = 0;        ///< m/s of simulated time; 0: spread evenly over the frames
    glm::dvec3 centre{0.0};  ///< orbit
    double radius = 0;       ///< orbit: metres, > 0
    double height = 0;       ///< orbit: above `centre`; terrain_following: above ground, > 0
    double turns = 1;        ///< orbit: over all frames
    double bearing = 180;    ///< orbit: degrees, of the camera from the centre at frame 0
    double smoothing = 0;  ///< terrain_following: metres of path over which the ground is averaged
    std::optional<double>
        margin;  ///< terrain_following: least height above ground; default height / 2
    std::filesystem::path recorded;  ///< CSV: frame,x,y,z,heading,pitch,roll
    std::optional<Camera> standing;  ///< still: its viewport does not count
    std::string where;               ///< "scenario.toml:12", put in front of messages
};

/// Evaluates a path on one terrain.
class FlightPath {
public:
    virtual ~FlightPath() = default;
    /// Position and orientation for frame index 0 <= frame < frames; anything else throws
    /// ContractError.
    virtual void place(int frame, Camera& camera) const = 0;
};

/// Throws InputError when the specification does not make a path. The terrain must outlive the
/// path.
[[nodiscard]] std::unique_ptr<FlightPath> make_path(const PathSpec& spec, int frames,
                                                    double rate_hz, const Terrain& terrain);

/// The camera's orientation for heading, pitch and roll in degrees, with the conventions of
/// `Keyframe`.
[[nodiscard]] glm::dquat orientation_of(double heading, double pitch, double roll);

/// Heading [0, 360), pitch and roll (-180, 180] in degrees, rounded as `rounded_angle` does. An
/// orientation that was made of such angles gives them back, but looking straight up or down, where
/// heading and roll are one.
[[nodiscard]] glm::dvec3 angles_of(const glm::dquat& orientation);

/// To 1e-4 of a degree: far finer than a pixel, and short to write.
[[nodiscard]] double rounded_angle(double degrees);

/// Height of the ground at world x, y in metres: bilinear between the samples; beyond the terrain
/// that of the nearest point of its border.
[[nodiscard]] double ground_height(const Terrain& terrain, const glm::dvec2& position);

}  // namespace lodbench::scenario
