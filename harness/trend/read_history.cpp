#include "trend/read_history.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "measure/statistics.h"
#include "trend/sqlite.h"

namespace lodbench::trend {

namespace {

/// From the numbers of rows to indices.
using Places = std::unordered_map<std::int64_t, std::size_t>;

class Reading {
public:
    explicit Reading(const Connection& connection) : connection_(connection) {}

    History read() {
        read_runs();
        read_series();
        read_figures();
        read_texts();
        read_cells();
        read_values();
        std::ranges::for_each(history_.facts,
                              [](FactsHistory& facts) { sort(facts.runs, facts.texts); });
        std::ranges::for_each(history_.figures,
                              [](FigureHistory& figure) { sort(figure.runs, figure.values); });
        std::ranges::sort(history_.facts, {}, &FactsHistory::series);
        std::ranges::sort(history_.figures, {}, [](const FigureHistory& figure) {
            return std::tie(figure.series, figure.figure);
        });
        return std::move(history_);
    }

private:
    /// Rows come in the order in which runs were added; wanted is that in which they began.
    template <typename Value>
    static void sort(std::vector<std::size_t>& runs, std::vector<Value>& values) {
        if (std::ranges::is_sorted(runs)) return;
        std::vector<std::size_t> order(runs.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::sort(order, {}, [&](std::size_t i) { return runs[i]; });
        std::vector<std::size_t> sorted_runs;
        std::vector<Value> sorted_values;
        for (const std::size_t i : order) {
            sorted_runs.push_back(runs[i]);
            sorted_values.push_back(std::move(values[i]));
        }
        runs = std::move(sorted_runs);
        values = std::move(sorted_values);
    }

    [[nodiscard]] std::size_t place(const Places& places, std::int64_t row,
                                    const char* what) const {
        const auto found = places.find(row);
        if (found == places.end()) connection_.damaged(what);
        return found->second;
    }

    void read_runs() {
        Statement select(connection_,
                         "SELECT id, run_id, started, commit_id, tool_version, folder FROM run "
                         "ORDER BY started, run_id");
        while (select.step()) {
            runs_[select.integer(0)] = history_.runs.size();
            history_.runs.push_back({select.text(1), select.text(2), select.text(3), select.text(4),
                                     select.text(5), 0, 0});
        }
    }

    void read_series() {
        Statement select(connection_,
                         "SELECT id, scenario, flight, method, params, machine FROM series "
                         "ORDER BY scenario, flight, method, params, machine");
        while (select.step()) {
            series_[select.integer(0)] = history_.series.size();
            history_.series.push_back(
                {select.text(1), select.text(2), select.text(3), select.text(4), select.text(5)});
        }
    }

    void read_figures() {
        Statement select(connection_, "SELECT id, name FROM figure");
        while (select.step()) {
            figures_[select.integer(0)] = names_.size();
            names_.push_back(select.text(1));
        }
    }

    void read_texts() {
        Statement select(connection_, "SELECT id, text FROM facts");
        while (select.step()) {
            texts_[select.integer(0)] = history_.texts.size();
            history_.texts.push_back(select.text(1));
        }
    }

    void read_cells() {
        Statement select(connection_,
                         "SELECT series, run, status, facts FROM cell ORDER BY series, run, "
                         "repetition");
        while (select.step()) {
            const std::size_t series = place(series_, select.integer(0), "a cell of no series");
            const std::size_t run = place(runs_, select.integer(1), "a cell of no run");
            const bool ok = select.text(2) == "ok";
            ++history_.runs[run].cells;
            history_.runs[run].ok += ok ? 1 : 0;
            if (!ok || select.is_null(3)) continue;
            const std::size_t text = place(texts_, select.integer(3), "facts that are not there");
            if (history_.facts.empty() || history_.facts.back().series != series) {
                history_.facts.push_back({series, {}, {}});
            }
            FactsHistory& facts = history_.facts.back();
            if (facts.runs.empty() || facts.runs.back() != run) {
                facts.runs.push_back(run);
                facts.texts.emplace_back();
            }
            facts.texts.back().push_back(text);
        }
    }

    void read_values() {
        Statement select(connection_,
                         "SELECT series, figure, run, value FROM value ORDER BY series, figure, "
                         "run, repetition");
        std::int64_t series = -1;
        std::int64_t figure = -1;
        std::int64_t run = -1;
        std::vector<double> repetitions;
        const auto end_run = [&] {
            if (repetitions.empty()) return;
            history_.figures.back().runs.push_back(place(runs_, run, "a value of no run"));
            history_.figures.back().values.push_back(*measure::median(repetitions));
            repetitions.clear();
        };
        while (select.step()) {
            const std::int64_t next_series = select.integer(0);
            const std::int64_t next_figure = select.integer(1);
            const bool next = next_series != series || next_figure != figure;
            if (next || select.integer(2) != run) end_run();
            if (next) {
                history_.figures.push_back(
                    {place(series_, next_series, "a value of no series"),
                     names_[place(figures_, next_figure, "a value of no figure")],
                     {},
                     {}});
            }
            std::tie(series, figure, run) = std::tuple(next_series, next_figure, select.integer(2));
            const double value = select.real(3);
            if (!std::isfinite(value)) connection_.damaged("a value that is not finite");
            repetitions.push_back(value);
        }
        end_run();
    }

    const Connection& connection_;
    History history_;
    Places runs_, series_, figures_, texts_;
    std::vector<std::string> names_;
};

}  // namespace

History read_history(const Connection& connection) {
    return Reading(connection).read();
}

}  // namespace lodbench::trend
