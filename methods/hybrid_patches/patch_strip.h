#pragma once
// The triangulation of one patch as a generalised triangle strip.
//
// Source: Loeffler et al. 2010, section 4.2, after Lindstrom & Pascucci 2002, figure 4: as in
// common/leb_strip.h, for one triangle instead of four. Vertices are named within the patch: a on
// the way from its apex to `left`, b on that to `right`, in units of 1 / K; a + b <= K, and the
// name is a (K + 1) + b. Names depend on neither place nor size nor orientation and fit into 16
// bits up to K = 64.

#include <cstdint>
#include <span>
#include <vector>

#include "hybrid_patches/patch_hierarchy.h"

namespace lodbench::hybrid_patches {

inline constexpr int kMostSegments = 64;

/// The names that a strip needs: a linear function of row and column.
class PatchNames {
public:
    PatchNames(const Triangle& t, int segments) : apex_(t.apex) {
        // The legs are perpendicular and equally long: a = K (p - apex) . left / |left|^2, and so
        // b.
        const double left_row = t.left.row - t.apex.row;
        const double left_column = t.left.column - t.apex.column;
        const double right_row = t.right.row - t.apex.row;
        const double right_column = t.right.column - t.apex.column;
        // A power of two: exact.
        const double scale = segments / (left_row * left_row + left_column * left_column);
        by_row_ = (left_row * (segments + 1) + right_row) * scale;
        by_column_ = (left_column * (segments + 1) + right_column) * scale;
    }
    [[nodiscard]] std::uint16_t of(int row, int column) const {
        return std::uint16_t(
            int((row - apex_.row) * by_row_ + (column - apex_.column) * by_column_));
    }

private:
    Sample apex_;
    double by_row_, by_column_;
};

/// `Test` has `bool active(int row, int column)`, asked once from each triangle that the sample
/// splits. The strip's memory is kept for the next one.
template <typename Test>
class PatchStripBuilder {
public:
    explicit PatchStripBuilder(std::vector<std::uint16_t>& buffer) : buffer_(buffer) {}

    /// The strip of a patch with up to `levels` bisections; faces up. Returns the number of
    /// triangles, swaps not counted.
    std::size_t build(const Triangle& patch, int segments, int levels, Test& test) {
        const PatchNames names(patch, segments);
        names_ = &names;
        test_ = &test;
        // 2^levels triangles are left at most, twice as many are visited; each adds a vertex and a
        // swap.
        buffer_.resize((std::size_t(4) << levels) + 4);
        out_ = buffer_.data();
        triangles_ = 1;
        const Sample middle = patch.middle();
        // Twice: so the first triangle faces up, and there are two to compare with.
        const std::uint16_t start = names.of(patch.left.row, patch.left.column);
        *out_++ = start;
        *out_++ = start;
        odd_ = false;
        child<true>(middle.row, middle.column, patch.apex.row - middle.row,
                    patch.apex.column - middle.column, levels);
        append<false>(names.of(patch.right.row, patch.right.column));
        buffer_.resize(std::size_t(out_ - buffer_.data()));
        return triangles_;
    }

private:
    template <bool odd>
    void append(std::uint16_t vertex) {
        if (vertex == out_[-1] || vertex == out_[-2]) return;
        if (odd_ == odd) {
            *out_ = out_[-2];
            ++out_;
        }
        odd_ = odd;
        *out_++ = vertex;
    }

    /// The triangle whose longest edge has its middle at (row, column); its apex lies
    /// (apex_row, apex_column) from there.
    template <bool odd>
    void child(int row, int column, int apex_row, int apex_column, int levels) {
        const std::uint16_t apex = names_->of(row + apex_row, column + apex_column);
        if (levels == 0 || !test_->active(row, column)) {
            append<odd>(apex);
            return;
        }
        ++triangles_;
        // From the middle to the end at which the path enters: a quarter turn, whose sense
        // alternates from level to level.
        const int start_row = odd ? -apex_column : apex_column;
        const int start_column = odd ? apex_row : -apex_row;
        const int first_row = (apex_row + start_row) / 2;
        const int first_column = (apex_column + start_column) / 2;
        const int second_row = (apex_row - start_row) / 2;
        const int second_column = (apex_column - start_column) / 2;
        child<!odd>(row + first_row, column + first_column, -first_row, -first_column, levels - 1);
        append<odd>(apex);
        child<!odd>(row + second_row, column + second_column, -second_row, -second_column,
                    levels - 1);
    }

    std::vector<std::uint16_t>& buffer_;
    const PatchNames* names_ = nullptr;
    Test* test_ = nullptr;
    std::uint16_t* out_ = nullptr;
    std::size_t triangles_ = 0;
    bool odd_ = false;  ///< colour of the strip's last vertex
};

}  // namespace lodbench::hybrid_patches
