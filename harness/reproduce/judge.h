#pragma once
// The claims of a paper against what was flown: only figures decide.

#include <set>
#include <string>
#include <vector>

#include "reproduce/evidence.h"
#include "reproduce/paper.h"

namespace lodbench::reproduce {

enum class Outcome {
    holds,      ///< all of each interval says so
    fails,      ///< all of one interval says so
    undecided,  ///< within noise
    unjudged,   ///< cannot be judged here
    depends,    ///< differs between readings; of a claim alone
};
/// "holds", "does not hold", "not decided", "cannot be judged here", "depends on the reading"
[[nodiscard]] const char* name_of(Outcome outcome);

/// One figure that a test asked for.
struct Finding {
    std::string what;               ///< "fps / fps; grid=600"
    std::optional<Interval> value;  ///< that decides it
    std::string expected;           ///< ">= 1"
    Outcome outcome = Outcome::unjudged;
    std::string reason;                ///< why it is not decided or not judged
    std::set<std::string> cells = {};  ///< that it is of: "EXPERIMENT/CELL"
};

/// Whether what is said of a claim that does not hold is so, where it does not.
struct ExplanationVerdict {
    const Explanation* explanation = nullptr;
    Outcome outcome = Outcome::unjudged;  ///< holds: confirmed
    std::vector<Finding> findings;
};

struct ReadingVerdict {
    std::string reading;
    Outcome outcome = Outcome::unjudged;
    std::vector<Finding> findings;
    std::vector<ExplanationVerdict> explanations;  ///< of a reading that does not hold

    /// Of one that does not hold: whether an explanation is confirmed.
    [[nodiscard]] bool explained() const;
};

struct Verdict {
    const Claim* claim = nullptr;
    Outcome outcome = Outcome::unjudged;
    std::string reason;  ///< why no figure was asked for; "" where some were
    std::vector<ReadingVerdict> readings;

    /// Of one that does not hold: whether each reading of it is explained.
    [[nodiscard]] bool explained() const;
};

/// What is flown, where that decides whether a claim can be judged.
struct Setting {
    bool own_terrain = false;  ///< the paper's, which the user had
};

/// In the order of the claims, whose addresses they hold. A claim of which one finding fails does
/// not hold, whatever the others say; of which one could not be made, cannot be judged; of which
/// one is not decided, is not. Throws InputError as Evidence::measure, and for an explanation that
/// asks for no cell but those of its claim: what it is about was not changed.
[[nodiscard]] std::vector<Verdict> judge(const Paper& paper, const Evidence& evidence,
                                         const Setting& setting);

/// Asks all claims, explanations, tables and curves for their cells, before any of them is flown.
/// Throws InputError as `judge` does.
void check_selections(const Paper& paper, const Evidence& planned);

/// A cell of a table: the paper's figure and ours, and both over their baselines.
struct TableCell {
    std::optional<double> published, published_ratio;
    Measured ours, ours_ratio;  ///< the ratio without value where there is no baseline
    bool is_time = false;       ///< so that it compares by its ratio alone
};
/// `reading` completes the table's selections. Throws InputError as Evidence::measure.
[[nodiscard]] TableCell table_cell(const Table& table, std::size_t row, std::size_t column,
                                   const Evidence& evidence, const Selection& reading = {});

/// A curve of a figure, the paper's and ours: each over the mean of its own baseline.
struct CurvePair {
    using Points = std::vector<std::pair<double, double>>;  ///< part of the flight, and value
    Points published, ours;
    std::optional<double> published_mean, our_mean;  ///< over the flight
    std::string why_not;                             ///< why there is none of ours
};
/// In the order of the figure's curves. Throws InputError as Evidence::measure.
[[nodiscard]] std::vector<CurvePair> curve_pairs(const LineFigure& figure,
                                                 const Evidence& evidence);

}  // namespace lodbench::reproduce
