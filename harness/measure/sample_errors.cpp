#include "measure/sample_errors.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "measure/box_in_view.h"
#include "measure/pixel_projection.h"

namespace lodbench::measure {

namespace {

constexpr int kBlock =
    64;  // samples along the edge of a block: culled as a whole, one row of blocks a task
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSlack = 1e-9;

/// Displacements of a block's samples by several frames, row by row.
template <std::size_t kFields>
using Displaced = std::array<std::vector<float>, kFields>;

/// Their range; nothing covered leaves it at zero.
template <std::size_t kFields>
HeightInterval range_of(const Displaced<kFields>& fields, const SampleRect& rect) {
    float low = 0;
    float high = 0;
    const std::size_t count = std::size_t(rect.rows) * std::size_t(rect.columns);
    for (const std::vector<float>& field : fields) {
        for (std::size_t i = 0; i < count; ++i) {
            // Comparisons with NaN are false.
            low = field[i] < low ? field[i] : low;
            high = field[i] > high ? field[i] : high;
        }
    }
    return {low, high};
}

/// Whether a block of heights within an interval may reach into the frustum.
bool may_be_in_view(const ReferenceTerrain& terrain, const BoxInView& in_view,
                    const SampleRect& rect, const HeightInterval& heights) {
    const glm::dvec2 south_west = terrain.info().position(rect.row + rect.rows - 1, rect.column);
    const glm::dvec2 north_east = terrain.info().position(rect.row, rect.column + rect.columns - 1);
    return in_view({south_west, heights.low}, {north_east, heights.high});
}

/// Fills `displaced` for a block; false where the block is out of view.
template <std::size_t kFields>
bool find_in_view(const ReferenceTerrain& terrain, const BoxInView& in_view,
                  const std::array<const DrawnSamples*, kFields>& fields, const SampleRect& rect,
                  Displaced<kFields>& displaced) {
    const HeightInterval heights = terrain.range(rect);
    // Before anything is drawn, what can be told without.
    HeightInterval all = heights;
    bool bounded = true;
    for (const DrawnSamples* field : fields) {
        const std::optional<HeightInterval> bounds = field->bounds();
        bounded = bounded && bounds;
        if (bounds) all = {std::min(all.low, bounds->low), std::max(all.high, bounds->high)};
    }
    if (bounded && !may_be_in_view(terrain, in_view, rect, all)) return false;
    for (std::size_t i = 0; i < kFields; ++i) fields[i]->copy(terrain, rect, displaced[i]);
    const HeightInterval displacement = range_of(displaced, rect);
    return may_be_in_view(terrain, in_view, rect,
                          {heights.low + displacement.low, heights.high + displacement.high});
}

/// Points of a run of samples side by side, in a camera's frame. One array a coordinate, and no
/// branch in what is done with them: the compiler takes several samples at a time.
struct Run {
    std::array<double, kBlock> x, y, z;
    [[nodiscard]] glm::dvec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

struct Samples {
    int row, column, count;  ///< `count` side by side, at most kBlock
    std::size_t first;       ///< index of the first
};

/// Where the surface lies at a run of samples: the true heights, or those `displaced` metres above.
Run points_of(const ReferenceTerrain& terrain, const PixelProjection& pixels,
              const Samples& samples, const float* displaced = nullptr) {
    const TerrainInfo& info = terrain.info();
    const float* heights = &terrain.heights()[samples.first];
    const double y = info.position(samples.row, samples.column).y;
    Run run;
    for (int i = 0; i < samples.count; ++i) {
        const double x = info.origin.x + info.spacing.x * double(samples.column + i);
        const double z = double(heights[i]) + (displaced == nullptr ? 0.0 : double(displaced[i]));
        const glm::dvec3 local = pixels.local({x, y, z});
        run.x[std::size_t(i)] = local.x;
        run.y[std::size_t(i)] = local.y;
        run.z[std::size_t(i)] = local.z;
    }
    return run;
}

/// Calls `body(partial, samples, displaced)` for all runs of samples of the blocks that may be in
/// view, one row of blocks a task, and returns the rows' partials in order. `displaced[i]`: of the
/// run's samples by `fields[i]`.
template <typename Partial, std::size_t kFields, typename Body>
std::vector<Partial> for_samples(const ReferenceTerrain& terrain, const Camera& camera,
                                 const std::array<const DrawnSamples*, kFields>& fields,
                                 const Body& body) {
    const TerrainInfo& info = terrain.info();
    const BoxInView in_view(camera, kSlack);
    const int block_rows = (info.rows + kBlock - 1) / kBlock;
    std::vector<Partial> partials(std::size_t(block_rows), Partial{});
    tbb::parallel_for(0, block_rows, [&](int block_row) {
        Partial& partial = partials[std::size_t(block_row)];
        Displaced<kFields> displaced;
        for (std::vector<float>& field : displaced) field.resize(std::size_t{kBlock} * kBlock);
        for (int first = 0; first < info.columns; first += kBlock) {
            const SampleRect rect{block_row * kBlock, first,
                                  std::min(kBlock, info.rows - block_row * kBlock),
                                  std::min(kBlock, info.columns - first)};
            if (!find_in_view(terrain, in_view, fields, rect, displaced)) continue;
            for (int row = 0; row < rect.rows; ++row) {
                std::array<const float*, kFields> of_run;
                for (std::size_t i = 0; i < kFields; ++i) {
                    of_run[i] = &displaced[i][std::size_t(row) * std::size_t(rect.columns)];
                }
                body(partial,
                     Samples{rect.row + row, first, rect.columns,
                             std::size_t(rect.row + row) * std::size_t(info.columns) +
                                 std::size_t(first)},
                     of_run);
            }
        }
        terrain.forget();
    });
    return partials;
}

void keep_worst(const WorstSample& candidate, WorstSample& worst) {
    if (candidate.px > worst.px) worst = candidate;
}

/// 1 where a point of the run lies in the frustum, else 0; 0 where it is NaN.
using Flags = std::array<double, kBlock>;
Flags in_view(const PixelProjection& pixels, const Run& run, int count) {
    Flags flags;
    for (std::size_t i = 0; i < std::size_t(count); ++i) {
        flags[i] = pixels.in_view(run.at(i)) ? 1.0 : 0.0;
    }
    return flags;
}

/// NaN where a displacement is.
Run raised(const Run& run, const glm::dvec3& up, const float* displacements, int count) {
    Run result;
    for (std::size_t i = 0; i < std::size_t(count); ++i) {
        const double displacement = displacements[i];
        result.x[i] = run.x[i] + up.x * displacement;
        result.y[i] = run.y[i] + up.y * displacement;
        result.z[i] = run.z[i] + up.z * displacement;
    }
    return result;
}

/// Between the points of two runs, pixels; meaningless where one is nearer than the near plane.
std::array<double, kBlock> unclipped_distances(const PixelProjection& pixels, const Run& a,
                                               const Run& b, int count) {
    std::array<double, kBlock> px;
    for (std::size_t i = 0; i < std::size_t(count); ++i) {
        px[i] = pixels.unclipped_distance(a.at(i), b.at(i));
    }
    return px;
}

/// Errors of a run of samples in pixels; negative where one is not in view.
struct RunErrors {
    std::array<double, kBlock> px;
    std::array<bool, kBlock> clipped{};
};

RunErrors errors_of(const ReferenceTerrain& terrain, const PixelProjection& pixels,
                    const Samples& samples, const float* displacements) {
    const int count = samples.count;
    const Run truth = points_of(terrain, pixels, samples);
    const Run drawn = raised(truth, pixels.turned({0, 0, 1}), displacements, count);
    const Flags true_in_view = in_view(pixels, truth, count);
    const Flags drawn_in_view = in_view(pixels, drawn, count);  // never where not covered: NaN
    RunErrors errors{unclipped_distances(pixels, truth, drawn, count)};
    double nearest = pixels.near_plane();
    for (std::size_t i = 0; i < std::size_t(count); ++i) {
        const double px = std::isnan(drawn.z[i]) ? kInfinity : errors.px[i];
        errors.px[i] = true_in_view[i] + drawn_in_view[i] > 0 ? px : -1.0;
        nearest = std::min(nearest, std::min(truth.z[i], drawn.z[i]));
    }
    if (nearest == pixels.near_plane()) return errors;
    for (std::size_t i = 0; i < std::size_t(count); ++i) {
        if (errors.px[i] < 0 || std::isnan(drawn.z[i])) continue;
        const PixelProjection::Distance distance = pixels.distance(truth.at(i), drawn.at(i));
        errors.px[i] = distance.px;
        errors.clipped[i] = distance.clipped;
    }
    return errors;
}

}  // namespace

SampleErrors measure_samples(const ReferenceTerrain& terrain, const Camera& camera,
                             const DrawnSamples& drawn, double bound, ErrorPool& all,
                             const std::optional<VisibleErrors>& visible) {
    struct Partial {
        SampleErrors errors;
        ErrorBatch all, visible;
    };
    const PixelProjection pixels(camera);
    auto partials = for_samples<Partial, 1>(
        terrain, camera, {&drawn},
        [&](Partial& partial, const Samples& samples,
            const std::array<const float*, 1>& displaced) {
            const float* const displacements = displaced[0];
            const RunErrors errors = errors_of(terrain, pixels, samples, displacements);
            for (int i = 0; i < samples.count; ++i) {
                const double px = errors.px[std::size_t(i)];
                if (px < 0) continue;
                const WorstSample sample{px, samples.row, samples.column + i};
                all.tally(partial.all, px, bound);
                if (errors.clipped[std::size_t(i)]) ++partial.errors.clipped;
                keep_worst(sample, partial.errors.worst);
                if (const float displacement = displacements[i]; !std::isnan(displacement)) {
                    ++partial.errors.heights.count;
                    partial.errors.heights.sum_of_squares += double(displacement) * displacement;
                }
                if (visible && visible->view.sees(samples.first + std::size_t(i))) {
                    visible->pool.tally(partial.visible, px, bound);
                    keep_worst(sample, partial.errors.worst_visible);
                }
            }
        });
    SampleErrors errors;
    for (Partial& partial : partials) {
        all.add(partial.all);
        if (visible) visible->pool.add(partial.visible);
        keep_worst(partial.errors.worst, errors.worst);
        keep_worst(partial.errors.worst_visible, errors.worst_visible);
        errors.clipped += partial.errors.clipped;
        errors.heights.add(partial.errors.heights);
    }
    return errors;
}

Popping measure_popping(const ReferenceTerrain& terrain, const DrawnFrame& earlier,
                        const DrawnFrame& later, ErrorPool& pool) {
    struct Partial {
        Popping popping;
        ErrorBatch errors;
    };
    const PixelProjection pixels(later.camera);
    const PixelProjection pixels_before(earlier.camera);
    const glm::dvec3 up = pixels.turned({0, 0, 1});
    auto partials = for_samples<Partial, 2>(
        terrain, later.camera, {&earlier.drawn, &later.drawn},
        [&](Partial& partial, const Samples& samples,
            const std::array<const float*, 2>& displaced) {
            const auto [befores, afters] = displaced;
            const int count = samples.count;
            const Run truth = points_of(terrain, pixels, samples);
            const Run now = raised(truth, up, afters, count);
            const Run before_now = raised(truth, up, befores, count);
            const Flags truth_seen = in_view(pixels, truth, count);
            const Flags now_seen = in_view(pixels, now, count);
            const Flags before_now_seen = in_view(pixels, before_now, count);
            // The true and the drawn points in the earlier view.
            const Flags truth_was_seen =
                in_view(pixels_before, points_of(terrain, pixels_before, samples), count);
            const Flags drawn_was_seen =
                in_view(pixels_before, points_of(terrain, pixels_before, samples, befores), count);
            for (std::size_t i = 0; i < std::size_t(count); ++i) {
                const bool in_view_now = truth_seen[i] + now_seen[i] > 0;
                const bool was_in_view = truth_was_seen[i] + drawn_was_seen[i] > 0;
                const float before = befores[i];
                const float after = afters[i];
                if (!std::isnan(after) && in_view_now) {
                    ++partial.popping.heights.count;
                    partial.popping.heights.sum_of_squares += double(after) * after;
                }
                if (std::isnan(before) || std::isnan(after)) {
                    if (std::isnan(before) != std::isnan(after) && in_view_now && was_in_view) {
                        ++partial.popping.covered_once;
                    }
                    continue;
                }
                if (now_seen[i] + before_now_seen[i] == 0 || !was_in_view) continue;
                // Most of the surface stays where it was.
                const double px =
                    before == after ? 0 : pixels.distance(before_now.at(i), now.at(i)).px;
                pool.tally(partial.errors, px, 1.0);
            }
        });
    Popping popping;
    for (Partial& partial : partials) {
        pool.add(partial.errors);
        popping.over_1px += partial.errors.sums.over_bound;
        popping.covered_once += partial.popping.covered_once;
        popping.heights.add(partial.popping.heights);
    }
    return popping;
}

std::vector<float> map_of_errors(const ReferenceTerrain& terrain, const Camera& camera,
                                 const DrawnSamples& drawn, int map_rows, int map_columns) {
    const TerrainInfo& info = terrain.info();
    const PixelProjection pixels(camera);
    // Sample i of n lies in cell floor(i * cells / n).
    const auto cell_of = [](int sample, int cells, int samples) {
        return std::size_t(std::int64_t(sample) * cells / samples);
    };
    struct Partial {
        std::size_t first = 0;  ///< row of the map
        std::vector<float> rows;
    };
    const auto keep_greatest = [](float px, float& cell) {
        if (!(px <= cell)) cell = px;  // also over NaN
    };
    const auto partials = for_samples<Partial, 1>(
        terrain, camera, {&drawn},
        [&](Partial& partial, const Samples& samples,
            const std::array<const float*, 1>& displaced) {
            if (partial.rows.empty()) {
                const int first = samples.row / kBlock * kBlock;
                const int last = std::min(first + kBlock, info.rows) - 1;
                partial.first = cell_of(first, map_rows, info.rows);
                partial.rows.assign((cell_of(last, map_rows, info.rows) + 1 - partial.first) *
                                        std::size_t(map_columns),
                                    std::numeric_limits<float>::quiet_NaN());
            }
            const RunErrors errors = errors_of(terrain, pixels, samples, displaced[0]);
            const std::size_t row = cell_of(samples.row, map_rows, info.rows) - partial.first;
            for (int i = 0; i < samples.count; ++i) {
                const auto px = float(errors.px[std::size_t(i)]);
                if (px < 0) continue;
                keep_greatest(px,
                              partial.rows[row * std::size_t(map_columns) +
                                           cell_of(samples.column + i, map_columns, info.columns)]);
            }
        });
    std::vector<float> map(std::size_t(map_rows) * std::size_t(map_columns),
                           std::numeric_limits<float>::quiet_NaN());
    for (const Partial& partial : partials) {
        for (std::size_t i = 0; i < partial.rows.size(); ++i) {
            if (std::isnan(partial.rows[i])) continue;
            keep_greatest(partial.rows[i], map[partial.first * std::size_t(map_columns) + i]);
        }
    }
    return map;
}

}  // namespace lodbench::measure
