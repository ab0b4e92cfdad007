#include "reproduce/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/error.h"

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
    result.cells = a.cells;
    result.cells.insert(b.cells.begin(), b.cells.end());
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
    Judge(const Paper& paper, const Evidence& evidence, const Selection& selection,
          const Reading& reading)
        : paper_(paper), evidence_(evidence), context_(reading.selection.completed_by(selection)) {}

    std::vector<Finding> findings(const std::vector<Test>& tests) const {
        std::vector<Finding> all;
        for (const Test& test : tests) {
            const std::vector<Finding> found = findings(test);
            all.insert(all.end(), found.begin(), found.end());
        }
        return all;
    }

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
        Finding finding{std::move(what),   measured.value,   range.text(),
                        Outcome::unjudged, measured.why_not, measured.cells};
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
        bool missing = false;
        for (const Selection& place : test.over) {
            const Measured measured = measure_at(place.completed_by(each));
            if (whole.why_not.empty()) whole.why_not = measured.why_not;
            whole.cells.insert(measured.cells.begin(), measured.cells.end());
            if (!measured.value) missing = true;
            if (!missing) values.push_back(*measured.value);
        }
        return missing ? std::vector<Interval>() : values;
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
            finding.cells = a.cells;
            finding.cells.insert(b.cells.begin(), b.cells.end());
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
                whole.cells.insert(cell.ours.cells.begin(), cell.ours.cells.end());
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

std::set<std::string> cells_of(const std::vector<Finding>& findings) {
    std::set<std::string> cells;
    for (const Finding& finding : findings) {
        cells.insert(finding.cells.begin(), finding.cells.end());
    }
    return cells;
}

std::vector<ExplanationVerdict> explain(const Paper& paper, const Evidence& evidence,
                                        const Claim& claim, const Reading& reading,
                                        const std::vector<Finding>& findings) {
    const std::set<std::string> own = cells_of(findings);
    std::vector<ExplanationVerdict> verdicts;
    for (const Explanation& explanation : claim.explanations) {
        ExplanationVerdict& verdict = verdicts.emplace_back();
        verdict.explanation = &explanation;
        verdict.findings =
            Judge(paper, evidence, explanation.selection.value_or(claim.selection), reading)
                .findings(explanation.tests);
        verdict.outcome = all_of(verdict.findings);
        const std::set<std::string> asked = cells_of(verdict.findings);
        if (!asked.empty() && std::ranges::includes(own, asked)) {
            throw InputError(
                fmt::format("{}: this explanation asks only for what the claim itself flies; ask "
                            "for flights with one thing changed",
                            explanation.where));
        }
    }
    return verdicts;
}

/// Over the flight, by the trapezoid rule.
std::optional<double> mean_of(const CurvePair::Points& points) {
    if (points.empty()) return std::nullopt;
    if (points.size() == 1 || points.front().first == points.back().first) {
        return points.front().second;
    }
    double area = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        area +=
            (points[i].first - points[i - 1].first) * (points[i].second + points[i - 1].second) / 2;
    }
    return area / (points.back().first - points.front().first);
}

/// Ours of one curve: points along the flight, and their mean; of a rate that of the mean time.
void add_ours(const LineFigure& figure, const MeasuredCurve& curve, CurvePair& pair) {
    pair.why_not = curve.why_not;
    double sum = 0;
    for (std::size_t i = 0; i < curve.values.size(); ++i) {
        const double value = curve.values[i];
        if (std::isnan(value) || (figure.of_rate() && value <= 0)) continue;
        const double at = curve.values.size() < 2 ? 0 : double(i) / double(curve.values.size() - 1);
        pair.ours.emplace_back(at, figure.of_rate() ? 1000 / value : value);
        sum += value;
    }
    if (pair.ours.empty()) return;
    const double mean = sum / double(pair.ours.size());
    pair.our_mean = figure.of_rate() ? 1000 / mean : mean;
}

void divide(CurvePair::Points& points, std::optional<double>& mean, std::optional<double> by) {
    if (!by || *by == 0) {
        points.clear();
        mean.reset();
        return;
    }
    for (auto& [at, value] : points) value /= *by;
    if (mean) *mean /= *by;
}

}  // namespace

const char* name_of(Outcome outcome) {
    return std::ranges::find(kNames, outcome, &std::pair<Outcome, const char*>::first)->second;
}

bool ReadingVerdict::explained() const {
    return std::ranges::find(explanations, Outcome::holds, &ExplanationVerdict::outcome) !=
           explanations.end();
}

bool Verdict::explained() const {
    return outcome == Outcome::fails && std::ranges::all_of(readings, &ReadingVerdict::explained);
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
            judged.findings =
                Judge(paper, evidence, claim.selection, reading).findings(claim.tests);
            judged.outcome = all_of(judged.findings);
            if (judged.outcome == Outcome::fails) {
                judged.explanations = explain(paper, evidence, claim, reading, judged.findings);
            }
        }
        verdict.outcome = of_readings(verdict.readings);
    }
    return verdicts;
}

void check_selections(const Paper& paper, const Evidence& planned) {
    for (const Claim& claim : paper.claims) {
        for (const Reading& reading : claim.readings) {
            const auto findings =
                Judge(paper, planned, claim.selection, reading).findings(claim.tests);
            (void)explain(paper, planned, claim, reading, findings);
        }
    }
    for (const Table& table : paper.tables) {
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            for (std::size_t column = 0; column < table.columns.size(); ++column) {
                (void)table_cell(table, row, column, planned);
            }
        }
    }
    for (const LineFigure& figure : paper.figures) (void)curve_pairs(figure, planned);
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

std::vector<CurvePair> curve_pairs(const LineFigure& figure, const Evidence& evidence) {
    std::vector<CurvePair> pairs;
    for (const LineFigure::Curve& curve : figure.curves) {
        CurvePair& pair = pairs.emplace_back();
        pair.published = curve.points;
        pair.published_mean = mean_of(curve.points);
        const Selection selection = curve.selection.completed_by(figure.selection);
        const std::string column = figure.of_rate() ? "wall_ms" : figure.column;
        add_ours(figure, evidence.curve(column, selection, figure.where), pair);
    }
    const auto published = pairs[figure.baseline].published_mean;
    const auto ours = pairs[figure.baseline].our_mean;
    for (CurvePair& pair : pairs) {
        divide(pair.published, pair.published_mean, published);
        divide(pair.ours, pair.our_mean, ours);
    }
    return pairs;
}

}  // namespace lodbench::reproduce
