#include "extremes/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lodbench::extremes {
namespace {

using results::ExtremesFault;
using results::ExtremesFigures;

/// Kinds of failure, the worst first, and how bad each is.
struct Kind {
    const char* name;
    const char* outcome;
};
constexpr std::array kKinds = {Kind{"crash", "dead"},
                               Kind{"memory", "dead"},
                               Kind{"hang", "dead"},
                               Kind{"failed", "broken"},
                               Kind{"accepted", "broken"},
                               Kind{"not-finite", "broken"},
                               Kind{"nothing-drawn", "broken"},
                               Kind{"not-repeatable", "broken"},
                               Kind{"uncovered", "degraded"},
                               Kind{"cracks", "degraded"},
                               Kind{"bound", "degraded"},
                               Kind{"moved", "degraded"},
                               Kind{"selection", "degraded"},
                               Kind{"image", "degraded"}};

std::size_t rank_of(const std::string& kind) {
    const auto* const found = std::ranges::find(kKinds, kind, &Kind::name);
    return std::size_t(found - kKinds.begin());
}

// What invariance allows, of a world whose samples lie metres apart.
constexpr double kMovedMetres = 1e-3;
constexpr int kImageLevels = 1;
/// Of all pixels, those that a decision within rounding may change: where the world is scaled by
/// what is no power of two every product rounds anew.
constexpr double kChangedPixels = 1e-3;
constexpr double kExactPx = 1e-3;  // what float32 positions make of an exact surface
/// A bound that does not hold in the mild setting is exceeded by another factor elsewhere; twice
/// as far is another failure.
constexpr double kHonestyFactor = 2;

class Judge {
public:
    Judge(const ExtremesFigures& figures, const std::optional<ExtremesFigures>& mild)
        : figures_(figures), mild_(mild) {}

    void add(const char* what, std::string where, std::string words,
             std::optional<double> found = {}, std::optional<double> allowed = {},
             const char* unit = "") {
        faults.push_back({what, std::move(where), found, allowed, unit, std::move(words), ""});
    }

    void judge_vertices() {
        if (const auto count = figures_.not_finite.value_or(0); count > 0) {
            add("not-finite", "transform feedback",
                fmt::format("{} captured vertices are NaN or infinite", count), double(count), 0,
                "vertices");
        }
        if (const auto count = figures_.unrepeated.value_or(0); count > 0) {
            add("not-repeatable", "select",
                fmt::format("{} of {} frames, selected again with the same camera, were other "
                            "triangles",
                            count, figures_.frames.value_or(0)),
                double(count), 0, "frames");
        }
        if (figures_.samples.value_or(0) > 0 && figures_.triangles_max.value_or(1) == 0) {
            add("nothing-drawn", "draw",
                fmt::format("no triangle was drawn, with {} samples in view", *figures_.samples), 0,
                {}, "triangles");
        }
    }

    void judge_cover() {
        const auto uncovered = figures_.uncovered_samples.value_or(0);
        // Who leaves samples uncovered in the mild setting claims nothing about them.
        const bool allowed = mild_ && mild_->uncovered_samples.value_or(0) > 0;
        if (uncovered > 0 && !allowed) {
            add("uncovered", worst_place(),
                fmt::format("{} of {} samples in view are covered by no triangle", uncovered,
                            figures_.samples.value_or(0)),
                double(uncovered), 0, "samples");
        }
        const auto share = [](const ExtremesFigures& of) {
            return of.pixels.value_or(0) > 0
                       ? double(of.crack_pixels.value_or(0)) / double(*of.pixels)
                       : 0;
        };
        const double most = mild_ ? kHonestyFactor * share(*mild_) : 0;
        if (share(figures_) > most) {
            add("cracks", "picture",
                fmt::format("{} of {} pixels show a crack", *figures_.crack_pixels,
                            *figures_.pixels),
                double(*figures_.crack_pixels), std::floor(most * double(*figures_.pixels)),
                "pixels");
        }
    }

    void judge_bound() {
        if (!figures_.claimed_px || !figures_.screen_max_px) return;
        double honesty = 1;
        if (mild_ && mild_->claimed_px.value_or(0) > 0 && mild_->screen_max_px) {
            const double there = *mild_->screen_max_px / *mild_->claimed_px;
            if (there > 1 + kExactPx) honesty = kHonestyFactor * there;
        }
        const double allowed =
            honesty * *figures_.claimed_px + figures_.rounding_px.value_or(0) + kExactPx;
        if (*figures_.screen_max_px <= allowed) return;
        add("bound", worst_place(),
            fmt::format("screen error {:.4g} px, {:.4g} px are claimed{}", *figures_.screen_max_px,
                        *figures_.claimed_px,
                        honesty > 1 ? fmt::format(" ({:.4g} px as in the mild setting)", allowed)
                                    : std::string()),
            figures_.screen_max_px, allowed, "px");
    }

    void judge_invariance(const WorldChange& world) {
        if (!figures_.moved_m) return;
        const std::string frame = fmt::format("frame {}", figures_.changed_frame.value_or(0));
        const double changed = double(figures_.changed_pixels.value_or(0));
        const double pixels = double(figures_.pixels.value_or(1));
        const bool within_rounding = !world.is_power_of_two();
        const bool pixels_hold = changed <= kChangedPixels * pixels;
        if (*figures_.moved_m > kMovedMetres && !(within_rounding && pixels_hold)) {
            add("moved", frame,
                fmt::format("the surface lies up to {:.3g} m from where it is in the world as it "
                            "is",
                            *figures_.moved_m),
                figures_.moved_m, kMovedMetres, "m");
        } else if (world.scale != 1 && !within_rounding &&
                   figures_.changed_triangles.value_or(0) > 0) {
            add("selection", frame,
                fmt::format("{} of {} triangles differ to the bit", *figures_.changed_triangles,
                            figures_.compared_triangles.value_or(0)),
                double(*figures_.changed_triangles), 0, "triangles");
        }
        if (figures_.image_levels.value_or(0) > kImageLevels && !(within_rounding && pixels_hold)) {
            add("image", "picture",
                fmt::format("{} of {} pixels differ by more than a level, the worst by {} of 255",
                            changed, pixels, *figures_.image_levels),
                *figures_.image_levels, kImageLevels, "levels");
        }
    }

    std::vector<ExtremesFault> faults;

private:
    [[nodiscard]] std::string worst_place() const {
        if (!figures_.worst_row) return "";
        return fmt::format("frame {}, sample at row {}, column {}", *figures_.worst_frame,
                           *figures_.worst_row, *figures_.worst_column);
    }
    const ExtremesFigures& figures_;
    const std::optional<ExtremesFigures>& mild_;
};

const char* kind_of(ProbeOutcome::Ending ending) {
    switch (ending) {
        case ProbeOutcome::Ending::failed: return "failed";
        case ProbeOutcome::Ending::crashed: return "crash";
        case ProbeOutcome::Ending::hung: return "hang";
        case ProbeOutcome::Ending::out_of_memory: return "memory";
        case ProbeOutcome::Ending::finished:
        case ProbeOutcome::Ending::skipped: break;
    }
    return nullptr;
}

}  // namespace

std::vector<ExtremesFault> judge(const ProbeOutcome& outcome, const WorldChange& world,
                                 const std::optional<ExtremesFigures>& mild) {
    Judge judge(outcome.figures, mild);
    if (const char* kind = kind_of(outcome.ending)) {
        judge.add(kind, "", outcome.words);
    }
    judge.judge_vertices();
    judge.judge_cover();
    judge.judge_bound();
    judge.judge_invariance(world);
    std::ranges::stable_sort(judge.faults, {},
                             [](const ExtremesFault& fault) { return rank_of(fault.what); });
    return std::move(judge.faults);
}

const char* outcome_of(const std::vector<ExtremesFault>& faults) {
    const char* worst = "good";
    for (const ExtremesFault& fault : faults) {
        const char* outcome = kKinds.at(rank_of(fault.what)).outcome;
        if (results::severity_of(outcome) > results::severity_of(worst)) worst = outcome;
    }
    return worst;
}

void explain(std::vector<ExtremesFault>& faults, const Battery& battery, const std::string& method,
             const std::string& axis, const std::string& step) {
    for (ExtremesFault& fault : faults) {
        const auto found = std::ranges::find_if(battery.inherent, [&](const Inherent& inherent) {
            return inherent.covers(method, axis, step, fault.what);
        });
        if (found != battery.inherent.end()) fault.inherent = found->why;
    }
}

std::vector<std::string> unneeded_reasons(const Battery& battery,
                                          const results::ExtremesMatrix& matrix) {
    std::vector<std::string> words;
    for (const Inherent& inherent : battery.inherent) {
        bool flown = false, needed = false;
        for (const results::ExtremesCell& cell : matrix.cells) {
            if (cell.method != inherent.method) continue;
            flown = flown || inherent.axis.empty() || cell.axis == inherent.axis;
            for (const results::ExtremesStep& step : cell.steps) {
                needed =
                    needed || std::ranges::any_of(step.faults, [&](const ExtremesFault& fault) {
                        return inherent.covers(cell.method, cell.axis, step.step, fault.what);
                    });
            }
        }
        if (flown && !needed) {
            words.push_back(fmt::format("{}: no failure needs this reason any more; remove it",
                                        inherent.where));
        }
    }
    return words;
}

}  // namespace lodbench::extremes
