#pragma once
// A reproduction as Markdown, as a page, and for machines.

#include <json/value.h>

#include <string>
#include <vector>

#include "reproduce/evidence.h"
#include "reproduce/judge.h"

namespace lodbench::reproduce {

/// What came of one paper.
struct PaperOutcome {
    const Paper* paper = nullptr;
    Evidence evidence;
    std::vector<Verdict> verdicts;
    bool quick = false;
};

/// How many claims of it came to an outcome.
[[nodiscard]] std::size_t count(const PaperOutcome& outcome, Outcome which);

/// Of those that do not hold, how many have an explanation that an experiment confirmed.
[[nodiscard]] std::size_t count_explained(const PaperOutcome& outcome);

/// A table of texts, for Markdown and for the page.
struct TextTable {
    std::string id, caption;
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
};

/// Claims judged, by paper, and in all where there are several.
[[nodiscard]] TextTable overview_table(const std::vector<PaperOutcome>& outcomes);
/// The same, each paper linked to its section of `document`, which `to_markdown` wrote.
[[nodiscard]] std::string overview_markdown(const std::vector<PaperOutcome>& outcomes,
                                            const std::string& document);
/// A row a claim, with what decides it, and why where it does not hold: what an experiment
/// confirmed, or "not explained".
[[nodiscard]] TextTable claim_table(const PaperOutcome& outcome);
/// Every figure that a claim asked for.
[[nodiscard]] TextTable finding_table(const Verdict& verdict);
/// The paper's figures and ours; times as ratios to the baseline alone.
[[nodiscard]] TextTable figure_table(const PaperOutcome& outcome, const Table& table);
/// The means of a figure's curves over its baseline's: the paper's and ours.
[[nodiscard]] TextTable curve_table(const PaperOutcome& outcome, const LineFigure& figure);
/// What was flown, how, over what, on what, and why not.
[[nodiscard]] std::vector<std::string> conditions(const PaperOutcome& outcome);

[[nodiscard]] std::string to_markdown(const std::vector<PaperOutcome>& outcomes);
/// The whole page, which opens offline.
[[nodiscard]] std::string to_html(const std::vector<PaperOutcome>& outcomes);
[[nodiscard]] Json::Value to_json(const std::vector<PaperOutcome>& outcomes);

}  // namespace lodbench::reproduce
