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

/// The range of several displacement fields over a block; nothing covered leaves it at zero.
HeightInterval displacement_range(std::span<const std::span<const float>> fields,
                                  const SampleRect& rect, int columns) {
    float low = 0;
    float high = 0;
    for (const auto& field : fields) {
        for (int row = rect.row; row < rect.row + rect.rows; ++row) {
            const float* from =
                &field[std::size_t(row) * std::size_t(columns) + std::size_t(rect.column)];
            for (int i = 0; i < rect.columns; ++i) {
                // Comparisons with NaN are false.
                low = from[i] < low ? from[i] : low;
                high = from[i] > high ? from[i] : high;
            }
        }
    }
    return {low, high};
}

/// Whether a block may reach into the frustum.
bool may_be_in_view(const ReferenceTerrain& terrain, const BoxInView& in_view,
                    const SampleRect& rect, const HeightInterval& displacement) {
    const HeightInterval heights = terrain.range(rect);
    const glm::dvec3 south_west = terrain.sample(rect.row + rect.rows - 1, rect.column);
    const glm::dvec3 north_east = terrain.sample(rect.row, rect.column + rect.columns - 1);
    return in_view({glm::dvec2(south_west), heights.low + displacement.low},
                   {glm::dvec2(north_east), heights.high + displacement.high});
}

/// Calls `body(partial, row, column, index, local true point)` for all samples of the blocks that
/// may be in view, one row of blocks a task, and returns the rows' partials in order.
template <typename Partial, typename Body>
std::vector<Partial> for_samples(const ReferenceTerrain& terrain, const Camera& camera,
                                 std::span<const std::span<const float>> fields, const Body& body) {
    const TerrainInfo& info = terrain.info();
    const PixelProjection pixels(camera);
    const BoxInView in_view(camera, kSlack);
    const int block_rows = (info.rows + kBlock - 1) / kBlock;
    std::vector<Partial> partials(std::size_t(block_rows), Partial{});
    tbb::parallel_for(0, block_rows, [&](int block_row) {
        Partial& partial = partials[std::size_t(block_row)];
        for (int first = 0; first < info.columns; first += kBlock) {
            const SampleRect rect{block_row * kBlock, first,
                                  std::min(kBlock, info.rows - block_row * kBlock),
                                  std::min(kBlock, info.columns - first)};
            if (!may_be_in_view(terrain, in_view, rect,
                                displacement_range(fields, rect, info.columns))) {
                continue;
            }
            for (int row = rect.row; row < rect.row + rect.rows; ++row) {
                for (int column = first; column < first + rect.columns; ++column) {
                    const std::size_t index =
                        std::size_t(row) * std::size_t(info.columns) + std::size_t(column);
                    body(partial, row, column, index, pixels.local(terrain.sample(row, column)));
                }
            }
        }
    });
    return partials;
}

void keep_worst(const WorstSample& candidate, WorstSample& worst) {
    if (candidate.px > worst.px) worst = candidate;
}

/// Error of one sample in pixels; negative where it is not in view.
struct SampleError {
    double px = -1;
    bool clipped = false;
    bool true_point_in_view = false;
};

SampleError error_of(const PixelProjection& pixels, const glm::dvec3& up, const glm::dvec3& truth,
                     float displacement) {
    SampleError error;
    error.true_point_in_view = pixels.in_view(truth);
    if (std::isnan(displacement)) {
        if (error.true_point_in_view) error.px = kInfinity;
        return error;
    }
    const glm::dvec3 drawn = truth + up * double(displacement);
    if (!error.true_point_in_view && !pixels.in_view(drawn)) return error;
    const PixelProjection::Distance distance = pixels.distance(truth, drawn);
    error.px = distance.px;
    error.clipped = distance.clipped;
    return error;
}

}  // namespace

SampleErrors measure_samples(const ReferenceTerrain& terrain, const Camera& camera,
                             std::span<const float> displacements, double bound, ErrorPool& all,
                             const std::optional<VisibleErrors>& visible) {
    struct Partial {
        SampleErrors errors;
        ErrorSums all, visible;
    };
    const PixelProjection pixels(camera);
    const glm::dvec3 up = pixels.turned({0, 0, 1});
    const std::array fields{displacements};
    const auto partials = for_samples<Partial>(
        terrain, camera, fields,
        [&](Partial& partial, int row, int column, std::size_t index, const glm::dvec3& truth) {
            const float displacement = displacements[index];
            const SampleError error = error_of(pixels, up, truth, displacement);
            if (error.px < 0) return;
            all.tally(error.px);
            partial.all.add(error.px, bound);
            if (error.clipped) ++partial.errors.clipped;
            keep_worst({error.px, row, column}, partial.errors.worst);
            if (!std::isnan(displacement)) {
                ++partial.errors.heights.count;
                partial.errors.heights.sum_of_squares += double(displacement) * displacement;
            }
            if (visible && visible->view.sees(index)) {
                visible->pool.tally(error.px);
                partial.visible.add(error.px, bound);
                keep_worst({error.px, row, column}, partial.errors.worst_visible);
            }
        });
    SampleErrors errors;
    for (const Partial& partial : partials) {
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
        ErrorSums sums;
    };
    const PixelProjection pixels(later.camera);
    const PixelProjection pixels_before(earlier.camera);
    const glm::dvec3 up = pixels.turned({0, 0, 1});
    /// Whether the true or the drawn point was in the earlier view.
    const auto was_in_view = [&](int row, int column, float displacement) {
        const glm::dvec3 truth = terrain.sample(row, column);
        if (pixels_before.in_view(pixels_before.local(truth))) return true;
        const glm::dvec3 drawn = truth + glm::dvec3(0, 0, double(displacement));
        return !std::isnan(displacement) && pixels_before.in_view(pixels_before.local(drawn));
    };
    const std::array fields{earlier.displacements, later.displacements};
    const auto partials = for_samples<Partial>(
        terrain, later.camera, fields,
        [&](Partial& partial, int row, int column, std::size_t index, const glm::dvec3& truth) {
            const float before = earlier.displacements[index];
            const float after = later.displacements[index];
            const glm::dvec3 drawn = truth + up * double(after);
            const bool now_in_view =
                pixels.in_view(truth) || (!std::isnan(after) && pixels.in_view(drawn));
            if (!std::isnan(after) && now_in_view) {
                ++partial.popping.heights.count;
                partial.popping.heights.sum_of_squares += double(after) * after;
            }
            if (std::isnan(before) || std::isnan(after)) {
                if (std::isnan(before) != std::isnan(after) && now_in_view &&
                    was_in_view(row, column, before)) {
                    ++partial.popping.covered_once;
                }
                return;
            }
            const glm::dvec3 drawn_before = truth + up * double(before);
            if (!pixels.in_view(drawn) && !pixels.in_view(drawn_before)) return;
            if (!was_in_view(row, column, before)) return;
            const double px = pixels.distance(drawn_before, drawn).px;
            pool.tally(px);
            partial.sums.add(px, 1.0);
        });
    Popping popping;
    for (const Partial& partial : partials) {
        pool.add(partial.sums);
        popping.over_1px += partial.sums.over_bound;
        popping.covered_once += partial.popping.covered_once;
        popping.heights.add(partial.popping.heights);
    }
    return popping;
}

std::vector<float> map_of_errors(const ReferenceTerrain& terrain, const Camera& camera,
                                 std::span<const float> displacements, int map_rows,
                                 int map_columns) {
    const TerrainInfo& info = terrain.info();
    const PixelProjection pixels(camera);
    const glm::dvec3 up = pixels.turned({0, 0, 1});
    std::vector<float> map(std::size_t(map_rows) * std::size_t(map_columns),
                           std::numeric_limits<float>::quiet_NaN());
    // Sample i of n lies in cell floor(i * cells / n).
    const auto first_in = [](int cell, int cells, int samples) {
        return int((std::int64_t(cell) * samples + cells - 1) / cells);
    };
    tbb::parallel_for(0, map_rows, [&](int map_row) {
        const int end = first_in(map_row + 1, map_rows, info.rows);
        for (int row = first_in(map_row, map_rows, info.rows); row < end; ++row) {
            for (int column = 0; column < info.columns; ++column) {
                const std::size_t index =
                    std::size_t(row) * std::size_t(info.columns) + std::size_t(column);
                const double px = error_of(pixels, up, pixels.local(terrain.sample(row, column)),
                                           displacements[index])
                                      .px;
                if (px < 0) continue;
                const auto map_column = std::int64_t(column) * map_columns / info.columns;
                float& cell =
                    map[std::size_t(map_row) * std::size_t(map_columns) + std::size_t(map_column)];
                if (!(float(px) <= cell)) cell = float(px);  // also over NaN
            }
        }
    });
    return map;
}

}  // namespace lodbench::measure
