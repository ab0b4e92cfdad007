#pragma once
// Two runs compared: what is deterministic exactly, times by a rank test with an honest "cannot
// tell". Made for a gate that neither cries wolf nor hides a wolf.

#include <json/value.h>

#include <cstddef>
#include <string>
#include <vector>

#include "measure/rank_test.h"
#include "results/folder.h"

namespace lodbench::compare {

/// Below this many repetitions on either side times get no verdict.
inline constexpr std::size_t kLeastRuns = 9;

struct Rules {
    /// The least change of a time that matters, a share: "within noise" says that the true change
    /// is below it (95 % confidence).
    double matters = 0.05;
    /// The chance that a comparison of equal runs calls any of its times slower or faster: half of
    /// the 1 % that is promised, for repetitions are not quite independent.
    double alpha = 0.005;
    /// Runs of one build, from which the effect floor is measured; none: from the repetitions'
    /// spread.
    std::vector<results::ResultFolder> noise;
};

/// A deterministic figure that is not the same. Texts are as in JSON, or "not measured".
struct Change {
    std::string field;  ///< "triangles.mean"
    std::string before, after;
};

/// The first frame in which a deterministic column of frames/<cell>.csv is not the same.
struct FrameChange {
    std::string column;
    std::size_t frame = 0;
    std::string before, after;
    std::size_t changed = 0, frames = 0;  ///< in how many of how many frames
};

enum class TimeVerdict {
    slower,
    faster,
    within_noise,
    cannot_tell,
    not_the_methods  ///< it is slower or faster, but plugin and counters are unchanged
};
[[nodiscard]] const char* words_of(TimeVerdict verdict);

/// One time of one setting on one device. Times are in the figure's unit, shares are of BASE.
struct TimeComparison {
    std::string figure;                       ///< "frame_ms.median"
    std::string device;                       ///< "" where both runs have one alone
    std::size_t base_runs = 0, new_runs = 0;  ///< repetitions
    double base = 0, now = 0;                 ///< medians over the repetitions
    measure::RatioInterval ratio;             ///< NEW / BASE, 95 %
    double p = 1;                 ///< of the rank test, for all tests of this comparison (Holm)
    double floor = 0;             ///< a smaller change is never called one
    bool measured_floor = false;  ///< from A/A runs; else from the spread
    bool in_turn = false;  ///< cells of both runs were flown by turns, not one run after the other
    TimeVerdict verdict = TimeVerdict::cannot_tell;
    std::size_t runs_needed = 0;  ///< of each side; where it cannot be told, else 0

    /// A slow-down that a gate may fail for: measured side by side.
    [[nodiscard]] bool fails_gate() const { return verdict == TimeVerdict::slower && in_turn; }
};

struct SettingComparison {
    std::string scenario, method;
    std::string label;        ///< method and the parameters in which its settings differ
    std::string cell;         ///< of NEW: that of its first repetition
    bool one_device = false;  ///< figures are compared to the bit; else within the stated rounding
    std::vector<std::string> failures;  ///< of NEW, where BASE has none, in words
    std::vector<Change> changes;
    std::vector<FrameChange> frame_changes;
    std::vector<TimeComparison> times;
    std::vector<std::string> notes;

    [[nodiscard]] bool same_figures() const {
        return failures.empty() && changes.empty() && frame_changes.empty();
    }
};

struct Comparison {
    std::string base, now;  ///< folders
    std::vector<SettingComparison> settings;
    std::vector<std::string> missing, added;  ///< "method setting, scenario"
    std::vector<std::string> notes;           ///< of the whole, in words
    std::size_t time_tests = 0;

    [[nodiscard]] bool gate_holds() const;
    /// 0, 1 (with `gate`, where it does not hold) or 4 (nothing was compared).
    [[nodiscard]] int exit_status(bool gate) const;
};

/// A results folder for `compare_runs`: with the deterministic columns of its frames, where they
/// are there. Throws InputError.
[[nodiscard]] results::ResultFolder read_run_to_compare(const std::filesystem::path& path);

[[nodiscard]] Comparison compare_runs(const results::ResultFolder& base,
                                      const results::ResultFolder& now, const Rules& rules);

/// As `--json` prints it.
[[nodiscard]] Json::Value to_json(const Comparison& comparison);

}  // namespace lodbench::compare
