#include "stitching_strips/block_tree.h"

#include <glm/common.hpp>

namespace lodbench::stitching_strips {

BlockTree::BlockTree(const Terrain& terrain, const GroundHeights& ground, int gap, ErrorKind kind)
    : info_(terrain.info()), layout_(info_.rows, info_.columns, gap), ranges_(terrain) {
    const auto add = [&](const Square& square, int depth) {
        Block& block = blocks_.emplace_back();
        block.square = square;
        block.depth = depth;
        block.on_ground = on_ground(square.corner);
        block.box = box(square.corner, square.corner + square.side);
        const glm::dvec2 middle = glm::dvec2(square.corner) + 0.5 * square.side;
        block.centre = {info_.origin + info_.spacing * middle,
                        double(ground.at(glm::vec2(middle)))};
    };
    add(layout_.root(), 0);
    for (int number = kRoot; has_children(number); ++number) {
        const Square square = block(number).square;
        const int depth = block(number).depth;
        for (int child = 0; child < 4; ++child) {
            add(layout_.child(square, depth, child), depth + 1);
        }
    }
    std::vector<Square> squares;
    squares.reserve(blocks_.size());
    for (const Block& block : blocks_) squares.push_back(block.square);
    errors_ = block_errors(ground, squares, kind);
}

common::Box BlockTree::box(glm::ivec2 south_west, glm::ivec2 north_east) const {
    const glm::ivec2 last(info_.columns - 1, info_.rows - 1);
    const glm::ivec2 low = glm::min(south_west, last), high = glm::min(north_east, last);
    const glm::vec2 heights = ranges_.within({low.x, last.y - high.y}, {high.x, last.y - low.y});
    return {{info_.origin + info_.spacing * glm::dvec2(low), double(heights.x)},
            {info_.origin + info_.spacing * glm::dvec2(high), double(heights.y)}};
}

}  // namespace lodbench::stitching_strips
