#include "stitching_strips/ground_heights.h"

#include <tbb/parallel_for.h>

#include <cmath>

namespace lodbench::stitching_strips {

GroundHeights::GroundHeights(const Terrain& terrain)
    : rows_(terrain.info().rows),
      columns_(terrain.info().columns),
      heights_(std::size_t(rows_) * std::size_t(columns_)) {
    constexpr int kRows = 64;
    tbb::parallel_for(0, (rows_ + kRows - 1) / kRows, [&](int band) {
        const int first = band * kRows, rows = std::min(kRows, rows_ - first);
        const std::size_t width = std::size_t(columns_);
        terrain.read(
            {first, 0, rows, columns_},
            std::span(heights_).subspan(std::size_t(first) * width, std::size_t(rows) * width));
    });
}

float GroundHeights::at(glm::vec2 place) const {
    const glm::vec2 whole(std::floor(place.x), std::floor(place.y));
    const glm::vec2 part = place - whole;
    const int column = int(whole.x), row = int(whole.y);
    const float south = at(column, row) + part.x * (at(column + 1, row) - at(column, row));
    const float north =
        at(column, row + 1) + part.x * (at(column + 1, row + 1) - at(column, row + 1));
    return south + part.y * (north - south);
}

}  // namespace lodbench::stitching_strips
