#include "report/html/trend_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "measure/statistics.h"
#include "report/html/page.h"
#include "report/html/text.h"
#include "report/trend_rows.h"

namespace lodbench::report::html {

namespace {

using trend::FigureHistory;
using trend::Trends;

constexpr std::size_t kMostPlots = 60;
constexpr std::size_t kMostDottedRuns = 60;
constexpr std::size_t kMostStepNotes = 6;  ///< below one plot
constexpr std::size_t kCommitLength = 12;
/// Of each series, what is plotted though it does not step.
constexpr const char* kMainFigures[] = {"frame_ms.median", "triangles.mean", "pixel_error_px.p999"};

/// One figure of one setting; a curve for each machine that flew it.
struct Subject {
    std::string figure;
    std::vector<std::size_t> series;  ///< that differ in the machine alone
    std::size_t latest_step = 0;      ///< the newest run with one, from 1; 0: none
};

/// Scenario, flight, method and parameters, then the figure.
using SubjectKey =
    std::pair<std::tuple<std::string, std::string, std::string, std::string>, std::string>;

std::string chance_text(std::optional<double> p_value) {
    if (!p_value) return "-";
    return *p_value < 1e-15 ? "< 1e-15" : fmt::format("{:.1e}", *p_value);
}

class TrendPage {
public:
    TrendPage(const Trends& trends, const std::string& name)
        : trends_(trends), name_(name), rows_(step_rows(trends)) {
        for (const trend::SeriesName& series : trends.history.series) {
            if (!series.machine.empty()) machines_.insert(series.machine);
        }
        for (std::size_t i = 0; i < trends.history.figures.size(); ++i) {
            const FigureHistory& figure = trends.history.figures[i];
            times_[{figure.series, figure.figure}] = i;
        }
    }

    std::string document() {
        add_steps();
        add_plots();
        add_unsteady();
        add_runs();
        page_.heading(2, "How steps are judged", "judgement");
        page_.paragraph(judgement_text(trends_.options));
        return page_.document("Trends of " + name_, lead());
    }

private:
    [[nodiscard]] const trend::SeriesName& series(std::size_t i) const {
        return trends_.history.series[i];
    }
    [[nodiscard]] const trend::RunHead& run(std::size_t i) const { return trends_.history.runs[i]; }
    [[nodiscard]] std::size_t color_of(const std::string& machine) const {
        return std::size_t(std::distance(machines_.begin(), machines_.find(machine)));
    }

    [[nodiscard]] std::string lead() const {
        const auto& runs = trends_.history.runs;
        std::string html = "<dl class=\"conditions\">\n";
        const auto define = [&](const char* term, const std::string& text) {
            html += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", term, escape(text));
        };
        define("Runs", fmt::format("{}", runs.size()));
        if (!runs.empty()) {
            define("From", fmt::format("{}, {}", runs.front().started, commit_text(runs.front())));
            define("To", fmt::format("{}, {}", runs.back().started, commit_text(runs.back())));
        }
        define("Series", fmt::format("{}", trends_.history.series.size()));
        define("Steps", fmt::format("{}", rows_.size()));
        html += "</dl>\n";
        if (machines_.empty()) return html;
        html += "<dl class=\"conditions\">\n";
        for (const std::string& machine : machines_) {
            Series key{machine};
            key.color = color_of(machine);
            html += fmt::format("<div><dt>{} Machine</dt><dd>{}</dd></div>\n", key_html(key),
                                escape(machine));
        }
        return html + "</dl>\n";
    }

    void add_steps() {
        page_.heading(2, "Steps", "steps");
        if (rows_.empty()) {
            page_.paragraph("No series steps.");
            return;
        }
        Table table;
        table.id = "steps";
        table.caption = "Runs from which on a figure is another, newest first";
        table.results = name_;
        table.columns = {{"began", "started", false},
                         {"commit", "commit", false},
                         {"commit before", "previous_commit", false},
                         {"scenario", "scenario", false},
                         {"method", "method", false},
                         {"figure", "figure", false},
                         {"before", "before"},
                         {"after", "after"},
                         {"change", "change"},
                         {"chance", "p_value", true,
                          "p-value of the t-test; none for figures that "
                          "do not vary from flight to flight"}};
        const bool machines = machines_.size() > 1;
        const bool flights = has_several_flights(trends_);
        if (machines) table.columns.push_back({"machine", "machine", false});
        if (flights) table.columns.push_back({"flight", "flight", false});
        const std::size_t shown = std::min(rows_.size(), kMostRows);
        for (std::size_t i = 0; i < shown; ++i) {
            const StepRow& row = rows_[i];
            const trend::SeriesName& name = series(row.series);
            std::vector<Field>& fields = table.rows.emplace_back();
            for (const std::string& text :
                 {run(row.run).started, commit_text(run(row.run)), commit_text(run(row.previous)),
                  name.scenario, trends_.labels[row.series], row.figure, row.before, row.after,
                  row.change, chance_text(row.p_value)}) {
                fields.push_back(text_field(text));
            }
            if (machines) fields.push_back(text_field(name.machine));
            if (flights) fields.push_back(text_field(name.flight));
        }
        page_.raw(to_html(table));
        if (shown < rows_.size()) {
            page_.paragraph(fmt::format("The newest {} of {} steps; trend.json has all of them.",
                                        shown, rows_.size()),
                            "note");
        }
    }

    [[nodiscard]] SubjectKey key_of(std::size_t i, const std::string& figure) const {
        const trend::SeriesName& name = series(i);
        return {{name.scenario, name.flight, name.method, name.params}, figure};
    }

    /// All that can be plotted: what steps, and the main figures.
    [[nodiscard]] std::map<SubjectKey, Subject> subjects() const {
        std::map<SubjectKey, Subject> found;
        const auto add = [&](std::size_t i, const std::string& figure, std::size_t step) {
            Subject& subject = found[key_of(i, figure)];
            subject.figure = figure;
            subject.latest_step = std::max(subject.latest_step, step);
        };
        for (const StepRow& row : rows_) add(row.series, row.figure, row.run + 1);
        for (std::size_t i = 0; i < trends_.history.series.size(); ++i) {
            if (series(i).machine.empty()) continue;
            for (const char* figure : kMainFigures) add(i, figure, 0);
        }
        for (auto& [key, subject] : found) {
            for (std::size_t i = 0; i < trends_.history.series.size(); ++i) {
                if (!series(i).machine.empty() && key_of(i, subject.figure) == key) {
                    subject.series.push_back(i);
                }
            }
        }
        return found;
    }

    void add_plots() {
        std::map<SubjectKey, Subject> all = subjects();
        std::vector<std::pair<std::size_t, SubjectKey>> order;  // the newest steps first
        for (const auto& [key, subject] : all) order.emplace_back(subject.latest_step, key);
        std::ranges::stable_sort(order, std::ranges::greater{},
                                 &std::pair<std::size_t, SubjectKey>::first);
        if (order.size() > kMostPlots) {
            for (std::size_t i = kMostPlots; i < order.size(); ++i) all.erase(order[i].second);
        }
        std::string scenario;
        std::vector<Plot> plots;
        const auto flush = [&] {
            if (!plots.empty()) page_.plots(plots);
            plots.clear();
        };
        for (const auto& [key, subject] : all) {
            const std::string& next = std::get<0>(key.first);
            if (plots.empty() || next != scenario) {
                flush();
                scenario = next;
                page_.heading(2, scenario, "scenario-" + fmt::format("{}", sections_++));
            }
            plots.push_back(plot_of(subject));
        }
        flush();
        if (order.size() > kMostPlots) {
            page_.paragraph(
                fmt::format("Plotted are {} of {} figures, those with the newest steps first.",
                            kMostPlots, order.size()),
                "note");
        }
    }

    Plot plot_of(const Subject& subject) {
        Plot plot;
        plot.id = fmt::format("trend-{}", plot_count_++);
        const std::size_t first = subject.series.front();
        plot.title = fmt::format("{}: {}", trends_.labels[first], subject.figure);
        plot.x_title = "run, in the order in which they began";
        plot.y_title = subject.figure;
        plot.counts = true;
        plot.from_zero = times_.contains({first, subject.figure});
        if (!plot.from_zero) plot.notes.emplace_back("The axis spans the values alone.");
        if (has_several_flights(trends_)) plot.notes.push_back(series(first).flight);
        add_step_notes(plot, subject);
        for (const std::size_t i : subject.series) add_curves(plot, i, subject.figure);
        return plot;
    }

    /// The figures before and after, newest step first.
    void add_step_notes(Plot& plot, const Subject& subject) const {
        std::size_t steps = 0;
        for (const StepRow& row : rows_) {
            if (row.figure != subject.figure ||
                std::ranges::find(subject.series, row.series) == subject.series.end() ||
                ++steps > kMostStepNotes) {
                continue;
            }
            plot.notes.push_back(fmt::format("{}: {} → {}{}", commit_text(run(row.run)), row.before,
                                             row.after,
                                             row.change.empty() ? "" : ", " + row.change));
        }
        if (steps > kMostStepNotes) {
            plot.notes.push_back(fmt::format("and {} earlier steps", steps - kMostStepNotes));
        }
    }

    void add_curves(Plot& plot, std::size_t i, const std::string& figure) {
        const auto time = times_.find({i, figure});
        const FigureHistory history = time != times_.end() ? trends_.history.figures[time->second]
                                                           : trends_.facts_of(i, figure);
        if (history.runs.empty()) return;
        Series curve{series(i).machine};
        curve.color = color_of(series(i).machine);
        curve.dots = history.runs.size() <= kMostDottedRuns;
        for (std::size_t k = 0; k < history.runs.size(); ++k) {
            curve.marks.push_back(mark_of(history, k));
        }
        curve.marks = thinned(curve.marks, kMostCurvePoints);
        const std::vector<std::size_t> places =
            time != times_.end() ? step_places(time->second) : change_places(i, history);
        Series steps = steps_of(history, places);
        steps.color = curve.color;
        const std::vector<std::size_t> levels =
            time != times_.end() && !places.empty() ? places : std::vector<std::size_t>{};
        plot.series.push_back(std::move(curve));
        if (!levels.empty()) plot.series.push_back(levels_of(history, levels));
        if (!steps.marks.empty()) plot.series.push_back(std::move(steps));
    }

    [[nodiscard]] Mark mark_of(const FigureHistory& history, std::size_t k) const {
        const trend::RunHead& head = run(history.runs[k]);
        Mark mark{double(history.runs[k] + 1), history.values[k]};
        mark.label = fmt::format("{}, {}", commit_text(head), head.started);
        return mark;
    }

    [[nodiscard]] std::vector<std::size_t> step_places(std::size_t figure) const {
        std::vector<std::size_t> places;
        for (const trend::Step& step : trends_.figures[figure].steps) places.push_back(step.place);
        return places;
    }

    [[nodiscard]] std::vector<std::size_t> change_places(std::size_t i,
                                                         const FigureHistory& history) const {
        std::vector<std::size_t> places;
        for (const trend::Change& change : trends_.changes) {
            if (change.series != i || change.field != history.figure) continue;
            const auto place = std::ranges::lower_bound(history.runs, change.run);
            if (place != history.runs.end() && *place == change.run) {
                places.push_back(std::size_t(place - history.runs.begin()));
            }
        }
        return places;
    }

    /// A ring and the commit at the first run after each.
    [[nodiscard]] Series steps_of(const FigureHistory& history,
                                  const std::vector<std::size_t>& places) const {
        Series steps{"steps"};
        steps.joined = false;
        for (const std::size_t place : places) {
            Mark mark = mark_of(history, place);
            mark.value = commit_text(run(history.runs[place])).substr(0, kCommitLength);
            mark.ringed = true;
            steps.marks.push_back(std::move(mark));
        }
        return steps;
    }

    /// The medians between steps.
    static Series levels_of(const FigureHistory& history, std::vector<std::size_t> places) {
        Series levels{"median between steps"};
        levels.ink = true;
        levels.dots = false;
        places.insert(places.begin(), 0);
        places.push_back(history.runs.size());
        for (std::size_t k = 0; k + 1 < places.size(); ++k) {
            const std::span<const double> values(history.values);
            const auto level =
                measure::median(values.subspan(places[k], places[k + 1] - places[k]));
            if (!level) continue;
            levels.marks.push_back({double(history.runs[places[k]] + 1), *level});
            levels.marks.push_back({double(history.runs[places[k + 1] - 1] + 1), *level});
        }
        return levels;
    }

    void add_unsteady() {
        if (trends_.unsteady.empty()) return;
        page_.heading(2, "Unsteady figures", "unsteady");
        page_.paragraph(
            "These should be the same in each run of one build, and change too often to tell each "
            "time: their methods do not draw the same twice, or each commit changes them.");
        std::vector<std::string> texts;
        for (const trend::Unsteady& unsteady : trends_.unsteady) {
            if (texts.size() == kMostRows) break;
            texts.push_back(fmt::format(
                "{}, {}: {} changed {} times in {} runs", trends_.labels[unsteady.series],
                series(unsteady.series).scenario, unsteady.field, unsteady.changes, unsteady.runs));
        }
        page_.list(texts);
    }

    void add_runs() {
        const auto& runs = trends_.history.runs;
        page_.heading(2, "Runs", "runs");
        Table table;
        table.id = "runs";
        table.caption = "Runs, newest first";
        table.results = name_;
        table.columns = {{"number", "number"},        {"began", "started", false},
                         {"commit", "commit", false}, {"lodbench", "tool_version", false},
                         {"folder", "folder", false}, {"run", "run", false},
                         {"cells that are ok", "ok"}, {"cells", "cells"}};
        const std::size_t shown = std::min(runs.size(), kMostRows);
        for (std::size_t k = 0; k < shown; ++k) {
            const std::size_t i = runs.size() - 1 - k;
            table.rows.push_back({number_field(double(i + 1), 0), text_field(runs[i].started),
                                  text_field(commit_text(runs[i])),
                                  text_field(runs[i].tool_version), text_field(runs[i].folder),
                                  text_field(runs[i].id), number_field(double(runs[i].ok), 0),
                                  number_field(double(runs[i].cells), 0)});
        }
        page_.raw(to_html(table));
        if (shown < runs.size()) {
            page_.paragraph(fmt::format("The newest {} of {} runs; trend.json has all of them.",
                                        shown, runs.size()),
                            "note");
        }
    }

    const Trends& trends_;
    const std::string& name_;
    const std::vector<StepRow> rows_;
    std::set<std::string> machines_;
    std::map<std::pair<std::size_t, std::string>, std::size_t> times_;  // places in the history
    Page page_;
    std::size_t plot_count_ = 0, sections_ = 0;
};

}  // namespace

std::string trend_page(const Trends& trends, const std::string& name) {
    return TrendPage(trends, name).document();
}

}  // namespace lodbench::report::html
