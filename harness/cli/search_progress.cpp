#include "cli/search_progress.h"

#include <fmt/format.h>

namespace lodbench::cli {

namespace {

/// ", at most 1:23 of searching left"; nothing before a probe was flown.
std::string most_left(const run::SearchPlace& place) {
    if (!place.most_left_s) return {};
    return fmt::format(", at most {} of searching left", minutes_text(*place.most_left_s));
}

std::string place_text(const run::SearchPlace& place) {
    return fmt::format("[{}/{}] {}: probe {} of at most {}:", place.method_number,
                       place.method_count, place.method, place.probe, place.most_probes);
}

}  // namespace

void SearchProgress::flying(const run::SearchPlace& place) {
    progress_.redraw(
        fmt::format("{} {:.0f} %{}", place_text(place), 100 * place.fraction, most_left(place)));
}

void SearchProgress::probed(const run::SearchPlace& place, const run::MatchedMethod& method,
                            const run::Probe& probe, const std::string& failure) {
    const std::string value = probe.value ? fmt::format("{:.6g}", *probe.value) : "-";
    progress_.line(fmt::format("{} {} = {:.6g} gives {}{}", place_text(place), method.knob->name,
                               probe.knob, failure.empty() ? value : failure, most_left(place)));
}

}  // namespace lodbench::cli
