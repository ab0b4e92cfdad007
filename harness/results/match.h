#pragma once
// match.json: what is to be equal, and how each method's search for it went.

#include <json/value.h>

#include <optional>
#include <string>
#include <vector>

#include "results/error_metric.h"

namespace lodbench::results {

/// What is to be equal.
struct MatchTarget {
    enum class Quantity { pixel_error, triangles, frame_ms };
    Quantity quantity = Quantity::pixel_error;
    ErrorMetric metric = ErrorMetric::p999;  ///< of the pixel error
    double value = 1;                        ///< pixels, triangles, milliseconds; > 0
    double tolerance = 0.05;                 ///< ratio, in (0, 1)

    /// "p999 of the pixel error = 1 px"
    [[nodiscard]] std::string words() const;
    /// Whether a measured value is within the tolerance.
    [[nodiscard]] bool meets(double measured) const;
    /// The quantity in a cell's record: mean over the flight where there is one value a frame.
    [[nodiscard]] std::optional<double> measured(const CellRecord& cell) const;
};

struct MatchRecord {
    struct Probe {
        double knob = 0;
        std::optional<double> value;  ///< may be infinite; nothing where the cell failed
    };
    struct Method {
        std::string method;
        std::optional<std::string> knob;             ///< nothing: flown as it is, and not searched
        std::optional<std::string> outcome;          ///< met, unreachable, between
        std::optional<double> knob_value, achieved;  ///< of the nearest probe
        std::optional<bool> monotone;                ///< all probes rise, or all fall
        std::optional<std::string> failure;          ///< why a probe gave nothing
        std::vector<Probe> probes;                   ///< in order of time
    };
    MatchTarget target;
    std::vector<Method> methods;
};

[[nodiscard]] Json::Value to_json(const MatchRecord& record);

/// The reverse. `where` names the file. Throws InputError naming it, the method and the key.
[[nodiscard]] MatchRecord read_match(const Json::Value& json, const std::string& where);

}  // namespace lodbench::results
