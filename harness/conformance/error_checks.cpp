// What a method's quality knob is worth: at its fine end the surface is the terrain, what is
// claimed holds, and finer is not worse. Screen error as in docs/measurement.md, at every sample in
// view.

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "conformance/session.h"
#include "measure/drawn_surface.h"
#include "measure/sample_errors.h"

namespace lodbench::conformance {

namespace {

constexpr int kCameras = 3;

/// The screen error of one quality, over all cameras.
struct Errors {
    measure::ErrorSummary all;
    measure::WorstSample worst;
    int worst_camera = 0;
};

Errors measure_errors(const Subject& subject, const TerrainPointer& terrain,
                      const Quality& quality) {
    const measure::ReferenceTerrain reference(terrain->samples(), terrain->info());
    const double bound = std::numeric_limits<double>::infinity();
    measure::ErrorPool all;
    Errors errors;
    Session session(subject, terrain, quality.settings);
    Random random(subject.seed);
    std::vector<float> displacements(terrain->samples().size());
    for (int i = 0; i < kCameras; ++i) {
        const Camera camera = random_camera(random, terrain->info());
        session.select(camera, i);
        auto captured = session.capture();
        require_finite(captured, fmt::format("{}, camera {}", quality.name, i));
        measure::DrawnSurface(std::move(captured), terrain->info())
            .displacements(terrain->samples(), displacements);
        const auto found = measure::measure_samples(reference, camera, displacements, bound, all);
        if (found.worst.px <= errors.worst.px) continue;
        errors.worst = found.worst;
        errors.worst_camera = i;
    }
    errors.all = all.summary(false);
    return errors;
}

std::string where_worst(const Errors& errors, const Subject& subject) {
    return fmt::format("camera {} of seed {}, sample at row {}, column {}", errors.worst_camera,
                       subject.seed, errors.worst.row, errors.worst.column);
}

/// A thousandth of a pixel is what float32 positions make of an exact surface.
constexpr double kExactPx = 1e-3;

}  // namespace

void finest_is_the_terrain(const Subject& subject) {
    // A bound below a pixel is another promise (claimed-bound-holds). Who claims none may miss a
    // peak, but not the terrain.
    constexpr double kGreatestPx = 1, kRootMeanSquarePx = 2;
    const Qualities& qualities = qualities_of(subject);
    const Quality& finest = qualities.finest.value_or(qualities.given);
    const Errors errors = measure_errors(subject, qualities.terrain(), finest);
    const bool bounded = finest.claimed_px.has_value() || !qualities.finest;
    const double limit =
        bounded ? std::max(kGreatestPx, finest.claimed_px.value_or(0)) : kRootMeanSquarePx;
    // Nothing in view, or nothing drawn, is no terrain.
    const double infinity = std::numeric_limits<double>::infinity();
    const double rms = errors.all.uncovered > 0 ? infinity : errors.all.rms.value_or(infinity);
    const double found = bounded ? errors.all.max.value_or(infinity) : rms;
    if (found <= limit) return;
    throw PromiseBroken(fmt::format(
        "{}: the surface is not the terrain: {} screen error {:.3g} px, at most {:g} px were "
        "expected; {} of {} samples in view are covered by no triangle; worst at {} "
        "(a texture or buffer that is not bound, or level of detail that never gets fine?)",
        finest.name, bounded ? "greatest" : "root mean square", found, limit, errors.all.uncovered,
        errors.all.count, where_worst(errors, subject)));
}

void claimed_bound_holds(const Subject& subject) {
    if (subject.method.claimed_bound.empty()) {
        throw NotApplicable("the method claims no bound on its error");
    }
    const Qualities& qualities = qualities_of(subject);
    const TerrainPointer terrain = qualities.terrain();
    std::string broken;
    for (const Quality& quality : qualities.all()) {
        const Errors errors = measure_errors(subject, terrain, quality);
        const double claimed = quality.claimed_px.value();
        const double greatest = errors.all.max.value_or(0);
        if (greatest <= claimed + kExactPx) continue;
        broken += fmt::format(
            "{}{}: {:.3g} px are claimed, {:.3g} px were measured ({:.2f} times as much, {})",
            broken.empty() ? "" : "; ", quality.name, claimed, greatest, greatest / claimed,
            where_worst(errors, subject));
    }
    if (!broken.empty()) throw ClaimBroken("the claimed bound does not hold: " + broken);
}

void finer_is_no_worse(const Subject& subject) {
    // Which samples are drawn differs, so that a few of them may be worse off.
    constexpr double kSlack = 1.1, kSlackPx = 0.05;
    const std::vector<Quality> qualities = qualities_of(subject).all();
    if (qualities.size() < 2) throw NotApplicable("the method has no quality knob");
    const TerrainPointer terrain = qualities_of(subject).terrain();
    double coarser_px = 0;
    for (std::size_t i = 0; i < qualities.size(); ++i) {
        const double px = measure_errors(subject, terrain, qualities[i]).all.p999.value_or(0);
        if (i > 0 && px > kSlack * coarser_px + kSlackPx) {
            throw PromiseBroken(fmt::format(
                "{} is finer than {}, but its P99.9 of the screen error is {:.3g} px after {:.3g} "
                "px",
                qualities[i].name, qualities[i - 1].name, px, coarser_px));
        }
        coarser_px = px;
    }
}

}  // namespace lodbench::conformance
