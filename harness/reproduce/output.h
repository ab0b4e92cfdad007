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

/// A table of texts, for Markdown and for the page.
struct TextTable {
    std::string id, caption;
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
};

/// Claims judged, by paper.
[[nodiscard]] TextTable overview_table(const std::vector<PaperOutcome>& outcomes);
/// A row a claim, with what decides it.
[[nodiscard]] TextTable claim_table(const PaperOutcome& outcome);
/// Every figure that a claim asked for.
[[nodiscard]] TextTable finding_table(const Verdict& verdict);
/// The paper's figures and ours; times as ratios to the baseline alone.
[[nodiscard]] TextTable figure_table(const PaperOutcome& outcome, const Table& table);
/// What was flown, how, over what, on what, and why not.
[[nodiscard]] std::vector<std::string> conditions(const PaperOutcome& outcome);

[[nodiscard]] std::string to_markdown(const std::vector<PaperOutcome>& outcomes);
/// The whole page, which opens offline.
[[nodiscard]] std::string to_html(const std::vector<PaperOutcome>& outcomes);
[[nodiscard]] Json::Value to_json(const std::vector<PaperOutcome>& outcomes);

}  // namespace lodbench::reproduce
