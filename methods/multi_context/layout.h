#pragma once
// How a terrain is cut into groups and blocks: Yusuf, Mostafa, Elarif 2014, sections 3.1 to 3.3.

#include <algorithm>
#include <bit>
#include <cstddef>

namespace lodbench::multi_context {

/// A grid of (2^n + 1)^2 samples, and blocks of k x k vertices over it. At LOD i neighbouring
/// samples of a block lie 2^i apart, so that it covers (k - 1) 2^i cells a side; LOD 0 is the full
/// resolution. The group of level i at (row, column) covers 2^i cells a side: it is one cell of the
/// block of LOD i that covers it, and what is dropped to make it are the samples 2^(i-1) apart
/// that are not 2^i apart.
class Layout {
public:
    Layout() = default;
    /// The smallest grid that takes in `rows` x `columns` samples and one block of k x k; k - 1 is
    /// a power of two.
    Layout(int rows, int columns, int k) : k_(k) {
        const int cells = std::max({rows, columns, k}) - 1;
        n_ = std::bit_width(unsigned(cells - 1));  // 2^n >= cells
        coarsest_ = n_ - std::countr_zero(unsigned(k - 1));
        for (int lod = 1; lod <= coarsest_; ++lod) {
            first_[lod] = count_;
            count_ += std::size_t(blocks_along(lod)) * std::size_t(blocks_along(lod));
        }
    }

    [[nodiscard]] int n() const { return n_; }
    [[nodiscard]] int k() const { return k_; }
    [[nodiscard]] int block_cells() const { return k_ - 1; }  ///< a side, of the mesh
    [[nodiscard]] int samples() const { return (1 << n_) + 1; }
    /// LOD of the one block that covers everything: the paper's n, less log2(k - 1).
    [[nodiscard]] int coarsest() const { return coarsest_; }
    [[nodiscard]] int blocks_along(int lod) const { return 1 << (coarsest_ - lod); }
    [[nodiscard]] int groups_along(int level) const { return 1 << (n_ - level); }
    /// Row or column of the sample at which the paper keeps a group's error: its centre.
    [[nodiscard]] static int group_centre(int level, int index) {
        return (2 * index + 1) << (level - 1);
    }
    /// Blocks of LOD 1 and coarser, those that have an error: LOD upon LOD from 1, row by row.
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] std::size_t first(int lod) const { return first_[lod]; }
    [[nodiscard]] std::size_t index(int lod, int row, int column) const {
        return first_[lod] + std::size_t(row) * std::size_t(blocks_along(lod)) +
               std::size_t(column);
    }

private:
    int n_ = 0, k_ = 2, coarsest_ = 0;
    std::size_t first_[32] = {};
    std::size_t count_ = 0;
};

}  // namespace lodbench::multi_context
