#pragma once
// The claims of a paper against what was flown: only figures decide.

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
    std::string reason;  ///< why it is not decided or not judged
};

struct ReadingVerdict {
    std::string reading;
    Outcome outcome = Outcome::unjudged;
    std::vector<Finding> findings;
};

struct Verdict {
    const Claim* claim = nullptr;
    Outcome outcome = Outcome::unjudged;
    std::string reason;  ///< why no figure was asked for; "" where some were
    std::vector<ReadingVerdict> readings;
};

/// What is flown, where that decides whether a claim can be judged.
struct Setting {
    bool own_terrain = false;  ///< the paper's, which the user had
};

/// In the order of the claims, whose addresses they hold. A claim of which one finding fails does
/// not hold, whatever the others say; of which one could not be made, cannot be judged; of which
/// one is not decided, is not. Throws InputError as Evidence::measure.
[[nodiscard]] std::vector<Verdict> judge(const Paper& paper, const Evidence& evidence,
                                         const Setting& setting);

/// A cell of a table: the paper's figure and ours, and both over their baselines.
struct TableCell {
    std::optional<double> published, published_ratio;
    Measured ours, ours_ratio;  ///< the ratio without value where there is no baseline
    bool is_time = false;       ///< so that it compares by its ratio alone
};
/// `reading` completes the table's selections. Throws InputError as Evidence::measure.
[[nodiscard]] TableCell table_cell(const Table& table, std::size_t row, std::size_t column,
                                   const Evidence& evidence, const Selection& reading = {});

}  // namespace lodbench::reproduce
