#pragma once
// What multi-context should select, found another way: each block of LOD 0 looks upward for the
// coarsest block over it that passes. And its errors in double, between two bounds.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "api/camera.h"
#include "api/terrain.h"
#include "multi_context/block_errors.h"
#include "multi_context/layout.h"

namespace lodbench::test {

/// The smallest code that stands for at least `error` pixels >= 0: what error_code.glsl should
/// store.
inline std::uint8_t encode_error(float error, float delta) {
    const float steps = std::ceil(error / delta * float(multi_context::kCodesPerDelta));
    if (!(steps < float(multi_context::kUnboundedCode))) return multi_context::kUnboundedCode;
    int code = int(steps);
    // The quotient is rounded: it may end a step too low.
    if (multi_context::decode_error(std::uint8_t(code), delta) < error) ++code;
    return std::uint8_t(code);
}

/// Heights in double, the border repeated beyond the grid.
class PaddedHeights {
public:
    explicit PaddedHeights(const Terrain& terrain) : info_(terrain.info()) {
        heights_.resize(std::size_t(info_.rows) * std::size_t(info_.columns));
        terrain.read({0, 0, info_.rows, info_.columns}, heights_);
    }
    [[nodiscard]] double at(int row, int column) const {
        return heights_[std::size_t(std::min(row, info_.rows - 1)) * std::size_t(info_.columns) +
                        std::size_t(std::min(column, info_.columns - 1))];
    }
    [[nodiscard]] const TerrainInfo& info() const { return info_; }

private:
    TerrainInfo info_;
    std::vector<float> heights_;
};

/// Whether all eight corners of the block's box lie outside one plane of the frustum.
inline bool out_of_view(const PaddedHeights& heights, const Camera& camera, int cells, int row,
                        int column) {
    const TerrainInfo& info = heights.info();
    const int r1 = std::min((row + 1) * cells, info.rows - 1);
    const int c1 = std::min((column + 1) * cells, info.columns - 1);
    double low = heights.at(row * cells, column * cells), high = low;
    for (int r = row * cells; r <= r1; ++r) {
        for (int c = column * cells; c <= c1; ++c) {
            low = std::min(low, heights.at(r, c));
            high = std::max(high, heights.at(r, c));
        }
    }
    for (const glm::dvec4& plane : camera.frustum_planes()) {
        bool outside = true;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec2 xy =
                info.position(corner & 1 ? r1 : row * cells, corner & 2 ? c1 : column * cells);
            const glm::dvec3 p = glm::dvec3(xy, corner & 4 ? high : low) - camera.position;
            // A box that touches the plane counts as seen, in either rounding.
            outside = outside && glm::dot(glm::dvec3(plane), p) + plane.w < -2e-6 * glm::length(p);
        }
        if (outside) return true;
    }
    return false;
}

/// {lod, row, column} of the blocks that should be drawn. `passes`: TBE <= delta, asked for LOD 1
/// and coarser.
template <typename Passes>
std::set<std::array<int, 3>> search_from_below(const Terrain& terrain,
                                               const multi_context::Layout& layout,
                                               const Camera& camera, const Passes& passes) {
    const PaddedHeights heights(terrain);
    const int k1 = layout.block_cells();
    std::set<std::array<int, 3>> blocks;
    for (int row = 0; row < layout.blocks_along(0); ++row) {
        for (int column = 0; column < layout.blocks_along(0); ++column) {
            if (row * k1 >= heights.info().rows - 1 || column * k1 >= heights.info().columns - 1) {
                continue;
            }
            int chosen = 0;
            for (int lod = layout.coarsest(); lod > 0 && chosen == 0; --lod) {
                if (passes(lod, row >> lod, column >> lod)) chosen = lod;
            }
            bool seen = true;
            for (int lod = layout.coarsest(); lod >= chosen && seen; --lod) {
                seen = !out_of_view(heights, camera, k1 << lod, row >> lod, column >> lod);
            }
            if (seen) blocks.insert({chosen, row >> chosen, column >> chosen});
        }
    }
    return blocks;
}

/// Two bounds that a value computed in float must lie between.
struct Bounds {
    double low = 0, high = 0;
    void take_greater(const Bounds& other) {
        low = std::max(low, other.low);
        high = std::max(high, other.high);
    }
};

/// Equations (1) to (4) in double, with what rounding may do to errors.comp. u = 2^-24 is half a
/// step of float. A sample's position carries up to four roundings of at most its size and a
/// spacing's; a matrix element one; a product of three terms three more: 8 u of the sum of the
/// terms' sizes. The rest is derived line by line below. GLSL lets a division be off by 2.5 steps
/// and a square root by 3: 16 u stands for the products, two divisions and the root behind them.
class ReferenceErrors {
public:
    ReferenceErrors(const Terrain& terrain, const multi_context::Layout& layout,
                    const Camera& camera)
        : heights_(terrain), layout_(layout), camera_(camera), m_(camera.clip_from_relative()) {
        levels_.resize(std::size_t(layout.n()) + 1);
        for (int level = 1; level <= layout.n(); ++level) evaluate(level);
    }
    [[nodiscard]] Bounds group(int level, int row, int column) const {
        return levels_[std::size_t(level)]
                      [std::size_t(row) * std::size_t(layout_.groups_along(level)) +
                       std::size_t(column)];
    }
    [[nodiscard]] Bounds block(int lod, int row, int column) const {
        const int cells = layout_.block_cells();
        Bounds most;
        for (int r = row * cells; r < (row + 1) * cells; ++r) {
            for (int c = column * cells; c < (column + 1) * cells; ++c) {
                most.take_greater(group(lod, r, c));
            }
        }
        return most;
    }

private:
    static constexpr double u = 0x1p-24;

    void evaluate(int level) {
        const int groups = layout_.groups_along(level);
        auto& bounds = levels_[std::size_t(level)];
        bounds.resize(std::size_t(groups) * std::size_t(groups));
        const int h = 1 << (level - 1);
        for (int row = 0; row < groups; ++row) {
            for (int column = 0; column < groups; ++column) {
                const int r = row * 2 * h, c = column * 2 * h;
                Bounds& group_bounds =
                    bounds[std::size_t(row) * std::size_t(groups) + std::size_t(column)];
                const double nw = heights_.at(r, c), ne = heights_.at(r, c + 2 * h);
                const double sw = heights_.at(r + 2 * h, c);
                const double se = heights_.at(r + 2 * h, c + 2 * h);
                group_bounds = screen_error(r, c + h, nw, ne);
                group_bounds.take_greater(screen_error(r + h, c, nw, sw));
                group_bounds.take_greater(screen_error(r + h, c + h, nw, se));
                group_bounds.take_greater(screen_error(r + h, c + 2 * h, ne, se));
                group_bounds.take_greater(screen_error(r + 2 * h, c + h, sw, se));
                if (level == 1) continue;
                for (int child = 0; child < 4; ++child) {
                    group_bounds.take_greater(
                        group(level - 1, 2 * row + child / 2, 2 * column + child % 2));
                }
            }
        }
    }

    [[nodiscard]] Bounds screen_error(int row, int column, double from, double to) const {
        constexpr double kUnbounded = multi_context::kUnbounded;
        const double height = heights_.at(row, column);
        const double d = (from + to) / 2 - height;
        if (d == 0) return {};
        const double d_off =
            u * (std::abs(from - height) + std::abs(to - height)) + u * std::abs(d);
        const TerrainInfo& info = heights_.info();
        const glm::dvec3 p = glm::dvec3(info.position(row, column), height) - camera_.position;
        const glm::dvec3 size(std::abs(p.x) + info.spacing.x, std::abs(p.y) + info.spacing.y,
                              std::abs(p.z));
        double clip[4], off[4];
        for (const int i : {0, 1, 3}) {
            clip[i] = off[i] = 0;
            for (int j = 0; j < 3; ++j) {
                clip[i] += m_[j][i] * p[j];
                off[i] += 8 * u * std::abs(m_[j][i]) * size[j];
            }
        }
        const double w = clip[3], c = m_[2][3];
        const double wi = w + c * d;
        const double wi_off = off[3] + std::abs(c) * d_off + 2 * u * std::abs(c * d) +
                              u * (std::abs(w) + std::abs(c * d));
        const double near = camera_.near_plane, near_off = u * near;
        if (w + off[3] <= near - near_off || wi + wi_off <= near - near_off) {
            // What the shader finds to be no error at all has no projection to lack.
            return {std::abs(d) <= d_off ? 0 : kUnbounded, kUnbounded};
        }
        const double half[2] = {camera_.viewport.width / 2.0, camera_.viewport.height / 2.0};
        double across = 0, across_off = 0;
        for (int i = 0; i < 2; ++i) {
            const double a = m_[2][i];
            const double value = half[i] * (clip[i] * c - w * a);
            const double value_off = half[i] * (std::abs(c) * off[i] + std::abs(a) * off[3] +
                                                4 * u * (std::abs(clip[i] * c) + std::abs(w * a)));
            across += value * value;
            across_off += value_off * value_off;
        }
        across = std::sqrt(across);
        across_off = std::sqrt(across_off);
        Bounds bounds;
        bounds.low = std::max(across - across_off, 0.0) * std::max(std::abs(d) - d_off, 0.0) *
                     (1 - 16 * u) / ((w + off[3]) * (wi + wi_off));
        if (w - off[3] <= near + near_off || wi - wi_off <= near + near_off) {
            bounds.high = kUnbounded;
        } else {
            bounds.high = (across + across_off) * (std::abs(d) + d_off) * (1 + 16 * u) /
                          ((w - off[3]) * (wi - wi_off));
        }
        return bounds;
    }

    PaddedHeights heights_;
    multi_context::Layout layout_;
    Camera camera_;
    glm::dmat4 m_;
    std::vector<std::vector<Bounds>> levels_;
};

}  // namespace lodbench::test
