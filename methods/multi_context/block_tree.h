#pragma once
// The blocks activity's traversal: Yusuf, Mostafa, Elarif 2014, section 3.3. No GL.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "api/camera.h"
#include "api/terrain.h"
#include "common/view_frustum.h"
#include "multi_context/block_errors.h"
#include "multi_context/layout.h"

namespace lodbench::multi_context {

struct HeightRange {
    float low = 0, high = 0;
};

/// Lowest and highest sample of every block, all samples of the full resolution counted.
class HeightRanges {
public:
    HeightRanges() = default;
    /// Reads the terrain once, a row of blocks at a time; `on_rows` is given what was read.
    template <typename OnRows>
    HeightRanges(const Terrain& terrain, const Layout& layout, const OnRows& on_rows) {
        const TerrainInfo& info = terrain.info();
        const int cells = layout.block_cells();
        lods_.resize(std::size_t(layout.coarsest()) + 1);
        lods_[0] = Lod((info.rows - 2) / cells + 1, (info.columns - 2) / cells + 1);
        std::vector<float> strip;
        for (int row = 0; row < lods_[0].rows; ++row) {
            const SampleRect rect{row * cells, 0, std::min(cells + 1, info.rows - row * cells),
                                  info.columns};
            strip.resize(std::size_t(rect.rows) * std::size_t(rect.columns));
            terrain.read(rect, strip);
            on_rows(rect, std::span<const float>(strip));
            for (int column = 0; column < lods_[0].columns; ++column) {
                HeightRange& range = lods_[0].at(row, column);
                const int first = column * cells;
                const int count = std::min(cells + 1, info.columns - first);
                range = {strip[std::size_t(first)], strip[std::size_t(first)]};
                for (int r = 0; r < rect.rows; ++r) {
                    const auto begin = strip.begin() + std::ptrdiff_t(r) * rect.columns + first;
                    const auto [low, high] = std::minmax_element(begin, begin + count);
                    range = {std::min(range.low, *low), std::max(range.high, *high)};
                }
            }
        }
        for (std::size_t lod = 1; lod < lods_.size(); ++lod) {
            const Lod& fine = lods_[lod - 1];
            Lod& coarse = lods_[lod];
            coarse = Lod((fine.rows + 1) / 2, (fine.columns + 1) / 2);
            for (int row = 0; row < coarse.rows; ++row) {
                for (int column = 0; column < coarse.columns; ++column) {
                    HeightRange range = fine.at(2 * row, 2 * column);
                    for (int r = 2 * row; r < std::min(2 * row + 2, fine.rows); ++r) {
                        for (int c = 2 * column; c < std::min(2 * column + 2, fine.columns); ++c) {
                            range = {std::min(range.low, fine.at(r, c).low),
                                     std::max(range.high, fine.at(r, c).high)};
                        }
                    }
                    coarse.at(row, column) = range;
                }
            }
        }
    }

    /// False where the block lies wholly in the padding.
    [[nodiscard]] bool exists(int lod, int row, int column) const {
        const Lod& blocks = lods_[std::size_t(lod)];
        return row < blocks.rows && column < blocks.columns;
    }
    [[nodiscard]] HeightRange at(int lod, int row, int column) const {
        return lods_[std::size_t(lod)].at(row, column);
    }
    /// Blocks of LOD 0 on the terrain: no selection has more.
    [[nodiscard]] std::size_t finest_count() const { return lods_[0].ranges.size(); }

private:
    struct Lod {
        Lod() = default;
        Lod(int rows_, int columns_)
            : rows(rows_), columns(columns_), ranges(std::size_t(rows_) * std::size_t(columns_)) {}
        [[nodiscard]] HeightRange& at(int row, int column) {
            return ranges[std::size_t(row) * std::size_t(columns) + std::size_t(column)];
        }
        [[nodiscard]] const HeightRange& at(int row, int column) const {
            return ranges[std::size_t(row) * std::size_t(columns) + std::size_t(column)];
        }
        int rows = 0, columns = 0;
        std::vector<HeightRange> ranges;
    };
    std::vector<Lod> lods_;
};

/// A block that is drawn, by its place among those of its LOD.
struct SelectedBlock {
    int lod = 0, row = 0, column = 0;
    friend bool operator==(const SelectedBlock&, const SelectedBlock&) = default;
};

/// What a traversal found.
struct Selection {
    std::vector<SelectedBlock> blocks;
    std::size_t culled = 0;  ///< blocks out of view, their descendants not counted
};

/// From the root: leaves out what is out of view, before splitting; splits while TBE > delta; a
/// block at LOD 0 is drawn, whatever its error.
class Traversal {
public:
    Traversal(const TerrainInfo& terrain, const Layout& layout, const HeightRanges& ranges,
              const BlockErrors& errors, float delta, const Camera& camera)
        : terrain_(terrain),
          layout_(layout),
          ranges_(ranges),
          errors_(errors),
          delta_(delta),
          frustum_(camera) {}

    void select(Selection& selection) const {
        selection.blocks.clear();
        selection.culled = 0;
        visit({layout_.coarsest(), 0, 0}, selection);
    }

private:
    void visit(const SelectedBlock& block, Selection& selection) const {
        if (!ranges_.exists(block.lod, block.row, block.column)) return;
        if (!may_see(block)) {
            ++selection.culled;
            return;
        }
        if (block.lod == 0 || errors_.at(block.lod, block.row, block.column) <= delta_) {
            selection.blocks.push_back(block);
            return;
        }
        for (int child = 0; child < 4; ++child) {
            visit({block.lod - 1, 2 * block.row + child / 2, 2 * block.column + child % 2},
                  selection);
        }
    }

    [[nodiscard]] bool may_see(const SelectedBlock& block) const {
        const int cells = layout_.block_cells() << block.lod;
        const int row = block.row * cells, column = block.column * cells;
        const glm::dvec2 north_west = terrain_.position(row, column);
        const glm::dvec2 south_east =
            terrain_.position(std::min(row + cells, terrain_.rows - 1),
                              std::min(column + cells, terrain_.columns - 1));
        const HeightRange range = ranges_.at(block.lod, block.row, block.column);
        return frustum_.may_see(
            {{north_west.x, south_east.y, range.low}, {south_east.x, north_west.y, range.high}});
    }

    const TerrainInfo& terrain_;
    const Layout& layout_;
    const HeightRanges& ranges_;
    const BlockErrors& errors_;
    float delta_;
    common::ViewFrustum frustum_;
};

}  // namespace lodbench::multi_context
