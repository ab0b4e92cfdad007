#include "stitching_strips/uniform_blocks.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "common/height_ranges.h"
#include "stitching_strips/tess_coordinates.h"

namespace lodbench::stitching_strips {
namespace {

float line_error(std::span<const float> heights, int factor, ErrorKind kind) {
    const int cells = int(heights.size()) - 1;
    const auto vertex = [&](int index) {
        return float(cells) * tess_coordinate(index, float(factor));
    };
    const auto height = [&](float place) {
        const auto first = std::size_t(std::min(int(place), cells - 1));
        return heights[first] + (place - float(first)) * (heights[first + 1] - heights[first]);
    };
    double sum = 0, greatest = 0;
    int segment = 0;
    for (int sample = 0; sample <= cells; ++sample) {
        while (segment + 1 < factor && vertex(segment + 1) <= float(sample)) ++segment;
        const float from = vertex(segment), to = vertex(segment + 1);
        const float share = (float(sample) - from) / (to - from);
        const float drawn = height(from) + share * (height(to) - height(from));
        const double error = std::abs(double(drawn) - heights[std::size_t(sample)]);
        sum += error;
        greatest = std::max(greatest, error);
    }
    return float(kind == ErrorKind::max ? greatest : sum / double(heights.size()));
}

}  // namespace

UniformBlocks::UniformBlocks(int rows, int columns, int cells_) : cells(cells_) {
    if (cells == kEighth) cells = std::min((std::max(rows, columns) + 6) / 8, 128);
    count = {(columns - 2) / cells + 1, (rows - 2) / cells + 1};
}

BlockErrors line_errors(std::span<const float> heights, ErrorKind kind) {
    BlockErrors errors{};
    for (int i = 0; i < kErrorCount; ++i) {
        errors[std::size_t(i)] = line_error(heights, factor_of_error(i), kind);
    }
    return errors;
}

std::vector<BlockErrors> uniform_errors(const GroundHeights& ground, const UniformBlocks& blocks,
                                        ErrorKind kind) {
    const int eastward = blocks.count.x * (blocks.count.y + 1);
    const int northward = (blocks.count.x + 1) * blocks.count.y;
    std::vector<BlockErrors> errors(std::size_t(eastward + northward));
    tbb::parallel_for(0, eastward + northward, [&](int edge) {
        const bool is_eastward = edge < eastward;
        const int number = is_eastward ? edge : edge - eastward;
        const int in_a_row = is_eastward ? blocks.count.x : blocks.count.x + 1;
        const glm::ivec2 first = blocks.cells * glm::ivec2(number % in_a_row, number / in_a_row);
        const glm::ivec2 step(is_eastward, !is_eastward);
        std::vector<float> heights;
        for (int i = 0; i <= blocks.cells; ++i) {
            heights.push_back(ground.at(first.x + i * step.x, first.y + i * step.y));
        }
        errors[std::size_t(edge)] = line_errors(heights, kind);
    });
    std::vector<Square> squares;
    for (int block = 0; block < blocks.size(); ++block) squares.push_back(blocks.block(block));
    const std::vector<BlockErrors> of_blocks = block_errors(ground, squares, kind);
    errors.insert(errors.end(), of_blocks.begin(), of_blocks.end());
    return errors;
}

std::vector<common::Box> uniform_boxes(const Terrain& terrain, const UniformBlocks& blocks) {
    const TerrainInfo& info = terrain.info();
    const common::HeightRanges ranges(terrain);
    const glm::ivec2 last(info.columns - 1, info.rows - 1);
    std::vector<common::Box> boxes;
    for (int number = 0; number < blocks.size(); ++number) {
        const glm::ivec2 low = blocks.block(number).corner;
        const glm::ivec2 high = glm::min(low + blocks.cells, last);
        const glm::vec2 heights = ranges.within({low.x, last.y - high.y}, {high.x, last.y - low.y});
        boxes.push_back({glm::dvec3(info.origin + info.spacing * glm::dvec2(low), heights.x),
                         glm::dvec3(info.origin + info.spacing * glm::dvec2(high), heights.y)});
    }
    return boxes;
}

}  // namespace lodbench::stitching_strips
