#pragma once
// A method's quality knob: what trades speed for accuracy.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "run/plugin_library.h"

namespace lodbench::run {

/// A numeric parameter with its range; `minimum` <= `start` <= `maximum`.
struct Knob {
    std::string name;
    bool integer = false;
    double minimum = 0, maximum = 0;
    double start = 0;  ///< where a search begins: the parameter's default, or what a scenario keeps

    /// Positive ranges over more than a decade are walked by factors, others by differences.
    [[nodiscard]] bool geometric() const { return minimum > 0 && maximum >= 10 * minimum; }
    /// The nearest value that the parameter takes, of four significant digits where it is real.
    [[nodiscard]] double admitted(double value) const;
    /// As --set takes it: read back to the bit.
    [[nodiscard]] std::string text(double value) const;
};

/// Nothing for a method without a knob, or with one that is no number.
[[nodiscard]] std::optional<Knob> quality_knob(const MethodInfo& method);

/// `points` (>= 1) values around the default, each twice the one before (or a tenth of the range
/// apart), those outside the range left out; rising, without repetitions.
[[nodiscard]] std::vector<double> sweep_values(const Knob& knob, int points);

/// What a knob's value was measured to give; nothing where the cell failed.
struct Probe {
    double knob = 0;
    std::optional<double> value;
};

enum class SearchOutcome {
    met,          ///< within the tolerance
    unreachable,  ///< beyond what the knob's range (or the last value that could be flown) gives
    between,  ///< probes lie on both sides, none within the tolerance: a jump between values of the
              ///< knob that lie within a tenth of the tolerance or are neighbours, a cell that
              ///< failed, or no probe left
};
[[nodiscard]] const char* name_of(SearchOutcome outcome);

struct SearchResult {
    SearchOutcome outcome = SearchOutcome::unreachable;
    std::optional<Probe>
        best;  ///< nearest to the target by ratio, of equals the last; nothing where all failed
    std::vector<Probe> probes;  ///< in order of time
    bool monotone = true;       ///< all probes rise, or all fall, with the knob (to 2 %)
};

/// Finds the knob value at which `measure` gives `target` (> 0) within `tolerance` (a ratio, 0.05
/// is 5 %): steps of a factor 4 from the default until the target lies between two probes, then
/// bisection, by the slope between logarithms where that falls inside. `measure` is asked at most
/// `most_probes` times, never twice for one value; it gives nothing where a cell failed, and may
/// give infinity.
[[nodiscard]] SearchResult search_knob(const Knob& knob, double target, double tolerance,
                                       int most_probes,
                                       const std::function<std::optional<double>(double)>& measure);

}  // namespace lodbench::run
