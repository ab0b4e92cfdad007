#pragma once
// extremes.json: the matrix method x axis, and of each step what was measured and what broke.

#include <json/value.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "results/field.h"
#include "results/record_json.h"

namespace lodbench::results {

/// The file of the matrix in its folder.
inline constexpr const char* kExtremesFile = "extremes.json";

/// What was measured of one method at one step, over all its frames.
struct ExtremesFigures {
    std::optional<int> frames;
    std::optional<std::uint64_t> triangles_min, triangles_max;  ///< of a frame
    std::optional<std::uint64_t> not_finite, unrepeated;
    std::optional<std::uint64_t> samples, uncovered_samples, crack_pixels, pixels;
    std::optional<double> screen_max_px, screen_p999_px, pixel_p999_px;
    std::optional<int> worst_frame, worst_row, worst_column;
    std::optional<double> claimed_px, rounding_px;
    // Of a step that moves or scales the world, against the same flight in the world as it is.
    std::optional<double> moved_m;
    std::optional<std::uint64_t> changed_triangles, compared_triangles, changed_pixels;
    std::optional<int> image_levels;
    std::optional<int> changed_frame;
};

/// One thing that broke.
struct ExtremesFault {
    std::string what;   ///< crash, hang, memory, failed, not-finite, not-repeatable, ...
    std::string where;  ///< call, frame, sample
    std::optional<double> found, allowed;
    std::string unit;
    std::string words;     ///< the whole in one line
    std::string inherent;  ///< why it is the paper's own; "" where nobody has said so
};

struct ExtremesStep {
    std::string step;
    std::string outcome;  ///< good, degraded, broken, dead, or not-flown
    std::string reason;   ///< of not-flown
    std::vector<ExtremesFault> faults;
    std::optional<ExtremesFigures> figures;
    std::string picture;  ///< PNG, relative to the folder; "" for none
    std::string again;    ///< the command that repeats it
    std::optional<double> seconds;
};

/// A cell of the matrix.
struct ExtremesCell {
    std::string method, axis;
    std::string grade;  ///< the worst outcome of its steps, see `grade_of`
    int good = 0, flown = 0;
    std::string last_good;      ///< the last step before the first failure; "" for none
    std::string first_failure;  ///< "" for none
    std::vector<ExtremesStep> steps;
};

struct ExtremesAxis {
    std::string axis, title, about;
    std::vector<std::string> steps;
};

struct ExtremesMatrix {
    std::string form;  ///< whole or quick
    std::string terrain, terrain_checksum, device, version, began, command;
    std::vector<std::string> methods;  ///< in the matrix's order
    std::vector<ExtremesAxis> axes;
    std::vector<ExtremesCell> cells;
    std::vector<std::string> warnings;

    /// nullptr where there is none.
    [[nodiscard]] const ExtremesCell* find(const std::string& method,
                                           const std::string& axis) const;
};

/// stable, degrades, breaks, dies: from none of its steps failed to one ended the process. "not
/// flown" where none was flown.
[[nodiscard]] const char* grade_of(const std::vector<ExtremesStep>& steps);
/// By how bad they are, 0 is good; -1 for what is no outcome.
[[nodiscard]] int severity_of(std::string_view outcome);

/// Grade, counts, last good step and first failure from the steps.
void sum_up(ExtremesCell& cell);

/// "degrades 5/8: 1e8 m: ...", in one line.
[[nodiscard]] std::string words_of(const ExtremesCell& cell);

[[nodiscard]] Json::Value to_json(const ExtremesMatrix& matrix);
/// Throws InputError with `where`, the member and the remedy for what is not one.
[[nodiscard]] ExtremesMatrix read_extremes(const Json::Value& json, const std::string& where);
/// That of a folder. Throws InputError, EnvironmentError.
[[nodiscard]] ExtremesMatrix read_extremes_folder(const std::filesystem::path& folder);
[[nodiscard]] bool holds_extremes(const std::filesystem::path& folder);

template <>
struct FieldTable<ExtremesFigures> {
    using R = ExtremesFigures;
    static constexpr std::tuple fields{
        Field{"frames", &R::frames, "", "measured"},
        Field{"triangles_min", &R::triangles_min, "", "fewest of a frame"},
        Field{"triangles_max", &R::triangles_max, "", "most of a frame"},
        Field{"not_finite", &R::not_finite, "", "captured vertices that are NaN or infinite"},
        Field{"unrepeated", &R::unrepeated, "",
              "frames that, selected again with the same camera, were other triangles"},
        Field{"samples", &R::samples, "", "in view, of all frames"},
        Field{"uncovered_samples", &R::uncovered_samples, "", "of them, those without a triangle"},
        Field{"crack_pixels", &R::crack_pixels, "", "pixels that show a crack"},
        Field{"pixels", &R::pixels, "", "of all frames"},
        Field{"screen_max_px", &R::screen_max_px, "px", "greatest screen error of covered samples"},
        Field{"screen_p999_px", &R::screen_p999_px, "px", "P99.9 of the screen error"},
        Field{"pixel_p999_px", &R::pixel_p999_px, "px", "P99.9 of the pixel error"},
        Field{"worst_frame", &R::worst_frame, "", "of the greatest screen error"},
        Field{"worst_row", &R::worst_row, "", "its sample's row"},
        Field{"worst_column", &R::worst_column, "", "its sample's column"},
        Field{"claimed_px", &R::claimed_px, "px", "the method's bound"},
        Field{"rounding_px", &R::rounding_px, "px",
              "screen error that float positions alone may make at the worst sample"},
        Field{"moved_m", &R::moved_m, "m",
              "greatest distance of the surface from where it is in the world as it is"},
        Field{"changed_triangles", &R::changed_triangles, "",
              "triangles whose bits differ from those in the world as it is"},
        Field{"compared_triangles", &R::compared_triangles, "", "of so many"},
        Field{"changed_pixels", &R::changed_pixels, "", "pixels that differ by more than a level"},
        Field{"image_levels", &R::image_levels, "levels of 255", "greatest difference of a pixel"},
        Field{"changed_frame", &R::changed_frame, "", "frame of the greatest distance"}};
};

template <>
struct FieldTable<ExtremesFault> {
    using R = ExtremesFault;
    static constexpr std::tuple fields{
        Field{"what", &R::what, "", "kind of failure", true},
        Field{"where", &R::where, "", "call, frame or sample"},
        Field{"found", &R::found, "", "figure found"},
        Field{"allowed", &R::allowed, "", "greatest that is allowed"},
        Field{"unit", &R::unit, "", "of both"},
        Field{"words", &R::words, "", "in one line"},
        Field{"inherent", &R::inherent, "", "why it is the paper's own"}};
};

template <>
struct FieldTable<ExtremesStep> {
    using R = ExtremesStep;
    static constexpr std::tuple fields{
        Field{"step", &R::step, "", "its name", true},
        Field{"outcome", &R::outcome, "", "good, degraded, broken, dead or not-flown", true},
        Field{"reason", &R::reason, "", "why it was not flown"},
        Field{"faults", &R::faults, "", "what broke"},
        Field{"figures", &R::figures, "", "what was measured"},
        Field{"picture", &R::picture, "", "file in the folder"},
        Field{"again", &R::again, "", "command that repeats it"},
        Field{"seconds", &R::seconds, "s", "wall time"}};
};

template <>
struct FieldTable<ExtremesCell> {
    using R = ExtremesCell;
    static constexpr std::tuple fields{
        Field{"method", &R::method, "", "its id", true},
        Field{"axis", &R::axis, "", "its name", true},
        Field{"grade", &R::grade, "", "stable, degrades, breaks or dies; not-flown", true},
        Field{"good", &R::good, "", "steps without a failure"},
        Field{"flown", &R::flown, "", "steps flown"},
        Field{"last_good", &R::last_good, "", "last step before the first failure"},
        Field{"first_failure", &R::first_failure, "", "first step that failed"},
        Field{"steps", &R::steps, "", "each of them"}};
};

template <>
struct FieldTable<ExtremesAxis> {
    using R = ExtremesAxis;
    static constexpr std::tuple fields{Field{"axis", &R::axis, "", "its name", true},
                                       Field{"title", &R::title, "", "for people"},
                                       Field{"about", &R::about, "", "what is pushed, in a line"}};
};

template <>
struct FieldTable<ExtremesMatrix> {
    using R = ExtremesMatrix;
    static constexpr std::tuple fields{
        Field{"form", &R::form, "", "whole or quick", true},
        Field{"terrain", &R::terrain, "", "of the mild setting"},
        Field{"terrain_checksum", &R::terrain_checksum, "", "of its samples"},
        Field{"device", &R::device, "", "what drew it"},
        Field{"version", &R::version, "", "of lodbench"},
        Field{"began", &R::began, "", "UTC"},
        Field{"command", &R::command, "", "as typed"},
        Field{"axes", &R::axes, "", "in the order of the table"},
        Field{"cells", &R::cells, "", "one for each method and axis"}};
};

}  // namespace lodbench::results
