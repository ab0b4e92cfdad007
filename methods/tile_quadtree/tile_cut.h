#pragma once
// From the tree to the tiles that are drawn: covered by what is resident, and joined without gaps.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "tile_quadtree/tile_tree.h"

namespace lodbench::tile_quadtree {

/// Neighbours at most this much coarser: then no corner of a tile lies between two vertices of a
/// neighbour's edge, whose 64 cells are then 64 of the tile's or fewer steps apart.
inline constexpr int kMostCoarser = 6;

/// How many levels coarser the tile is that lies across an edge; 0 where it is not coarser, or
/// where none is drawn.
struct EdgeSteps {
    std::array<int, 4> coarser{};  ///< north, west, east, south
    friend bool operator==(const EdgeSteps&, const EdgeSteps&) = default;
};

struct DrawnTile {
    TileId tile;
    EdgeSteps edges;
    bool stands_in = false;  ///< for tiles below it that are not resident
};

/// The parts of a frame's cut. Kept from frame to frame for the memory of its marks alone.
class CutBuilder {
public:
    explicit CutBuilder(const TileCatalogue& catalogue)
        : catalogue_(catalogue), marks_(catalogue.pyramid().count(), 0) {}

    /// Covers the ground of the tree's leaves: a node that splits by its children where all of
    /// those can be covered, else by itself. Only `resident(tile)` is drawn, the root always is.
    /// Then tiles with a neighbour more than kMostCoarser levels coarser give way to an ancestor.
    template <typename Resident>
    [[nodiscard]] std::vector<DrawnTile> build(const TileTree& tree, const Resident& resident) {
        state_.assign(tree.nodes.size(), State::open);
        // Children come after their parents, so backwards all children are known. A node that splits
        // and has no child in view covers nothing, and needs nothing.
        for (int i = int(tree.nodes.size()) - 1; i >= 0; --i) {
            const TreeNode& node = tree.nodes[std::size_t(i)];
            bool by_children = !tree.is_leaf(node);
            for (int c = 0; c < node.child_count; ++c) {
                by_children =
                    by_children && state_[std::size_t(node.first_child + c)] != State::uncovered;
            }
            state_[std::size_t(i)] = by_children                             ? State::open
                                     : node.parent < 0 || resident(node.tile) ? State::itself
                                                                              : State::uncovered;
        }
        while (conform(tree, resident)) {
        }
        std::vector<DrawnTile> drawn;
        mark_drawn(tree);
        for_each_drawn(tree, [&](int node) {
            const TreeNode& known = tree.nodes[std::size_t(node)];
            drawn.push_back({known.tile, edges_of(known.tile), !tree.is_leaf(known)});
        });
        return drawn;
    }

private:
    enum class State : std::uint8_t {
        open,       ///< drawn by its children
        itself,     ///< drawn, unless a node above it is
        uncovered,  ///< not resident, and not all of its children covered
    };

    template <typename Visit>
    void for_each_drawn(const TileTree& tree, const Visit& visit) {
        stack_.clear();
        if (!tree.nodes.empty()) stack_.push_back(0);
        while (!stack_.empty()) {
            const int i = stack_.back();
            stack_.pop_back();
            if (state_[std::size_t(i)] == State::itself) {
                visit(i);
                continue;
            }
            const TreeNode& node = tree.nodes[std::size_t(i)];
            for (int c = node.child_count - 1; c >= 0; --c) stack_.push_back(node.first_child + c);
        }
    }

    void mark_drawn(const TileTree& tree) {
        ++mark_;
        for_each_drawn(tree, [&](int node) {
            marks_[catalogue_.index(tree.nodes[std::size_t(node)].tile)] = mark_;
        });
    }

    /// Across the edges of a drawn tile: the tile of its own level there, or the ancestor of that
    /// which is drawn.
    [[nodiscard]] EdgeSteps edges_of(const TileId& tile) const {
        constexpr std::array<std::array<int, 2>, 4> kAcross = {{{-1, 0}, {0, -1}, {0, 1}, {1, 0}}};
        EdgeSteps steps;
        for (std::size_t edge = 0; edge < kAcross.size(); ++edge) {
            TileId other{tile.level, tile.row + kAcross[edge][0], tile.column + kAcross[edge][1]};
            if (!catalogue_.pyramid().contains(other)) continue;
            for (; catalogue_.pyramid().contains(other);
                 other = {other.level + 1, other.row / 2, other.column / 2}) {
                if (marks_[catalogue_.index(other)] == mark_) {
                    steps.coarser[edge] = other.level - tile.level;
                    break;
                }
            }
        }
        return steps;
    }

    /// Whether something had to give way. Each time a tile goes that an ancestor replaces, so it
    /// ends, at the root at the latest.
    template <typename Resident>
    bool conform(const TileTree& tree, const Resident& resident) {
        mark_drawn(tree);
        bool changed = false;
        for_each_drawn(tree, [&](int node) { too_fine_.push_back(node); });
        std::erase_if(too_fine_, [&](int node) {
            return std::ranges::max(edges_of(tree.nodes[std::size_t(node)].tile).coarser) <=
                   kMostCoarser;
        });
        for (const int node : too_fine_) {
            const TileId& tile = tree.nodes[std::size_t(node)].tile;
            const int level =
                tile.level + std::ranges::max(edges_of(tile).coarser) - kMostCoarser;
            int above = tree.nodes[std::size_t(node)].parent;
            while (tree.nodes[std::size_t(above)].parent >= 0 &&
                   (tree.nodes[std::size_t(above)].tile.level < level ||
                    !resident(tree.nodes[std::size_t(above)].tile))) {
                above = tree.nodes[std::size_t(above)].parent;
            }
            state_[std::size_t(above)] = State::itself;
            changed = true;
        }
        too_fine_.clear();
        return changed;
    }

    const TileCatalogue& catalogue_;
    std::vector<std::uint32_t> marks_;  ///< by index: of the build that last drew the tile
    std::uint32_t mark_ = 0;
    std::vector<State> state_;  ///< by node
    std::vector<int> stack_, too_fine_;
};

}  // namespace lodbench::tile_quadtree
