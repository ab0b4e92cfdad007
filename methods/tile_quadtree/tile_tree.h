#pragma once
// From decisions to the tree that a frame is to show: which tiles split, most urgent first, until
// the pool would not hold the leaves.

#include <cstdint>
#include <queue>
#include <vector>

#include "tile_quadtree/tile_catalogue.h"

namespace lodbench::tile_quadtree {

struct TreeNode {
    TileId tile;
    int parent = -1;       ///< place in TileTree::nodes
    int first_child = -1;  ///< the children follow each other; -1: a leaf
    int child_count = 0;
};

/// Of a node that splits, those children are in the tree that may be in view; none may be.
struct TileTree {
    std::vector<TreeNode> nodes;  ///< parents before their children; empty: nothing is in view
    int refused = 0;              ///< nodes that should split and did not, for the pool's sake

    [[nodiscard]] bool is_leaf(const TreeNode& node) const { return node.first_child < 0; }
    /// Leaves, in the order of their nodes.
    [[nodiscard]] std::vector<TileId> leaves() const {
        std::vector<TileId> found;
        for (const TreeNode& node : nodes) {
            if (is_leaf(node)) found.push_back(node.tile);
        }
        return found;
    }
};

/// Grows the tree from the root. `splits(tile)`: by the metric, never at level 0;
/// `in_view(tile)`: whether the tile is drawn at all; `urgency(tile)`: of those that split, the
/// most urgent come first. At most `most_leaves` leaves (>= 1): equal input gives an equal tree,
/// whatever was drawn before.
template <typename Splits, typename InView, typename Urgency>
[[nodiscard]] TileTree grow_tree(const TileCatalogue& catalogue, int most_leaves,
                                 const Splits& splits, const InView& in_view,
                                 const Urgency& urgency) {
    struct Candidate {
        double urgency;
        int node;
        // Ties go to the node that came first.
        bool operator<(const Candidate& other) const {
            return urgency != other.urgency ? urgency < other.urgency : node > other.node;
        }
    };
    TileTree tree;
    std::priority_queue<Candidate> candidates;
    const auto add = [&](const TileId& tile, int parent) {
        const int node = int(tree.nodes.size());
        tree.nodes.push_back({tile, parent, -1, 0});
        if (splits(tile)) candidates.push({urgency(tile), node});
    };
    if (const TileId root = catalogue.pyramid().root(); in_view(root)) add(root, -1);
    int leaves = int(tree.nodes.size());
    std::vector<TileId> children;
    while (!candidates.empty()) {
        const int node = candidates.top().node;
        candidates.pop();
        children.clear();
        catalogue.for_each_child(tree.nodes[std::size_t(node)].tile, [&](const TileId& child) {
            if (in_view(child)) children.push_back(child);
        });
        if (leaves - 1 + int(children.size()) > most_leaves) {
            ++tree.refused;
            continue;
        }
        leaves += int(children.size()) - 1;
        tree.nodes[std::size_t(node)].first_child = int(tree.nodes.size());
        tree.nodes[std::size_t(node)].child_count = int(children.size());
        for (const TileId& child : children) add(child, node);
    }
    return tree;
}

}  // namespace lodbench::tile_quadtree
