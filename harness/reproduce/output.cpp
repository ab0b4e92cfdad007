#include "reproduce/output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "report/table.h"
#include "results/json.h"

namespace lodbench::reproduce {

namespace {

using report::markdown_text;

constexpr Outcome kOutcomes[] = {Outcome::holds, Outcome::fails, Outcome::depends,
                                 Outcome::undecided, Outcome::unjudged};

std::string finding_text(const Finding& finding) {
    std::string text = finding.what + ":";
    if (finding.value) text += " " + finding.value->text();
    if (!finding.expected.empty()) text += ", to be " + finding.expected;
    if (!finding.reason.empty()) text += " (" + finding.reason + ")";
    return text;
}

/// The first finding that the outcome comes from, and how many are like it.
std::string deciding(const ReadingVerdict& reading) {
    const auto same = [&](const Finding& finding) { return finding.outcome == reading.outcome; };
    const auto first = std::ranges::find_if(reading.findings, same);
    if (first == reading.findings.end()) return {};
    const auto alike = std::ranges::count_if(reading.findings, same);
    return finding_text(*first) +
           (alike > 1 ? fmt::format("; and {} more of {}", alike - 1, reading.findings.size())
                      : "");
}

std::string evidence_text(const Verdict& verdict) {
    if (!verdict.reason.empty()) return verdict.reason;
    std::string text;
    for (const ReadingVerdict& reading : verdict.readings) {
        if (!text.empty()) text += "; ";
        if (!reading.reading.empty()) {
            text += fmt::format("{}: {}. ", reading.reading, name_of(reading.outcome));
        }
        text += deciding(reading);
    }
    return text;
}

std::string explanation_text(const ReadingVerdict& reading) {
    std::string text;
    for (const ExplanationVerdict& verdict : reading.explanations) {
        if (verdict.outcome != Outcome::holds) continue;
        if (!text.empty()) text += "; ";
        text += verdict.explanation->words;
        const Finding& shown = verdict.findings.front();
        text += fmt::format(" ({}: {}, {})", shown.what, shown.value->text(), shown.expected);
    }
    return text.empty() ? "not explained" : text;
}

/// Why it does not hold; of each reading in which it does not.
std::string explanation_text(const Verdict& verdict) {
    std::string text;
    for (const ReadingVerdict& reading : verdict.readings) {
        if (reading.outcome != Outcome::fails) continue;
        if (!text.empty()) text += "; ";
        if (!reading.reading.empty()) text += reading.reading + ": ";
        text += verdict.outcome == Outcome::depends && !reading.explained()
                    ? "by the reading"
                    : explanation_text(reading);
    }
    return text;
}

std::string published_text(const TableCell& cell) {
    if (!cell.published) return "-";
    const std::string value = number_text(*cell.published);
    return cell.published_ratio ? fmt::format("{} ({:.3g})", value, *cell.published_ratio) : value;
}

std::string our_text(const TableCell& cell) {
    const std::string own_ratio = cell.ours_ratio.value ? cell.ours_ratio.value->text() : "-";
    if (cell.is_time) return own_ratio;
    if (!cell.ours.value) return "-";
    return cell.ours_ratio.value ? fmt::format("{} ({})", cell.ours.value->text(), own_ratio)
                                 : cell.ours.value->text();
}

std::string markdown_row(const std::vector<std::string>& fields) {
    std::string text = "|";
    for (const std::string& field : fields) text += " " + markdown_text(field) + " |";
    return text + "\n";
}

std::string markdown(const TextTable& table) {
    std::string text = markdown_row(table.head) + "|";
    for (std::size_t i = 0; i < table.head.size(); ++i) text += "---|";
    text += "\n";
    for (const auto& row : table.rows) text += markdown_row(row);
    return text;
}

std::string markdown_list(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += "- " + markdown_text(line) + "\n";
    return text;
}

std::string markdown(const PaperOutcome& outcome) {
    const Paper& paper = *outcome.paper;
    std::string text =
        fmt::format("\n<a id=\"{}\"></a>\n\n## {}\n\n{}\n\n", markdown_text(paper.id),
                    markdown_text(paper.title), markdown_text(paper.citation));
    text += markdown_list(conditions(outcome));
    text += "\n### Claims\n\n" + markdown(claim_table(outcome));
    for (const Table& table : paper.tables) {
        const TextTable shown = figure_table(outcome, table);
        text += fmt::format("\n### {}\n\n{}", markdown_text(shown.caption), markdown(shown));
    }
    for (const LineFigure& figure : paper.figures) {
        const TextTable shown = curve_table(outcome, figure);
        text += fmt::format("\n### {}\n\n{}", markdown_text(shown.caption), markdown(shown));
    }
    text += "\n### Every figure\n";
    for (const Verdict& verdict : outcome.verdicts) {
        const TextTable findings = finding_table(verdict);
        if (findings.rows.empty()) continue;
        text += fmt::format("\n<details><summary>{}: {}</summary>\n\n{}\n</details>\n",
                            markdown_text(verdict.claim->id), name_of(verdict.outcome),
                            markdown(findings));
    }
    if (!paper.errata.empty()) text += "\n### Errata\n\n" + markdown_list(paper.errata);
    return text;
}

Json::Value to_json(const Finding& finding) {
    Json::Value json;
    json["what"] = finding.what;
    json["expected"] = finding.expected;
    json["outcome"] = name_of(finding.outcome);
    json["reason"] = finding.reason;
    for (const auto& [name, member] :
         {std::pair("value", &Interval::centre), std::pair("low", &Interval::low),
          std::pair("high", &Interval::high)}) {
        json[name] = finding.value ? results::number_or_inf(*finding.value.*member)
                                   : Json::Value(Json::nullValue);
    }
    json["cells"] = Json::arrayValue;
    for (const std::string& cell : finding.cells) json["cells"].append(cell);
    return json;
}

Json::Value to_json(const std::vector<Finding>& findings) {
    Json::Value json = Json::arrayValue;
    for (const Finding& finding : findings) json.append(to_json(finding));
    return json;
}

Json::Value to_json(const ExplanationVerdict& verdict) {
    Json::Value json;
    json["words"] = verdict.explanation->words;
    json["confirmed"] = verdict.outcome == Outcome::holds;
    json["findings"] = to_json(verdict.findings);
    return json;
}

Json::Value to_json(const Verdict& verdict) {
    Json::Value json;
    json["id"] = verdict.claim->id;
    json["words"] = verdict.claim->words;
    json["place"] = verdict.claim->place;
    json["verdict"] = name_of(verdict.outcome);
    json["reason"] = verdict.reason;
    if (verdict.outcome == Outcome::fails) json["explained"] = verdict.explained();
    json["readings"] = Json::arrayValue;
    for (const ReadingVerdict& reading : verdict.readings) {
        Json::Value entry;
        entry["reading"] = reading.reading;
        entry["verdict"] = name_of(reading.outcome);
        entry["findings"] = to_json(reading.findings);
        entry["explanations"] = Json::arrayValue;
        for (const ExplanationVerdict& explanation : reading.explanations) {
            entry["explanations"].append(to_json(explanation));
        }
        json["readings"].append(entry);
    }
    return json;
}

}  // namespace

std::size_t count(const PaperOutcome& outcome, Outcome which) {
    return std::size_t(std::ranges::count(outcome.verdicts, which, &Verdict::outcome));
}

std::size_t count_explained(const PaperOutcome& outcome) {
    return std::size_t(std::ranges::count_if(outcome.verdicts, &Verdict::explained));
}

TextTable overview_table(const std::vector<PaperOutcome>& outcomes) {
    TextTable table{"overview", "Claims of each paper", {"paper", "claims", "judged"}, {}};
    for (const Outcome which : kOutcomes) {
        table.head.emplace_back(name_of(which));
        if (which == Outcome::fails) table.head.emplace_back("of these explained");
    }
    std::vector<std::size_t> sums(table.head.size() - 1);
    for (const PaperOutcome& outcome : outcomes) {
        const std::size_t claims = outcome.verdicts.size();
        std::vector<std::size_t> row = {claims, claims - count(outcome, Outcome::unjudged)};
        for (const Outcome which : kOutcomes) {
            row.push_back(count(outcome, which));
            if (which == Outcome::fails) row.push_back(count_explained(outcome));
        }
        auto& fields = table.rows.emplace_back();
        fields.push_back(outcome.paper->title);
        for (std::size_t i = 0; i < row.size(); ++i) {
            fields.push_back(fmt::format("{}", row[i]));
            sums[i] += row[i];
        }
    }
    if (outcomes.size() < 2) return table;
    auto& fields = table.rows.emplace_back();
    fields.emplace_back("all");
    for (const std::size_t sum : sums) fields.push_back(fmt::format("{}", sum));
    return table;
}

std::string overview_markdown(const std::vector<PaperOutcome>& outcomes,
                              const std::string& document) {
    const TextTable table = overview_table(outcomes);
    std::string text = markdown_row(table.head) + "|---|";
    for (std::size_t i = 1; i < table.head.size(); ++i) text += "---:|";
    text += "\n";
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        std::vector<std::string> row = table.rows[i];
        for (std::string& field : row) field = markdown_text(field);
        if (i < outcomes.size()) {
            row[0] = fmt::format("[{}]({}#{})", row[0], document, outcomes[i].paper->id);
        }
        text += fmt::format("| {} |\n", fmt::join(row, " | "));
    }
    return text;
}

TextTable claim_table(const PaperOutcome& outcome) {
    TextTable table{"claims-" + outcome.paper->id,
                    "Claims",
                    {"", "claim", "place", "verdict", "decided by", "why not"},
                    {}};
    for (const Verdict& verdict : outcome.verdicts) {
        table.rows.push_back({verdict.claim->id, verdict.claim->words, verdict.claim->place,
                              name_of(verdict.outcome), evidence_text(verdict),
                              explanation_text(verdict)});
    }
    return table;
}

TextTable finding_table(const Verdict& verdict) {
    TextTable table{"findings",
                    verdict.claim->id,
                    {"reading", "figure", "value", "to be", "outcome", "why"},
                    {}};
    const auto add = [&](const std::string& of, const std::vector<Finding>& findings) {
        for (const Finding& finding : findings) {
            table.rows.push_back({of, finding.what, finding.value ? finding.value->text() : "-",
                                  finding.expected, name_of(finding.outcome), finding.reason});
        }
    };
    for (const ReadingVerdict& reading : verdict.readings) {
        add(reading.reading, reading.findings);
        for (const ExplanationVerdict& explanation : reading.explanations) {
            add((reading.reading.empty() ? "" : reading.reading + "; ") +
                    "if: " + explanation.explanation->words,
                explanation.findings);
        }
    }
    return table;
}

TextTable curve_table(const PaperOutcome& outcome, const LineFigure& figure) {
    TextTable table{"curves-" + outcome.paper->id,
                    figure.title,
                    {"mean over that of " + figure.curves[figure.baseline].title, "the paper",
                     "ours", "why not"},
                    {}};
    const std::vector<CurvePair> pairs = curve_pairs(figure, outcome.evidence);
    const auto text = [](const std::optional<double>& value) {
        return value ? number_text(*value) : std::string("-");
    };
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        table.rows.push_back({figure.curves[i].title, text(pairs[i].published_mean),
                              text(pairs[i].our_mean), pairs[i].why_not});
    }
    return table;
}

TextTable figure_table(const PaperOutcome& outcome, const Table& table) {
    TextTable shown{"figures-" + outcome.paper->id, table.title, {table.rows_are}, {}};
    for (const Table::Column& column : table.columns) {
        const std::string unit = column.unit.empty() ? "" : ", " + column.unit;
        shown.head.push_back(column.title + unit + ": the paper");
        shown.head.push_back("ours");
    }
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        auto& fields = shown.rows.emplace_back();
        fields.push_back(table.rows[row].title);
        for (std::size_t column = 0; column < table.columns.size(); ++column) {
            const TableCell cell = table_cell(table, row, column, outcome.evidence);
            fields.push_back(published_text(cell));
            fields.push_back(our_text(cell));
        }
    }
    return shown;
}

std::vector<std::string> conditions(const PaperOutcome& outcome) {
    std::vector<std::string> lines = {"The paper measured on: " + outcome.paper->hardware};
    if (outcome.quick) {
        lines.emplace_back(
            "Flown with --quick: small pictures, small terrains and few frames. "
            "What it says of the paper is a hint, no more.");
    }
    std::set<std::string> devices, terrains;
    for (const auto& [id, flown] : outcome.evidence.experiments) {
        if (!flown.device.empty()) {
            devices.insert("Flown on: " + flown.device +
                           (flown.software ? " (a software rasteriser)" : ""));
        }
        for (const std::string& terrain : flown.terrains) terrains.insert("Terrain: " + terrain);
    }
    lines.insert(lines.end(), devices.begin(), devices.end());
    lines.insert(lines.end(), terrains.begin(), terrains.end());
    for (const auto& [id, flown] : outcome.evidence.experiments) {
        if (!flown.failure.empty()) {
            lines.push_back(fmt::format("Not flown: {}: {}", id, flown.failure));
        }
        for (const auto& [method, why] : flown.unusable) {
            if (why != flown.failure) lines.push_back(fmt::format("Left out of {}: {}", id, why));
        }
    }
    lines.emplace_back("Times of the paper are compared with ours as ratios alone.");
    return lines;
}

std::string to_markdown(const std::vector<PaperOutcome>& outcomes) {
    std::string text = "# lodbench reproduce\n\n" + overview_markdown(outcomes, "");
    for (const PaperOutcome& outcome : outcomes) text += markdown(outcome);
    return text;
}

Json::Value to_json(const std::vector<PaperOutcome>& outcomes) {
    Json::Value json;
    json["schema_version"] = results::kSchemaVersion;
    json["papers"] = Json::arrayValue;
    for (const PaperOutcome& outcome : outcomes) {
        Json::Value paper;
        paper["paper"] = outcome.paper->id;
        paper["title"] = outcome.paper->title;
        paper["quick"] = outcome.quick;
        paper["conditions"] = results::array_of(conditions(outcome));
        for (const Outcome which : kOutcomes) {
            paper["counts"][name_of(which)] = Json::UInt64(count(outcome, which));
        }
        paper["claims"] = Json::arrayValue;
        for (const Verdict& verdict : outcome.verdicts) paper["claims"].append(to_json(verdict));
        json["papers"].append(paper);
    }
    return json;
}

}  // namespace lodbench::reproduce
