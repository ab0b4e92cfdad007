#pragma once
// Figures with their uncertainty, and what can be said of them: only what all of the interval says.

#include <optional>
#include <span>
#include <string>

namespace lodbench::reproduce {

/// Four digits, and all that stand before the point: "1.234", "1198080".
[[nodiscard]] std::string number_text(double value);

/// What is known of a figure: `low` <= `centre` <= `high`; infinite where it was measured so.
struct Interval {
    double centre = 0, low = 0, high = 0;

    [[nodiscard]] static Interval exactly(double value) { return {value, value, value}; }
    [[nodiscard]] bool is_exact() const { return low == high; }
    /// "1.34 [1.3, 1.38]"; of an exact one "1.34".
    [[nodiscard]] std::string text() const;
};

/// a / b, for b > 0 and a >= 0. Nothing where b may be 0, or where both may be infinite.
[[nodiscard]] std::optional<Interval> ratio(const Interval& a, const Interval& b);

/// The greatest of several over the least of them, at least 1; nothing as for `ratio`.
[[nodiscard]] std::optional<Interval> spread(std::span<const Interval> values);

/// Spearman's rank correlation of two lists of equal length, ties at the mean of their ranks; in
/// [-1, 1]. Its interval is that of the middle 95 % of 2,000 draws (seeded), each value evenly from
/// its own interval. Nothing for fewer than three pairs, where all values of a list are equal, or
/// one is infinite.
[[nodiscard]] std::optional<Interval> rank_correlation(std::span<const Interval> a,
                                                       std::span<const Interval> b);

enum class Answer { yes, no, undecided };

/// What is asked of a figure: a part of the number line.
struct Range {
    std::optional<double> least, most;   ///< within, the ends included
    std::optional<double> above, below;  ///< within, the ends excluded

    /// yes: all of the interval lies within; no: none of it; undecided: a part.
    [[nodiscard]] Answer holds(const Interval& value) const;
    /// ">= 1 and <= 1.25"
    [[nodiscard]] std::string text() const;
    [[nodiscard]] bool empty() const { return !least && !most && !above && !below; }
};

/// Whether `later` is not below `earlier` (`falling`: not above), strictly where asked for.
[[nodiscard]] Answer rises(const Interval& earlier, const Interval& later, bool falling,
                           bool strictly);

}  // namespace lodbench::reproduce
