#include "scenario/flight_section.h"

#include <fmt/format.h>

#include "scenario/camera_string.h"

namespace lodbench::scenario {
namespace {

constexpr Limits kHeading{-360, 360};
constexpr Limits kPitch{-90, 90};
constexpr Limits kRoll{-360, 360};
constexpr Limits kSpeed{1e-6, 1e9};
constexpr Limits kLength{0, 1e9};
constexpr Limits kPositive{1e-6, 1e9};

glm::dvec3 as_position(const std::vector<double>& numbers) {
    return {numbers[0], numbers[1], numbers.size() > 2 ? numbers[2] : 0.0};
}

void read_angles(Section& section, Keyframe& key) {
    key.heading = section.number("heading", kHeading);
    key.pitch = section.number("pitch", kPitch).value_or(0);
    key.roll = section.number("roll", kRoll).value_or(0);
}

/// start and end, or start, heading and speed. `dimensions`: 2 where the height is not the user's.
void read_line(Section& flight, std::size_t dimensions, PathSpec& spec) {
    const auto start = flight.numbers("start", dimensions, dimensions);
    const auto end = flight.numbers("end", dimensions, dimensions);
    if (!start) {
        flight.require("start",
                       dimensions == 2 ? "write start = [x, y]" : "write start = [x, y, z]");
    }
    Keyframe key{as_position(*start), {}, 0, 0};
    read_angles(flight, key);
    spec.keyframes.push_back(key);
    if (end) {
        if (*end == *start) {
            flight.refuse("end",
                          "the same as start; move one of them, or, for a camera that stands "
                          "still, fly kind = \"still\"");
        }
        key.position = as_position(*end);
        spec.keyframes.push_back(key);
    } else if (!key.heading || spec.speed == 0) {
        flight.require("end", "write end, or heading and speed");
    }
}

void read_keyframes(Section& flight, std::size_t dimensions, PathSpec& spec) {
    for (Section& section : flight.sections("keyframe")) {
        const auto position = section.numbers("position", dimensions, dimensions);
        if (!position) {
            section.require("position", dimensions == 2 ? "write position = [x, y]"
                                                        : "write position = [x, y, z]");
        }
        Keyframe key{as_position(*position), {}, 0, 0};
        read_angles(section, key);
        section.refuse_unknown();
        if (!spec.keyframes.empty()) {
            const Keyframe& previous = spec.keyframes.back();
            if (previous.position == key.position) {
                section.refuse("position",
                               "that of the keyframe before; move or remove one of them");
            }
            if (previous.heading.has_value() != key.heading.has_value()) {
                section.refuse(key.heading ? "heading" : "position",
                               "give all keyframes a heading, or none to look along the flight");
            }
        }
        spec.keyframes.push_back(key);
    }
    if (spec.keyframes.size() < 2) {
        flight.require("keyframe",
                       fmt::format("write at least two tables [[flight.keyframe]], there "
                                   "are {}",
                                   spec.keyframes.size()));
    }
}

void read_orbit(Section& flight, PathSpec& spec) {
    const auto centre = flight.numbers("centre", 2, 3);
    if (!centre) flight.require("centre", "write centre = [x, y] or [x, y, z]");
    spec.centre = as_position(*centre);
    const auto radius = flight.number("radius", kPositive);
    if (!radius) flight.require("radius", "write the radius in metres");
    spec.radius = *radius;
    spec.height = flight.number("height").value_or(0);
    spec.turns = flight.number("turns", {-1e4, 1e4}).value_or(1);
    spec.bearing = flight.number("bearing", kHeading).value_or(180);
}

void read_terrain_following(Section& flight, PathSpec& spec) {
    const auto height = flight.number("height", kPositive);
    if (!height) flight.require("height", "write the height above ground in metres");
    spec.height = *height;
    spec.smoothing = flight.number("smoothing", kLength).value_or(0);
    spec.margin = flight.number("margin", {0, spec.height});
    if (flight.has("keyframe")) {
        read_keyframes(flight, 2, spec);
    } else {
        read_line(flight, 2, spec);
        (void)flight.node("keyframe");
    }
}

PathKind read_kind(Section& flight) {
    const auto kind = flight.text("kind");
    const std::vector<std::string> known = {"line",     "spline", "orbit", "terrain-following",
                                            "recorded", "still"};
    constexpr PathKind kKinds[] = {PathKind::line,     PathKind::spline,
                                   PathKind::orbit,    PathKind::terrain_following,
                                   PathKind::recorded, PathKind::still};
    if (!kind) flight.require("kind", Section::known_names("", known));
    for (std::size_t i = 0; i < known.size(); ++i) {
        if (*kind == known[i]) return kKinds[i];
    }
    flight.refuse("kind", "not a kind of flight; " + Section::known_names(*kind, known));
}

}  // namespace

std::filesystem::path existing_file(const Section& section, std::string_view key,
                                    const std::string& written,
                                    const std::filesystem::path& folder) {
    const std::filesystem::path path = (folder / written).lexically_normal();
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) {
        section.refuse(key, fmt::format("no such file ({}); paths are relative to the scenario's "
                                        "folder",
                                        path.string()));
    }
    return path;
}

PathSpec read_path(Section& flight, const std::filesystem::path& folder,
                   const std::filesystem::path& kept) {
    PathSpec spec;
    spec.where = flight.where();
    spec.kind = read_kind(flight);
    if (spec.kind != PathKind::recorded && spec.kind != PathKind::still) {
        spec.relative = flight.boolean("relative").value_or(false);
    }
    if (spec.kind == PathKind::line || spec.kind == PathKind::spline ||
        spec.kind == PathKind::orbit) {
        spec.above_ground = flight.boolean("above_ground").value_or(false);
    }
    if (spec.kind == PathKind::line || spec.kind == PathKind::spline ||
        spec.kind == PathKind::terrain_following) {
        spec.speed = flight.number("speed", kSpeed).value_or(0);
    }
    switch (spec.kind) {
        case PathKind::line: read_line(flight, 3, spec); break;
        case PathKind::spline: read_keyframes(flight, 3, spec); break;
        case PathKind::orbit: read_orbit(flight, spec); break;
        case PathKind::terrain_following: read_terrain_following(flight, spec); break;
        case PathKind::recorded: {
            const auto file = flight.text("file");
            if (!file) flight.require("file", "write the CSV file of the recorded flight");
            spec.recorded = kept.empty() ? existing_file(flight, "file", *file, folder) : kept;
            break;
        }
        case PathKind::still: {
            const auto text = flight.text("camera");
            if (!text) flight.require("camera", "write the camera as `lodbench view` copies it");
            spec.standing = parse_camera(*text, flight.where("camera"));
            break;
        }
    }
    return spec;
}

}  // namespace lodbench::scenario
