#pragma once
// The battery as data: axes that are pushed step by step away from a mild setting, and what is
// known to break for a reason of the paper's own.

#include <filesystem>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace lodbench::extremes {

/// A world that is another one's copy, moved and scaled: terrain, cameras and near plane alike, so
/// that the same picture is to be seen. x' = scale * x + shift.
struct WorldChange {
    glm::dvec2 shift{0.0};  ///< metres
    double scale = 1;       ///< > 0
    [[nodiscard]] bool any() const { return shift != glm::dvec2(0) || scale != 1; }
    /// Whether scaling a float by it is exact.
    [[nodiscard]] bool is_power_of_two() const;
};

struct Step {
    std::string name;
    scenario::Overrides overrides;  ///< of the mild setting, after the axis's own
    WorldChange world;
    std::string knob;      ///< value of each method's quality knob; "" for the default
    bool refused = false;  ///< the value is none: it has to be refused
    bool quick = false;    ///< of the quick form as well
    bool heavy = false;    ///< flown only where it is asked for: gigabytes, or minutes
};

struct Axis {
    std::string id, title, about;
    scenario::Overrides overrides;  ///< of all its steps
    std::vector<Step> steps;        ///< each further from the mild setting than the one before
};

/// A failure that the paper's method has in any implementation.
struct Inherent {
    std::string method;
    std::string axis;                ///< "": any
    std::vector<std::string> steps;  ///< of the axis; empty: any
    std::vector<std::string> what;   ///< kinds of failure; empty: any
    std::string why;                 ///< one line
    std::string where;               ///< "inherent.toml:12"

    [[nodiscard]] bool covers(const std::string& of_method, const std::string& of_axis,
                              const std::string& step, const std::string& fault) const;
};

struct Battery {
    std::filesystem::path mild, quick_mild;  ///< scenarios of the whole and of the quick form
    std::vector<Axis> axes;
    std::vector<Inherent> inherent;

    /// Throws InputError that lists the names.
    [[nodiscard]] const Axis& axis(const std::string& id) const;
};

/// Reads battery.toml of a folder and what it names. Throws InputError, "FILE:LINE: ...".
[[nodiscard]] Battery read_battery(const std::filesystem::path& folder);

}  // namespace lodbench::extremes
