#include "report/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "report/aligned_table.h"
#include "report/table.h"

namespace lodbench::report {

using compare::Comparison;
using compare::SettingComparison;
using compare::TimeComparison;
using compare::TimeVerdict;

namespace {

std::string name_of(const SettingComparison& setting) {
    return setting.label + ", " + setting.scenario;
}

/// All that a gate fails for, a line each.
std::vector<std::string> regressions(const Comparison& comparison) {
    std::vector<std::string> lines;
    for (const SettingComparison& setting : comparison.settings) {
        const auto add = [&](const std::string& text) {
            lines.push_back(name_of(setting) + ": " + text);
        };
        for (const std::string& failure : setting.failures) add(failure);
        for (const auto& change : setting.frame_changes) add(text_of(change));
        for (const auto& change : setting.changes) add(text_of(change));
        for (const TimeComparison& time : setting.times) {
            if (time.fails_gate()) add(text_of(time));
        }
    }
    for (const std::string& setting : comparison.missing) {
        lines.push_back(setting + ": BASE has it, NEW does not");
    }
    return lines;
}

std::vector<std::string> remarks(const Comparison& comparison) {
    std::vector<std::string> lines;
    for (const std::string& setting : comparison.added) {
        lines.push_back(setting + ": new, so compared with nothing");
    }
    for (const std::string& note : comparison.notes) lines.push_back(note);
    // What many settings have in common is said once.
    std::vector<std::pair<std::string, std::vector<std::string>>> notes;  // and whose
    for (const SettingComparison& setting : comparison.settings) {
        for (const std::string& note : setting.notes) {
            auto known = std::ranges::find(notes, note, [](const auto& one) { return one.first; });
            if (known == notes.end()) known = notes.insert(known, {note, {}});
            known->second.push_back(name_of(setting));
        }
    }
    for (const auto& [note, whose] : notes) {
        lines.push_back(whose.size() == 1 ? fmt::format("{}: {}", whose.front(), note)
                                          : fmt::format("{} settings, {} and others: {}",
                                                        whose.size(), whose.front(), note));
    }
    return lines;
}

/// What is said of all times together.
std::vector<std::string> remarks_on_times(const Comparison& comparison) {
    bool one_after_the_other = false, from_spread = false, alarmed_in_vain = false;
    for (const SettingComparison& setting : comparison.settings) {
        for (const TimeComparison& time : setting.times) {
            one_after_the_other |= !time.in_turn;
            from_spread |= !time.measured_floor;
            alarmed_in_vain |= time.verdict == TimeVerdict::not_the_methods;
        }
    }
    std::vector<std::string> lines;
    if (one_after_the_other) {
        lines.emplace_back(
            "times are advice, no gate: the runs were not flown by turns, and what the machine did "
            "meanwhile is in them; scripts/compare-commits flies them so, and --confirm again");
    }
    if (from_spread) {
        lines.emplace_back(
            "the floor is estimated from the repetitions' spread; --noise DIR measures it from "
            "runs "
            "of one build");
    }
    if (alarmed_in_vain) {
        lines.emplace_back(
            "\"not the method's\": its plugin, counters and figures are unchanged, so that the "
            "harness or the machine made the difference");
    }
    return lines;
}

std::string percent(double ratio) {
    return fmt::format("{:+.1f} %", 100 * (ratio - 1));
}

std::string verdict_text(const TimeComparison& time) {
    std::string text = words_of(time.verdict);
    if (time.runs_needed > 10000) return text + ": over 10,000 repetitions needed";
    if (time.runs_needed > 0) {
        text += fmt::format(": {} repetitions needed", time.runs_needed);
    }
    return text;
}

std::string time_table(const Comparison& comparison) {
    std::vector<std::vector<std::string>> lines = {{"setting", "time", "repetitions", "base", "new",
                                                    "change", "95 % interval", "floor", "p of all",
                                                    "verdict"}};
    for (const SettingComparison& setting : comparison.settings) {
        for (const TimeComparison& time : setting.times) {
            const std::string name = name_of(setting);
            lines.push_back(
                {markdown_text(time.device.empty() ? name : name + " on " + time.device),
                 time.figure, fmt::format("{} and {}", time.base_runs, time.new_runs),
                 fmt::format("{:.4g}", time.base), fmt::format("{:.4g}", time.now),
                 percent(time.ratio.ratio),
                 fmt::format("{} to {}", percent(time.ratio.low), percent(time.ratio.high)),
                 fmt::format("{:.1f} %", 100 * time.floor), fmt::format("{:.2g}", time.p),
                 verdict_text(time)});
        }
    }
    return lines.size() == 1 ? "" : aligned_table(lines);
}

std::string gate_text(const Comparison& comparison, std::size_t regressions) {
    if (comparison.settings.empty()) return "nothing was compared";
    if (comparison.gate_holds()) {
        return fmt::format("holds: {} settings with equal figures", comparison.settings.size());
    }
    return fmt::format("fails: {} change{}", regressions, regressions == 1 ? "" : "s");
}

}  // namespace

std::string text_of(const compare::Change& change) {
    return fmt::format("{}: {} before, {} after", change.field, change.before, change.after);
}

std::string text_of(const compare::FrameChange& change) {
    return fmt::format("frame {}: {} {} before, {} after (in {} of {} frames)", change.frame,
                       change.column, change.before, change.after, change.changed, change.frames);
}

std::string text_of(const TimeComparison& time) {
    return fmt::format(
        "{}: {} {} ({} to {}), {:.4g} before, {:.4g} after, {} and {} repetitions, p {:.2g}{}",
        verdict_text(time), time.figure, percent(time.ratio.ratio), percent(time.ratio.low),
        percent(time.ratio.high), time.base, time.now, time.base_runs, time.new_runs, time.p,
        time.in_turn ? ", flown by turns" : "");
}

std::string comparison_text(const Comparison& comparison) {
    const std::vector<std::string> changed = regressions(comparison);
    std::string text = fmt::format("base      {}\nnew       {}\n", comparison.base, comparison.now);
    for (const std::string& line : changed) text += "changed   " + line + "\n";
    const std::string table = time_table(comparison);
    if (!table.empty()) text += "\n" + table + "\n";
    for (const std::string& line : remarks(comparison)) text += "note      " + line + "\n";
    for (const std::string& line : remarks_on_times(comparison)) text += "note      " + line + "\n";
    return text + "gate      " + gate_text(comparison, changed.size()) + "\n";
}

std::string comparison_markdown(const Comparison& comparison) {
    const std::vector<std::string> changed = regressions(comparison);
    std::string text = fmt::format("**Gate {}**\n\n", gate_text(comparison, changed.size()));
    constexpr std::size_t kMost = 50;  // a comment has its bounds
    for (std::size_t i = 0; i < std::min(changed.size(), kMost); ++i) {
        text += fmt::format("- {}\n", markdown_text(changed[i]));
    }
    if (changed.size() > kMost) text += fmt::format("- … and {} more\n", changed.size() - kMost);
    if (!changed.empty()) text += "\n";
    text += time_table(comparison);
    std::vector<std::string> notes = remarks(comparison);
    std::ranges::copy(remarks_on_times(comparison), std::back_inserter(notes));
    if (notes.empty()) return text;
    text += fmt::format("\n<details><summary>Notes: {}</summary>\n\n", notes.size());
    for (const std::string& note : notes) text += fmt::format("- {}\n", markdown_text(note));
    return text + "\n</details>\n";
}

}  // namespace lodbench::report
