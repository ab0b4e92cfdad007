#include "reproduce/judge.h"

#include <fmt/format.h>

#include <algorithm>

namespace lodbench::reproduce {

namespace {

constexpr std::pair<Outcome, const char*> kNames[] = {
    {Outcome::holds, "holds"},
    {Outcome::fails, "does not hold"},
    {Outcome::undecided, "not decided"},
    {Outcome::unjudged, "cannot be judged here"},
    {Outcome::depends, "depends on the reading"},
};

Outcome outcome_of(Answer answer) {
    switch (answer) {
        case Answer::yes: return Outcome::holds;
        case Answer::no: return Outcome::fails;
        case Answer::undecided: break;
    }
    return Outcome::undecided;
}

/// Of findings that are all to hold.
Outcome all_of(const std::vector<Finding>& findings) {
    for (const Outcome outcome : {Outcome::fails, Outcome::unjudged, Outcome::undecided}) {
        if (std::ranges::find(findings, outcome, &Finding::outcome) != findings.end()) {
            return outcome;
        }
    }
    return findings.empty() ? Outcome::unjudged : Outcome::holds;
}

Outcome of_readings(const std::vector<ReadingVerdict>& readings) {
    const Outcome first = readings.front().outcome;
    const bool same = std::ranges::all_of(
        readings, [&](const ReadingVerdict& reading) { return reading.outcome == first; });
    return same ? first : Outcome::depends;
}

/// Measured / measured; why not, where one of both says so.
Measured ratio_of(const Measured& a, const Measured& b) {
    Measured result;
    result.why_not = a.why_not.empty() ? b.why_not : a.why_not;
    if (!a.value || !b.value) return result;
    result.value = ratio(*a.value, *b.value);
    if (!result.value) {
        result.why_not = fmt::format("{} over {} is no ratio", a.value->text(), b.value->text());
    }
    return result;
}

/// One claim under one reading.
class Judge {
public:
    Judge(const Paper& paper, const Evidence& evidence, const Claim& claim, const Reading& reading)
        : paper_(paper),
          evidence_(evidence),
          context_(reading.selection.completed_by(claim.selection)) {}

    std::vector<Finding> findings(const Test& test) const {
        using Kind = Test::Kind;
        std::vector<Finding> found;
        if (test.kind == Kind::published) return of_published(test);
        if (test.kind == Kind::published_rank) return {of_published_rank(test)};
        const std::vector<Selection> once(1);
        for (const Selection& each : test.for_each.empty() ? once : test.for_each) {
            switch (test.kind) {
                case Kind::bound:
                case Kind::ratio: found.push_back(of_figure(test, each)); break;
                case Kind::constant: found.push_back(of_constant(test, each)); break;
                case Kind::rises:
                case Kind::falls: add_steps(test, each, found); break;
                case Kind::rank: found.push_back(of_rank(test, each)); break;
                case Kind::published:
                case Kind::published_rank: break;  // above
            }
        }
        return found;
    }

private:
    [[nodiscard]] Measured measure(const Quantity& quantity, const Selection& each,
                                   const Test& test) const {
        const Selection whole = quantity.selection.completed_by(each).completed_by(context_);
        return evidence_.measure(quantity.figure, whole, test.where);
    }

    /// `of`, or `of` over `to` where a predicate about one figure has both.
    [[nodiscard]] Measured measure_of(const Test& test, const Selection& each) const {
        const Measured of = measure(*test.of, each, test);
        return test.to ? ratio_of(of, measure(*test.to, each, test)) : of;
    }
    static std::string words_of(const Test& test) {
        return test.to ? fmt::format("{} over {}", words_of(*test.of), words_of(*test.to))
                       : words_of(*test.of);
    }

    /// "popping: grid=600"; without words of its own what `otherwise` says.
    [[nodiscard]] static std::string name_of_finding(const Test& test, const Selection& each,
                                                     const std::string& otherwise) {
        const std::string name = test.words.empty() ? otherwise : test.words;
        const std::string of = each.experiment.empty() ? each.words()
                               : each.words().empty()  ? each.experiment
                                                       : each.experiment + ", " + each.words();
        return of.empty() ? name : name + ": " + of;
    }

    static std::string words_of(const Quantity& quantity) {
        const std::string of = quantity.selection.words();
        return of.empty() ? quantity.figure.text : fmt::format("{} ({})", quantity.figure.text, of);
    }

    static Finding decide(std::string what, const Measured& measured, const Range& range) {
        Finding finding{std::move(what), measured.value, range.text(), Outcome::unjudged,
                        measured.why_not};
        if (!measured.value) return finding;
        finding.outcome = measured.why_not.empty() ? outcome_of(range.holds(*measured.value))
                                                   : Outcome::undecided;
        return finding;
    }

    [[nodiscard]] Finding of_figure(const Test& test, const Selection& each) const {
        return decide(name_of_finding(test, each, words_of(test)), measure_of(test, each),
                      test.range);
    }

    /// What `measure_at` gives over `over`; nothing, and the first reason why, where one is absent.
    template <typename MeasureAt>
    static std::vector<Interval> along(const Test& test, const Selection& each, Measured& whole,
                                       const MeasureAt& measure_at) {
        std::vector<Interval> values;
        for (const Selection& place : test.over) {
            const Measured measured = measure_at(place.completed_by(each));
            if (whole.why_not.empty()) whole.why_not = measured.why_not;
            if (!measured.value) return {};
            values.push_back(*measured.value);
        }
        return values;
    }

    [[nodiscard]] Finding of_constant(const Test& test, const Selection& each) const {
        Measured whole;
        const std::vector<Interval> values =
            along(test, each, whole, [&](const Selection& at) { return measure_of(test, at); });
        if (!values.empty()) {
            whole.value = spread(values);
            if (!whole.value && whole.why_not.empty()) whole.why_not = "not all are above 0";
        }
        Range range;
        range.most = test.within;
        return decide(name_of_finding(test, each, "greatest over least of " + words_of(test)),
                      whole, range);
    }

    void add_steps(const Test& test, const Selection& each, std::vector<Finding>& found) const {
        const bool falling = test.kind == Test::Kind::falls;
        const std::string name = fmt::format("{} {}", words_of(test), falling ? "falls" : "rises");
        for (std::size_t i = 1; i < test.over.size(); ++i) {
            const Selection before = test.over[i - 1].completed_by(each);
            const Selection after = test.over[i].completed_by(each);
            const Measured a = measure_of(test, before), b = measure_of(test, after);
            Finding finding;
            finding.what = fmt::format("{} from {} to {}", name_of_finding(test, {}, name),
                                       step_text(before), step_text(after));
            finding.value = b.value;
            finding.reason = a.why_not.empty() ? b.why_not : a.why_not;
            if (a.value && b.value) {
                finding.expected = fmt::format("{}{} {}", falling ? "<" : ">",
                                               test.strictly ? "" : "=", a.value->text());
                finding.outcome =
                    finding.reason.empty()
                        ? outcome_of(rises(*a.value, *b.value, falling, test.strictly))
                        : Outcome::undecided;
            }
            found.push_back(std::move(finding));
        }
    }

    static std::string step_text(const Selection& selection) {
        const std::string words = selection.words();
        return words.empty() ? selection.experiment : words;
    }

    [[nodiscard]] Finding of_rank(const Test& test, const Selection& each) const {
        Measured whole;
        const auto values = [&](const Quantity& quantity) {
            return along(test, each, whole,
                         [&](const Selection& at) { return measure(quantity, at, test); });
        };
        const std::vector<Interval> of = values(*test.of), to = values(*test.to);
        if (!of.empty() && !to.empty()) whole.value = correlate(of, to, whole);
        const std::string name =
            fmt::format("rank correlation of {} with {}", words_of(*test.of), words_of(*test.to));
        return decide(name_of_finding(test, each, name), whole, test.range);
    }

    static std::optional<Interval> correlate(const std::vector<Interval>& of,
                                             const std::vector<Interval>& to, Measured& whole) {
        const auto correlation = rank_correlation(of, to);
        if (!correlation && whole.why_not.empty()) {
            whole.why_not = "fewer than three pairs, or one of both does not vary";
        }
        return correlation;
    }

    [[nodiscard]] std::vector<Finding> of_published(const Test& test) const {
        const Table& table = *paper_.table(test.table);
        Range range;
        range.least = 1 / test.within;
        range.most = test.within;
        std::vector<Finding> found;
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            for (std::size_t column = 0; column < table.columns.size(); ++column) {
                const auto baseline = table.baseline_of(row, column);
                if (baseline == std::pair(row, column)) continue;
                const TableCell cell = table_cell(table, row, column, evidence_, context_);
                const auto theirs = baseline ? cell.published_ratio : cell.published;
                if (!theirs) continue;
                const Measured ours = baseline ? cell.ours_ratio : cell.ours;
                Measured quotient = ratio_of(ours, {Interval::exactly(*theirs), {}});
                std::string what = fmt::format("ours over the paper's: {}, {}: {} and {:.4g}",
                                               table.rows[row].title, table.columns[column].title,
                                               ours.value ? ours.value->text() : "-", *theirs);
                found.push_back(decide(std::move(what), quotient, range));
            }
        }
        return found;
    }

    [[nodiscard]] Finding of_published_rank(const Test& test) const {
        const Table& table = *paper_.table(test.table);
        std::vector<Interval> ours, theirs;
        Measured whole;
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            for (std::size_t column = 0; column < table.columns.size(); ++column) {
                const TableCell cell = table_cell(table, row, column, evidence_, context_);
                if (!cell.published) continue;
                if (whole.why_not.empty()) whole.why_not = cell.ours.why_not;
                if (!cell.ours.value) continue;
                ours.push_back(*cell.ours.value);
                theirs.push_back(Interval::exactly(*cell.published));
            }
        }
        const auto printed = [](const Table::Row& row) {
            return std::ranges::count_if(row.values, [](const auto& value) { return bool(value); });
        };
        std::ptrdiff_t all = 0;
        for (const Table::Row& row : table.rows) all += printed(row);
        if (std::ptrdiff_t(ours.size()) == all) whole.value = correlate(ours, theirs, whole);
        return decide(name_of_finding(test, {}, "rank correlation with the paper's figures"), whole,
                      test.range);
    }

    const Paper& paper_;
    const Evidence& evidence_;
    const Selection context_;
};

/// Why no figure has to be asked for.
std::string reason_without_figures(const Claim& claim, const Evidence& evidence,
                                   const Setting& setting) {
    if (!claim.unjudged.empty()) return claim.unjudged;
    if (claim.needs_terrain && !setting.own_terrain) {
        return "it is about the paper's own terrain: give it with --terrain FILE";
    }
    if (claim.needs_gpu && evidence.any_in_software()) {
        return "it is about times of a GPU, and a software rasteriser flew this";
    }
    return {};
}

}  // namespace

const char* name_of(Outcome outcome) {
    return std::ranges::find(kNames, outcome, &std::pair<Outcome, const char*>::first)->second;
}

std::vector<Verdict> judge(const Paper& paper, const Evidence& evidence, const Setting& setting) {
    std::vector<Verdict> verdicts;
    for (const Claim& claim : paper.claims) {
        Verdict& verdict = verdicts.emplace_back();
        verdict.claim = &claim;
        verdict.reason = reason_without_figures(claim, evidence, setting);
        if (!verdict.reason.empty()) continue;
        for (const Reading& reading : claim.readings) {
            ReadingVerdict& judged = verdict.readings.emplace_back();
            judged.reading = reading.name;
            const Judge judge(paper, evidence, claim, reading);
            for (const Test& test : claim.tests) {
                const std::vector<Finding> found = judge.findings(test);
                judged.findings.insert(judged.findings.end(), found.begin(), found.end());
            }
            judged.outcome = all_of(judged.findings);
        }
        verdict.outcome = of_readings(verdict.readings);
    }
    return verdicts;
}

TableCell table_cell(const Table& table, std::size_t row, std::size_t column,
                     const Evidence& evidence, const Selection& reading) {
    const auto measure = [&](std::size_t r, std::size_t c) {
        const Selection selection = table.rows[r]
                                        .selection.completed_by(table.columns[c].selection)
                                        .completed_by(reading)
                                        .completed_by(table.selection);
        return evidence.measure(table.columns[c].figure, selection, table.where);
    };
    TableCell cell;
    cell.is_time = table.columns[column].figure.is_time();
    cell.published = table.rows[row].values[column];
    cell.ours = measure(row, column);
    const auto baseline = table.baseline_of(row, column);
    if (!baseline) return cell;
    const auto base = table.rows[baseline->first].values[baseline->second];
    if (cell.published && base && *base != 0) cell.published_ratio = *cell.published / *base;
    cell.ours_ratio = *baseline == std::pair(row, column)
                          ? Measured{Interval::exactly(1), {}}
                          : ratio_of(cell.ours, measure(baseline->first, baseline->second));
    return cell;
}

}  // namespace lodbench::reproduce
