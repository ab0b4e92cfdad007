#include "compare/times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "measure/statistics.h"
#include "results/cell_groups.h"
#include "results/json.h"

namespace lodbench::compare {

using results::CellRecord;
using Cells = std::vector<const CellRecord*>;

namespace {

using namespace results::figures;

/// What is judged. CPU time beside wall time: other programs that take the processor disturb it
/// less, so that it tells a slow-down apart where wall time cannot.
struct JudgedTime {
    results::CellFigure figure;
    double resolution;  ///< a smaller change in the figure's unit is none
};
constexpr JudgedTime kJudged[] = {
    {of<&Cell::frame_ms, &TimeSummary::median>, 1e-3},
    {of<&Cell::cpu_ms, &TimeSummary::median>, 1e-3},
    {of<&Cell::prepare_s>, 1e-3},
};

constexpr double kConfidence = 0.95;
constexpr double kNormal95 = 1.96, kNormal99 = 2.576;
/// Where code and data come to lie in memory moves times by a per cent between builds of one
/// source, which no repetition averages out (Mytkowicz et al., Producing wrong data without doing
/// anything obviously wrong, 2009).
constexpr double kLeastFloor = 0.01;

double share(double ratio) {
    return std::max(ratio, 1 / ratio) - 1;
}

/// Of deviations from the sample's median, on logarithms: 1.4826 · median |deviation|.
double spread_of(const std::vector<double>& base, const std::vector<double>& now) {
    std::vector<double> deviations;
    for (const std::vector<double>* side : {&base, &now}) {
        const double centre = *measure::median(*side);
        for (const double value : *side) deviations.push_back(std::abs(std::log(value / centre)));
    }
    return 1.4826 * *measure::median(deviations);
}

/// What chance alone moves the ratio by, in 99 of 100 comparisons: Hodges and Lehmann's estimate
/// has a standard error of sqrt(pi / 3) of a normal sample's mean.
double floor_from_spread(const std::vector<double>& base, const std::vector<double>& now) {
    const double error = spread_of(base, now) * std::sqrt(1.0472) *
                         std::sqrt(1.0 / double(base.size()) + 1.0 / double(now.size()));
    return std::exp(kNormal99 * error) - 1;
}

bool all_positive(const std::vector<double>& values) {
    return std::ranges::all_of(values, [](double value) { return value > 0; });
}

/// Of A/A runs: what each says of the setting on this device, one sample a folder; one folder is
/// split into its first and its second half.
std::vector<std::vector<double>> noise_samples(const CellRecord& like,
                                               const std::vector<results::ResultFolder>& noise,
                                               const results::CellFigure& figure) {
    std::vector<std::vector<double>> samples;
    for (const results::ResultFolder& folder : noise) {
        Cells cells;
        for (const CellRecord& cell : folder.cells) {
            if (cell.status == results::CellStatus::ok && cell.scenario == like.scenario &&
                cell.method == like.method && cell.device == like.device &&
                cell.params.values() == like.params.values()) {
                cells.push_back(&cell);
            }
        }
        std::ranges::stable_sort(cells, {}, &CellRecord::repetition);
        std::vector<double> values = results::numbers_of(cells, figure);
        if (!values.empty() && all_positive(values)) samples.push_back(std::move(values));
    }
    if (samples.size() == 1 && samples.front().size() >= 2) {
        const auto middle = samples.front().begin() + std::ptrdiff_t(samples.front().size() / 2);
        std::vector<double> later(middle, samples.front().end());
        samples.front().erase(middle, samples.front().end());
        samples.push_back(std::move(later));
    }
    return samples;
}

/// The greatest change between two samples of one build; nothing where there are not two.
std::optional<double> floor_from_noise(const std::vector<std::vector<double>>& samples) {
    std::optional<double> floor;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        for (std::size_t j = i + 1; j < samples.size(); ++j) {
            const auto interval = measure::ratio_interval(samples[i], samples[j], kConfidence);
            floor = std::max(floor.value_or(0), share(interval->ratio));
        }
    }
    return floor;
}

/// Whether the cells of two runs were flown by turns: in the order of time the run changes as often
/// as a shuffled order does.
bool flown_in_turn(const Cells& base, const Cells& now) {
    std::vector<std::pair<std::string, bool>> flown;
    for (const CellRecord* cell : base) flown.emplace_back(cell->began, false);
    for (const CellRecord* cell : now) flown.emplace_back(cell->began, true);
    if (std::ranges::any_of(flown, [](const auto& one) { return one.first.empty(); })) return false;
    std::ranges::sort(flown);
    std::size_t changes = 0;
    for (std::size_t i = 1; i < flown.size(); ++i) {
        changes += flown[i].second != flown[i - 1].second ? 1 : 0;
    }
    return changes >= std::min(base.size(), now.size());
}

Cells on_device(const Cells& cells, const std::string& device) {
    Cells chosen;
    for (const CellRecord* cell : cells) {
        if (cell->device == device) chosen.push_back(cell);
    }
    return chosen;
}

std::set<std::string> devices_of(const Cells& cells) {
    std::set<std::string> devices;
    for (const CellRecord* cell : cells) {
        if (!cell->device.empty()) devices.insert(cell->device);
    }
    return devices;
}

/// Of one file and with the same figures of its own, in all repetitions.
bool same_plugin_and_counters(const Cells& base, const Cells& now) {
    const CellRecord& first = *base.front();
    const auto same = [&first](const CellRecord* cell) {
        return !cell->plugin_checksum.empty() && cell->plugin_checksum == first.plugin_checksum &&
               cell->counters == first.counters;
    };
    return std::ranges::all_of(base, same) && std::ranges::all_of(now, same);
}

std::optional<TimeComparison> time_of(const JudgedTime& judged, const Cells& base, const Cells& now,
                                      const std::vector<results::ResultFolder>& noise) {
    const std::vector<double> before = results::numbers_of(base, judged.figure);
    const std::vector<double> after = results::numbers_of(now, judged.figure);
    const auto interval = measure::ratio_interval(before, after, kConfidence);
    if (!interval) return std::nullopt;
    TimeComparison time;
    time.figure = judged.figure.name();
    time.base_runs = before.size();
    time.new_runs = after.size();
    time.base = *measure::median(before);
    time.now = *measure::median(after);
    time.ratio = *interval;
    time.p = measure::rank_test(before, after).p;
    const auto measured = floor_from_noise(noise_samples(*base.front(), noise, judged.figure));
    time.measured_floor = measured.has_value();
    time.floor = std::max({measured.value_or(floor_from_spread(before, after)), kLeastFloor,
                           judged.resolution / time.base});
    time.in_turn = flown_in_turn(base, now);
    return time;
}

/// z of a two-sided p.
double normal_quantile(double p) {
    double low = 0, high = 40;
    for (int i = 0; i < 200; ++i) {
        const double middle = (low + high) / 2;
        (std::erfc(middle / std::sqrt(2.0)) > p ? low : high) = middle;
    }
    return high;
}

/// The fewest repetitions of each side with which the rank test can reach `p` at all:
/// 2 / (2n over n).
std::size_t fewest_for(double p) {
    std::size_t n = kLeastRuns;
    const auto reached = [](std::size_t runs) {
        return std::log(2.0) + 2 * std::lgamma(double(runs) + 1) -
               std::lgamma(2 * double(runs) + 1);
    };
    while (reached(n) > std::log(p)) ++n;
    return n;
}

/// About how many repetitions of each side would tell, if their spread stays as it is: for the
/// interval to lie within what does not matter, or for the change seen to be called one, whichever
/// takes fewer. An interval narrows with the root of their number.
std::size_t runs_needed(const TimeComparison& time, const Rules& rules, std::size_t tests) {
    const std::size_t runs = std::min(time.base_runs, time.new_runs);
    const double needed_p = rules.alpha / double(tests);
    const std::size_t fewest = fewest_for(needed_p);
    if (runs < kLeastRuns) return fewest;
    const double width = std::log(time.ratio.high / time.ratio.low) / 2;
    const double change = std::abs(std::log(time.ratio.ratio));
    const double margin = std::log1p(std::max(rules.matters, time.floor));
    double factor = 1e6;
    if (change < margin) factor = std::pow(width / (margin - change), 2);
    if (change > std::log1p(kLeastFloor)) {
        const double wanted = normal_quantile(needed_p) * width / kNormal95;
        factor = std::min(factor, std::pow(wanted / change, 2));
    }
    return std::max({std::size_t(std::ceil(double(runs) * factor)), runs + 1, fewest});
}

TimeVerdict verdict_of(const TimeComparison& time, const Rules& rules) {
    if (std::min(time.base_runs, time.new_runs) < kLeastRuns) return TimeVerdict::cannot_tell;
    if (time.p <= rules.alpha && share(time.ratio.ratio) > time.floor) {
        return time.ratio.ratio > 1 ? TimeVerdict::slower : TimeVerdict::faster;
    }
    const double margin = 1 + std::max(rules.matters, time.floor);
    const bool inside = time.ratio.low > 1 / margin && time.ratio.high < margin;
    return inside ? TimeVerdict::within_noise : TimeVerdict::cannot_tell;
}

}  // namespace

std::string machines_differ(const results::MachineContext& base,
                            const results::MachineContext& now) {
    constexpr std::string_view kTold[] = {"os", "kernel", "build_type", "cpu_quota_cores"};
    std::string words;
    results::each_field<results::MachineContext>([&](const auto& field) {
        const auto &before = base.*field.member, &after = now.*field.member;
        if (std::ranges::count(kTold, field.name) == 0 || before == after) return;
        words += fmt::format("{}{} is {} and {}", words.empty() ? "" : ", ", field.name,
                             results::to_text(results::encode(before)),
                             results::to_text(results::encode(after)));
    });
    return words;
}

void measure_times(const Setting& base, const Setting& now,
                   const std::vector<results::ResultFolder>& noise, SettingComparison& comparison) {
    const Cells old = base.good(), fresh = now.good();
    const std::set<std::string> before = devices_of(old), after = devices_of(fresh);
    const bool one = before.size() == 1 && after.size() == 1;
    bool common = false;
    for (const std::string& device : before) {
        if (!after.contains(device)) continue;
        common = true;
        const Cells a = on_device(old, device), b = on_device(fresh, device);
        const bool unchanged = comparison.same_figures() && same_plugin_and_counters(a, b);
        for (const JudgedTime& judged : kJudged) {
            auto time = time_of(judged, a, b, noise);
            if (!time) continue;
            if (!one) time->device = device;
            if (unchanged) time->verdict = TimeVerdict::not_the_methods;  // where it alarms
            comparison.times.push_back(std::move(*time));
        }
    }
    if (common || old.empty() || fresh.empty() || before.empty() || after.empty()) return;
    comparison.notes.push_back(
        fmt::format("times are not compared: BASE was flown on '{}', NEW on '{}'",
                    fmt::join(before, "', '"), fmt::join(after, "', '")));
}

void judge_times(Comparison& comparison, const Rules& rules) {
    std::vector<TimeComparison*> times;
    std::vector<double> p;
    for (SettingComparison& setting : comparison.settings) {
        for (TimeComparison& time : setting.times) {
            times.push_back(&time);
            p.push_back(time.p);
        }
    }
    comparison.time_tests = times.size();
    const std::vector<double> adjusted = measure::holm(p);
    for (std::size_t i = 0; i < times.size(); ++i) {
        TimeComparison& time = *times[i];
        time.p = adjusted[i];
        const bool unchanged = time.verdict == TimeVerdict::not_the_methods;
        time.verdict = verdict_of(time, rules);
        const bool alarms =
            time.verdict == TimeVerdict::slower || time.verdict == TimeVerdict::faster;
        if (unchanged && alarms) time.verdict = TimeVerdict::not_the_methods;
        if (time.verdict == TimeVerdict::cannot_tell) {
            time.runs_needed = runs_needed(time, rules, times.size());
        }
    }
}

}  // namespace lodbench::compare
