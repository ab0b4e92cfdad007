#include "measure/whole_heights.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodbench::measure {

namespace {

constexpr int kBlock = 64;  // samples along the edge of a block

/// Of a row of blocks.
struct Band {
    std::uint64_t covered = 0;
    double sum_of_squares = 0;
    std::size_t first_map_row = 0;
    std::vector<float> map_m;
};

// Sample i of n lies in cell floor(i * cells / n).
std::size_t cell_of(int sample, int cells, int samples) {
    return std::size_t(std::int64_t(sample) * cells / samples);
}

Band measure_band(const ReferenceTerrain& terrain, const DrawnSurface& drawn, const MapSize& map,
                  int first_row) {
    const TerrainInfo& info = terrain.info();
    const int rows = std::min(kBlock, info.rows - first_row);
    Band band;
    band.first_map_row = cell_of(first_row, map.rows, info.rows);
    const std::size_t last_map_row = cell_of(first_row + rows - 1, map.rows, info.rows);
    band.map_m.resize((last_map_row + 1 - band.first_map_row) * std::size_t(map.columns));
    std::vector<float> displacements;
    for (int column = 0; column < info.columns; column += kBlock) {
        const SampleRect rect{first_row, column, rows, std::min(kBlock, info.columns - column)};
        displacements.resize(std::size_t(rect.rows) * std::size_t(rect.columns));
        drawn.displacements(terrain.heights(), rect, displacements);
        for (std::size_t i = 0; i < displacements.size(); ++i) {
            const int row = rect.row + int(i) / rect.columns;
            const std::size_t cell =
                (cell_of(row, map.rows, info.rows) - band.first_map_row) *
                    std::size_t(map.columns) +
                cell_of(rect.column + int(i) % rect.columns, map.columns, info.columns);
            const float displacement = displacements[i];
            if (std::isnan(displacement)) {
                band.map_m[cell] = std::numeric_limits<float>::infinity();
                continue;
            }
            ++band.covered;
            band.sum_of_squares += double(displacement) * double(displacement);
            band.map_m[cell] = std::max(band.map_m[cell], std::abs(displacement));
        }
    }
    terrain.forget();
    return band;
}

}  // namespace

std::optional<double> WholeHeights::rmse() const {
    if (covered != samples) return std::nullopt;
    return std::sqrt(sum_of_squares / double(samples));
}

WholeHeights measure_whole_heights(const ReferenceTerrain& terrain, const DrawnSurface& drawn) {
    const TerrainInfo& info = terrain.info();
    WholeHeights whole{.map = MapSize(info), .map_m = {}};
    whole.samples = terrain.heights().size();
    whole.map_m.assign(std::size_t(whole.map.rows) * std::size_t(whole.map.columns), 0.0F);
    std::vector<Band> bands(std::size_t((info.rows + kBlock - 1) / kBlock));
    tbb::parallel_for(std::size_t(0), bands.size(), [&](std::size_t i) {
        bands[i] = measure_band(terrain, drawn, whole.map, int(i) * kBlock);
    });
    for (const Band& band : bands) {
        whole.covered += band.covered;
        whole.sum_of_squares += band.sum_of_squares;
        float* const first = &whole.map_m[band.first_map_row * std::size_t(whole.map.columns)];
        for (std::size_t i = 0; i < band.map_m.size(); ++i) {
            first[i] = std::max(first[i], band.map_m[i]);
        }
    }
    return whole;
}

WholeHeightSummary summarize(const std::vector<WholeHeights>& frames) {
    WholeHeightSummary summary;
    summary.frames = int(frames.size());
    double sum = 0, greatest = 0;
    std::optional<double> change;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        summary.covered_least = std::min(summary.covered_least, frames[i].covered_share());
        const double rmse = frames[i].rmse().value_or(0);
        sum += rmse;
        greatest = std::max(greatest, rmse);
        if (i == 0) continue;
        change = std::max(change.value_or(0), std::abs(rmse - frames[i - 1].rmse().value_or(0)));
    }
    if (frames.empty() || summary.covered_least < 1) return summary;
    summary.rmse_max = greatest;
    summary.rmse_mean = sum / double(frames.size());
    summary.rmse_change_max = change;
    return summary;
}

}  // namespace lodbench::measure
