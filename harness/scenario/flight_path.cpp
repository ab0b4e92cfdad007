#include "scenario/flight_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "api/error.h"
#include "scenario/path_curve.h"
#include "scenario/recorded_path.h"

namespace lodbench::scenario {
namespace {

[[noreturn]] void refuse(const PathSpec& spec, const std::string& message) {
    throw InputError(spec.where.empty() ? message : spec.where + ": " + message);
}

void require_frame(int frame, int frames) {
    if (frame < 0 || frame >= frames) {
        throw ContractError(
            fmt::format("FlightPath: frame is {}, expected 0 to {}", frame, frames - 1));
    }
}

/// Degrees clockwise from north; north for a direction without a horizontal part.
double heading_of(const glm::dvec3& direction) {
    if (direction.x == 0 && direction.y == 0) return 0;
    return glm::degrees(std::atan2(direction.x, direction.y));
}

/// The keyframe's place in the world.
glm::dvec3 world_position(const glm::dvec3& written, const PathSpec& spec, const Terrain& terrain) {
    glm::dvec3 position = written;
    if (spec.relative) {
        const TerrainInfo& info = terrain.info();
        const glm::dvec2 size = info.extent_max() - info.extent_min();
        const glm::dvec2 place = info.extent_min() + size * glm::dvec2(written);
        position = {place, written.z};
    }
    if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z)) {
        refuse(spec, fmt::format("the position [{}, {}, {}] is not finite; write numbers",
                                 written.x, written.y, written.z));
    }
    if (spec.above_ground) position.z += ground_height(terrain, glm::dvec2(position));
    return position;
}

/// Line, spline and terrain-following.
class CurvePath final : public FlightPath {
public:
    CurvePath(const PathSpec& spec, int frames, double rate_hz, const Terrain& terrain)
        : spec_(spec), frames_(frames), terrain_(terrain), curve_(make_curve(frames, rate_hz)) {
        step_ = spec.speed > 0 ? spec.speed / rate_hz : curve_.length() / std::max(1, frames - 1);
    }

    void place(int frame, Camera& camera) const override {
        require_frame(frame, frames_);
        // The product may miss the end of an even spread by a rounding error; the end is meant.
        const bool last = spec_.speed <= 0 && frame > 0 && frame == frames_ - 1;
        const double travelled = last ? curve_.length() : step_ * frame;
        const CurvePoint point = curve_.at(travelled);
        camera.position = point.position;
        if (spec_.kind == PathKind::terrain_following) {
            camera.position.z = followed_height(travelled, glm::dvec2(point.position));
        }
        const double heading =
            along_flight_ ? heading_of(flight_direction(travelled, point)) : point.angles.x;
        camera.orientation = orientation_of(heading, point.angles.y, point.angles.z);
    }

private:
    Curve make_curve(int frames, double rate_hz) {
        std::vector<Keyframe> keys = spec_.keyframes;
        for (Keyframe& key : keys) key.position = world_position(key.position, spec_, terrain_);
        if (keys.size() == 1) keys.push_back(end_of_level_flight(keys[0], frames, rate_hz));
        if (spec_.kind == PathKind::line) {
            if (keys.size() != 2) refuse(spec_, "a line has a start and an end; give these two");
            if (!keys[0].heading) {
                keys[0].heading = heading_of(keys[1].position - keys[0].position);
            }
            keys[1] = {keys[1].position, keys[0].heading, keys[0].pitch, keys[0].roll};
        }
        along_flight_ = !keys.empty() && !keys[0].heading;
        std::vector<glm::dvec3> positions;
        std::vector<glm::dvec3> angles;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            if (keys[i].heading.has_value() == along_flight_) {
                refuse(spec_, fmt::format("keyframe {} {} a heading and the first {}; give all "
                                          "keyframes a heading, or none to look along the flight",
                                          i + 1, along_flight_ ? "has" : "lacks",
                                          along_flight_ ? "lacks one" : "has one"));
            }
            glm::dvec3 position = keys[i].position;
            // Following the terrain the curve is that of the ground plan: z comes later.
            if (spec_.kind == PathKind::terrain_following) position.z = 0;
            glm::dvec3 angle(keys[i].heading.value_or(0), keys[i].pitch, keys[i].roll);
            if (i > 0) {
                if (glm::distance(position, positions.back()) < kLeastChord) {
                    refuse(spec_,
                           fmt::format("keyframe {} stands where keyframe {} stands; move or "
                                       "remove one of them",
                                       i + 1, i));
                }
                angle.x = unwrapped(angles.back().x, angle.x);
                angle.z = unwrapped(angles.back().z, angle.z);
            }
            positions.push_back(position);
            angles.push_back(angle);
        }
        if (positions.size() < 2) {
            refuse(spec_, fmt::format("the path has {} keyframes; give at least 2", keys.size()));
        }
        return {std::move(positions), std::move(angles)};
    }

    [[nodiscard]] Keyframe end_of_level_flight(const Keyframe& start, int frames,
                                               double rate_hz) const {
        if (!start.heading || !(spec_.speed > 0)) {
            refuse(spec_, "the path has a start but no end; add an end, or a heading and a speed");
        }
        const double radians = glm::radians(*start.heading);
        const double length = spec_.speed * std::max(1, frames - 1) / rate_hz;
        Keyframe end = start;
        end.position += length * glm::dvec3(std::sin(radians), std::cos(radians), 0);
        return end;
    }

    /// The tangent; where the curve turns back in one point and has none, the way it goes from
    /// there.
    [[nodiscard]] glm::dvec3 flight_direction(double travelled, const CurvePoint& point) const {
        if (glm::length(point.tangent) > 1e-9 * curve_.length()) return point.tangent;
        const double ahead = 1e-3 * curve_.length();
        return curve_.at(travelled + ahead).position - curve_.at(travelled - ahead).position;
    }

    [[nodiscard]] double followed_height(double travelled, const glm::dvec2& position) const {
        const double below = ground_height(terrain_, position);
        if (spec_.smoothing <= 0) return below + spec_.height;
        double sum = 0;
        for (int i = 0; i < kSmoothingSamples; ++i) {
            const double offset = spec_.smoothing * (double(i) / (kSmoothingSamples - 1) - 0.5);
            sum += ground_height(terrain_, glm::dvec2(curve_.at(travelled + offset).position));
        }
        return std::max(sum / kSmoothingSamples + spec_.height,
                        below + spec_.margin.value_or(spec_.height / 2));
    }

    static constexpr double kLeastChord = 1e-6;  // metres
    static constexpr int kSmoothingSamples = 65;

    PathSpec spec_;
    int frames_;
    const Terrain& terrain_;
    bool along_flight_ = false;
    Curve curve_;
    double step_ = 0;
};

class OrbitPath final : public FlightPath {
public:
    OrbitPath(const PathSpec& spec, int frames, const Terrain& terrain)
        : spec_(spec), frames_(frames), centre_(world_position(spec.centre, spec, terrain)) {
        if (!(spec.radius > 0)) {
            refuse(spec, fmt::format("radius is {}; give metres above 0", spec.radius));
        }
    }

    void place(int frame, Camera& camera) const override {
        require_frame(frame, frames_);
        const double bearing = glm::radians(spec_.bearing + 360 * spec_.turns * frame / frames_);
        const glm::dvec3 offset(spec_.radius * std::sin(bearing), spec_.radius * std::cos(bearing),
                                spec_.height);
        camera.position = centre_ + offset;
        camera.orientation = Camera::look(-offset);
    }

private:
    PathSpec spec_;
    int frames_;
    glm::dvec3 centre_;
};

class StillPath final : public FlightPath {
public:
    StillPath(const PathSpec& spec, int frames) : frames_(frames), camera_(spec.standing.value()) {}

    void place(int frame, Camera& camera) const override {
        require_frame(frame, frames_);
        camera.position = camera_.position;
        camera.orientation = camera_.orientation;
    }

private:
    int frames_;
    Camera camera_;
};

class RecordedPath final : public FlightPath {
public:
    RecordedPath(const PathSpec& spec, int frames)
        : frames_(frames), places_(load_recorded(spec.recorded)) {
        if (places_.size() < std::size_t(frames)) {
            refuse(spec,
                   fmt::format("{} has {} frames and the flight {}; record more frames or fly "
                               "fewer",
                               spec.recorded.string(), places_.size(), frames));
        }
    }

    void place(int frame, Camera& camera) const override {
        require_frame(frame, frames_);
        const RecordedPlace& recorded = places_[std::size_t(frame)];
        camera.position = recorded.position;
        camera.orientation =
            orientation_of(recorded.angles.x, recorded.angles.y, recorded.angles.z);
    }

private:
    int frames_;
    std::vector<RecordedPlace> places_;
};

}  // namespace

glm::dquat orientation_of(double heading, double pitch, double roll) {
    // Level and northward: the camera's -z is north, its y is up.
    const glm::dquat north = glm::angleAxis(glm::radians(90.0), glm::dvec3(1, 0, 0));
    return glm::normalize(glm::angleAxis(glm::radians(-heading), glm::dvec3(0, 0, 1)) *
                          glm::angleAxis(glm::radians(pitch), glm::dvec3(1, 0, 0)) *
                          glm::angleAxis(glm::radians(roll), glm::dvec3(0, 1, 0)) * north);
}

double rounded_angle(double degrees) {
    constexpr double kPerDegree = 1e4;
    return std::round(degrees * kPerDegree) / kPerDegree;
}

glm::dvec3 angles_of(const glm::dquat& orientation) {
    const glm::dvec3 forward = orientation * glm::dvec3(0, 0, -1);
    const double pitch = std::asin(std::clamp(forward.z, -1.0, 1.0));
    const double heading = std::atan2(forward.x, forward.y);
    // What is left beside heading and pitch turns about the line of sight.
    const glm::dquat level = orientation_of(glm::degrees(heading), glm::degrees(pitch), 0);
    const glm::dvec3 right = glm::conjugate(level) * (orientation * glm::dvec3(1, 0, 0));
    const double roll = std::atan2(-right.y, right.x);
    const double rounded = rounded_angle(glm::degrees(heading) + (heading < 0 ? 360 : 0));
    return glm::dvec3(rounded == 360 ? 0 : rounded, rounded_angle(glm::degrees(pitch)),
                      rounded_angle(glm::degrees(roll))) +
           0.0;
}

double ground_height(const Terrain& terrain, const glm::dvec2& position) {
    if (!std::isfinite(position.x) || !std::isfinite(position.y)) {
        throw ContractError("ground_height: the position is not finite");
    }
    const TerrainInfo& info = terrain.info();
    const glm::dvec2 steps = (position - info.origin) / info.spacing;
    const double x = std::clamp(steps.x, 0.0, double(info.columns - 1));
    const double y = std::clamp(info.rows - 1 - steps.y, 0.0, double(info.rows - 1));
    const int column = std::min(int(x), info.columns - 2);
    const int row = std::min(int(y), info.rows - 2);
    std::array<float, 4> cell{};
    terrain.read({row, column, 2, 2}, cell);
    const double u = x - column;
    const double v = y - row;
    const double north = double(cell[0]) * (1 - u) + double(cell[1]) * u;
    const double south = double(cell[2]) * (1 - u) + double(cell[3]) * u;
    return north * (1 - v) + south * v;
}

std::unique_ptr<FlightPath> make_path(const PathSpec& spec, int frames, double rate_hz,
                                      const Terrain& terrain) {
    if (frames < 1 || !(rate_hz > 0)) {
        throw ContractError(fmt::format(
            "make_path: {} frames at {} Hz, expected at least 1 above 0 Hz", frames, rate_hz));
    }
    switch (spec.kind) {
        case PathKind::line:
        case PathKind::spline:
        case PathKind::terrain_following:
            return std::make_unique<CurvePath>(spec, frames, rate_hz, terrain);
        case PathKind::orbit: return std::make_unique<OrbitPath>(spec, frames, terrain);
        case PathKind::recorded: return std::make_unique<RecordedPath>(spec, frames);
        case PathKind::still: return std::make_unique<StillPath>(spec, frames);
    }
    throw ContractError("make_path: the kind of path is not one of PathKind");
}

}  // namespace lodbench::scenario
