#include "stitching_strips/block_cut.h"

#include <algorithm>
#include <iterator>

namespace lodbench::stitching_strips {

BlockCut::BlockCut(const BlockTree& tree) : tree_(tree), place_(tree.size()) {}

void BlockCut::update(const BlockMetric& metric) {
    splits_before_ = splits_;
    std::ranges::sort(splits_before_);
    refine(metric, {});
}

void BlockCut::refine(const BlockMetric& metric, std::span<const char> forced) {
    leaves_.clear();
    splits_.clear();
    visit(metric, kRoot, Leaf{}.neighbours, forced);
    count_changes();
}

void BlockCut::count_changes() {
    std::vector<int> sorted = splits_, different;
    std::ranges::sort(sorted);
    std::ranges::set_symmetric_difference(splits_before_, sorted, std::back_inserter(different));
    changed_ = int(different.size());
}

void BlockCut::visit(const BlockMetric& metric, int number, const Neighbours& neighbours,
                     std::span<const char> forced) {
    const Block& block = tree_.block(number);
    const double allowed = metric.allowed_error(block);
    const bool fine_enough = !block.on_ground || double(tree_.errors(number).back()) <= allowed;
    const bool is_forced = !forced.empty() && forced[std::size_t(number + 1)] != 0;
    if ((fine_enough && !is_forced) || !tree_.has_children(number)) {
        place_[std::size_t(number + 1)] = int(leaves_.size());
        const float factor =
            block.on_ground ? tessellation_factor(tree_.errors(number), allowed) : 2.0F;
        leaves_.push_back({number, factor, neighbours});
        return;
    }
    place_[std::size_t(number + 1)] = -1 - int(splits_.size());
    splits_.push_back(number);
    for (int child = 0; child < 4; ++child) {
        visit(metric, first_child(number) + child, child_neighbours(number, neighbours, child),
              forced);
    }
}

}  // namespace lodbench::stitching_strips
