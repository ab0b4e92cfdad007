#pragma once
// From the tree to the tiles that are drawn: covered by what is resident, and joined without gaps.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "tile_quadtree/tile_tree.h"

namespace lodbench::tile_quadtree {

/// Neighbours have vertices at most this many levels coarser: 64 cells are then one step of theirs
/// or more, so that no corner of a tile lies between two of their vertices.
inline constexpr int kMostCoarser = 6;

/// How many levels coarser than the tile's level the vertices across an edge are; 0 where they are
/// not, or where nothing is drawn.
struct EdgeSteps {
    std::array<int, 4> coarser{};  ///< north, west, east, south
    friend bool operator==(const EdgeSteps&, const EdgeSteps&) = default;
};

/// The ground of a tile, drawn from its own samples, or from those of an ancestor while it is not
/// resident: then every 2^coarsened-th vertex of it.
struct DrawnTile {
    TileId tile;
    int coarsened = 0;  ///< levels from the tile up to the one whose samples are drawn
    EdgeSteps edges;
    bool stands_in = false;  ///< what is drawn is coarser than the tree asks for

    /// The tile whose samples are drawn.
    [[nodiscard]] TileId source() const {
        return {tile.level + coarsened, tile.row >> coarsened, tile.column >> coarsened};
    }
};

/// The parts of a frame's cut. Kept from frame to frame for the memory of its marks alone.
class CutBuilder {
public:
    explicit CutBuilder(const TileCatalogue& catalogue)
        : catalogue_(catalogue), marks_(catalogue.pyramid().count()) {}

    /// Covers the ground of the tree's leaves once, each from the samples of its nearest ancestor
    /// that is `resident(tile)`, itself for a start; the root always is. A tile stands for its
    /// children where none of them is resident, or one is too far below what is. Then tiles with a
    /// neighbour more than kMostCoarser levels coarser give way to an ancestor.
    template <typename Resident>
    [[nodiscard]] std::vector<DrawnTile> build(const TileTree& tree, const Resident& resident) {
        state_.assign(tree.nodes.size(), State::open);
        coarsened_.assign(tree.nodes.size(), 0);
        // Parents come before their children: downward for what is resident above ...
        for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
            const TreeNode& node = tree.nodes[i];
            if (node.parent >= 0 && !resident(node.tile)) {
                coarsened_[i] = coarsened_[std::size_t(node.parent)] + 1;
            }
        }
        // ... and upward for what its children cover. A node that splits and has no child in view
        // covers nothing, and needs nothing.
        for (int i = int(tree.nodes.size()) - 1; i >= 0; --i) {
            const TreeNode& node = tree.nodes[std::size_t(i)];
            bool all_covered = !tree.is_leaf(node);
            bool some_resident = node.child_count == 0;
            for (int c = 0; c < node.child_count; ++c) {
                const std::size_t child = std::size_t(node.first_child + c);
                all_covered = all_covered && state_[child] != State::uncovered;
                some_resident =
                    some_resident || state_[child] == State::open || coarsened_[child] == 0;
            }
            state_[std::size_t(i)] = all_covered && some_resident ? State::open
                                     : coarsened_[std::size_t(i)] <= kMostCoarser
                                         ? State::itself
                                         : State::uncovered;
        }
        while (conform(tree)) {
        }
        std::vector<DrawnTile> drawn;
        mark_drawn(tree);
        for_each_drawn(tree, [&](int node) {
            const TreeNode& known = tree.nodes[std::size_t(node)];
            const int coarsened = coarsened_[std::size_t(node)];
            drawn.push_back({known.tile, coarsened, edges_of(known.tile),
                             coarsened > 0 || !tree.is_leaf(known)});
        });
        return drawn;
    }

private:
    enum class State : std::uint8_t {
        open,       ///< drawn by its children
        itself,     ///< drawn, unless a node above it is
        uncovered,  ///< too far below what is resident
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

    /// Edges in the order of EdgeSteps; the opposite of edge e is 3 - e.
    static constexpr std::array<std::array<int, 2>, 4> kAcross = {
        {{-1, 0}, {0, -1}, {0, 1}, {1, 0}}};

    struct Mark {
        std::uint32_t build = 0;  ///< that last drew the tile
        /// Of the vertices along each edge: theirs is the coarsest level that is drawn on any side.
        std::array<std::uint8_t, 4> edge_level{};
    };
    [[nodiscard]] bool is_drawn(const TileId& tile) const {
        return marks_[catalogue_.index(tile)].build == mark_;
    }

    /// The level along a line that tiles share is kept by the largest of them; of two equal ones,
    /// which have the line for themselves, by the other.
    std::uint8_t& edge_level(const TileId& tile, std::size_t edge) {
        TileId other{tile.level, tile.row + kAcross[edge][0], tile.column + kAcross[edge][1]};
        for (; catalogue_.pyramid().contains(other);
             other = {other.level + 1, other.row / 2, other.column / 2}) {
            if (is_drawn(other)) return marks_[catalogue_.index(other)].edge_level[3 - edge];
        }
        return marks_[catalogue_.index(tile)].edge_level[edge];
    }

    void mark_drawn(const TileTree& tree) {
        ++mark_;
        const auto tile_of = [&](int node) { return tree.nodes[std::size_t(node)].tile; };
        const auto level_of = [&](int node) {
            return std::uint8_t(tile_of(node).level + coarsened_[std::size_t(node)]);
        };
        for_each_drawn(tree, [&](int node) {
            Mark& mark = marks_[catalogue_.index(tile_of(node))];
            mark.build = mark_;
            mark.edge_level.fill(level_of(node));
        });
        for_each_drawn(tree, [&](int node) {
            for (std::size_t edge = 0; edge < 4; ++edge) {
                std::uint8_t& shared = edge_level(tile_of(node), edge);
                shared = std::max(shared, level_of(node));
            }
        });
    }

    [[nodiscard]] EdgeSteps edges_of(const TileId& tile) {
        EdgeSteps steps;
        for (std::size_t edge = 0; edge < 4; ++edge) {
            steps.coarser[edge] = edge_level(tile, edge) - tile.level;
        }
        return steps;
    }

    /// Whether something had to give way. Each time a tile goes that an ancestor replaces, so it
    /// ends, at the root at the latest.
    bool conform(const TileTree& tree) {
        mark_drawn(tree);
        bool changed = false;
        // Those that go are still marked, so that all are judged alike.
        for_each_drawn(tree, [&](int node) { candidates_.push_back(node); });
        for (const int node : candidates_) {
            const TileId& tile = tree.nodes[std::size_t(node)].tile;
            const int too_fine = std::ranges::max(edges_of(tile).coarser) - kMostCoarser;
            if (too_fine <= 0) continue;
            int above = node;
            do {
                above = tree.nodes[std::size_t(above)].parent;
            } while (tree.nodes[std::size_t(above)].parent >= 0 &&
                     (tree.nodes[std::size_t(above)].tile.level < tile.level + too_fine ||
                      coarsened_[std::size_t(above)] > kMostCoarser));
            state_[std::size_t(above)] = State::itself;
            changed = true;
        }
        candidates_.clear();
        return changed;
    }

    const TileCatalogue& catalogue_;
    std::vector<Mark> marks_;  ///< by index
    std::uint32_t mark_ = 0;
    std::vector<State> state_;    ///< by node
    std::vector<int> coarsened_;  ///< by node
    std::vector<int> stack_, candidates_;
};

}  // namespace lodbench::tile_quadtree
