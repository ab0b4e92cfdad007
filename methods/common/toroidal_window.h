#pragma once
// Which samples of one level a square window of texels holds, where the window follows the viewer
// by wrapping around: a sample's texel is its column and row modulo the window's size, so that a
// move rewrites only what comes in. F. Losasso, H. Hoppe: Geometry Clipmaps (2004), section 4; an
// L-shape where both coordinates move. The bookkeeping alone: whoever owns the texels writes them.

#include <algorithm>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "api/error.h"

namespace lodbench::common {

/// Samples [low, high) of one level. x: columns eastward, y: rows southward, in steps of the level;
/// they may lie outside of the grid.
struct LevelRect {
    glm::ivec2 low{0}, high{0};

    [[nodiscard]] glm::ivec2 size() const { return glm::max(high - low, glm::ivec2(0)); }
    [[nodiscard]] bool empty() const { return low.x >= high.x || low.y >= high.y; }
    [[nodiscard]] std::int64_t area() const { return std::int64_t(size().x) * size().y; }
    /// An empty rectangle is part of any.
    [[nodiscard]] bool contains(const LevelRect& other) const {
        return other.empty() || (other.low.x >= low.x && other.low.y >= low.y &&
                                 other.high.x <= high.x && other.high.y <= high.y);
    }
    friend bool operator==(const LevelRect&, const LevelRect&) = default;
};

/// What both hold; of size 0 where they have nothing in common.
[[nodiscard]] inline LevelRect intersection(const LevelRect& a, const LevelRect& b) {
    const glm::ivec2 low = glm::max(a.low, b.low), high = glm::min(a.high, b.high);
    return low.x < high.x && low.y < high.y ? LevelRect{low, high} : LevelRect{};
}

/// A rectangle of samples whose texels are a rectangle too: it does not wrap around.
struct WindowPiece {
    LevelRect samples;
    glm::ivec2 texel{0};  ///< of samples.low, in the texture
};

/// One window: N x N texels, from texel `corner` of its texture on.
class ToroidalWindow {
public:
    static constexpr int kAllLines = std::numeric_limits<int>::max();

    /// `samples` >= 1 along an edge. Throws ContractError for less.
    explicit ToroidalWindow(int samples, glm::ivec2 corner = glm::ivec2(0))
        : samples_(samples), corner_(corner) {
        if (samples < 1) throw ContractError("ToroidalWindow: fewer than one sample along an edge");
        move_to(glm::ivec2(0));
    }

    [[nodiscard]] int samples() const { return samples_; }
    /// What the window is to hold.
    [[nodiscard]] const LevelRect& target() const { return target_; }
    /// What it holds: a part of the target, which grows by strips; empty at first.
    [[nodiscard]] const LevelRect& held() const { return held_; }
    [[nodiscard]] bool complete() const { return held_ == target_; }
    [[nodiscard]] bool holds(const LevelRect& samples) const { return held_.contains(samples); }

    /// The window is to hold the N x N samples from `origin` on (north-west). What it holds of them
    /// stays; nothing is held any more of the rest.
    void move_to(glm::ivec2 origin) {
        target_ = {origin, origin + samples_};
        held_ = intersection(held_, target_);
    }
    /// Nothing is held any more.
    void forget() { held_ = {}; }

    /// What to write next: at most `most_lines` (>= 1) whole columns or rows beside what is held,
    /// or rows from the north where nothing is held. Nothing where the window is complete. Columns
    /// come first, as long as what is held; then rows, of the window's full width: after a move of
    /// a complete window two strips, the L.
    [[nodiscard]] std::optional<LevelRect> next_strip(int most_lines = kAllLines) const {
        if (complete()) return std::nullopt;
        if (held_.empty()) {
            const int lines = std::min(most_lines, samples_);
            return LevelRect{target_.low, {target_.high.x, target_.low.y + lines}};
        }
        for (const int axis : {0, 1}) {
            LevelRect strip = held_;
            if (held_.low[axis] > target_.low[axis]) {
                const int lines = std::min(most_lines, held_.low[axis] - target_.low[axis]);
                strip.low[axis] = held_.low[axis] - lines;
                strip.high[axis] = held_.low[axis];
                return strip;
            }
            if (held_.high[axis] < target_.high[axis]) {
                const int lines = std::min(most_lines, target_.high[axis] - held_.high[axis]);
                strip.low[axis] = held_.high[axis];
                strip.high[axis] = held_.high[axis] + lines;
                return strip;
            }
        }
        return std::nullopt;
    }

    /// The strip has been written. Throws ContractError unless it is one that `next_strip` gives
    /// for some number of lines.
    void fill(const LevelRect& strip) {
        if (strip.empty() || next_strip(lines_of(strip)) != strip) {
            throw ContractError("ToroidalWindow: filled with a strip that is not the next one");
        }
        held_ = held_.empty()
                    ? strip
                    : LevelRect{glm::min(held_.low, strip.low), glm::max(held_.high, strip.high)};
    }

    /// Fills at most `most_lines` columns and rows, calling `write(const WindowPiece&)` for each
    /// piece; returns the lines filled. kAllLines completes the window.
    template <typename Write>
    int advance(int most_lines, Write&& write) {
        int lines = 0;
        while (lines < most_lines) {
            const std::optional<LevelRect> strip = next_strip(most_lines - lines);
            if (!strip) break;
            for (const WindowPiece& piece : pieces(*strip)) write(piece);
            lines += lines_of(*strip);
            fill(*strip);
        }
        return lines;
    }

    /// Columns or rows that a strip adds to what is held.
    [[nodiscard]] int lines_of(const LevelRect& strip) const {
        return held_.empty() || held_.size().x == samples_ ? strip.size().y : strip.size().x;
    }

    /// Where a sample's texel lies in the texture.
    [[nodiscard]] glm::ivec2 texel(glm::ivec2 sample) const {
        return corner_ + glm::ivec2(wrapped(sample.x), wrapped(sample.y));
    }

    /// The rectangle cut where the window wraps around: at most four pieces. At most N samples
    /// along an edge, else ContractError.
    [[nodiscard]] std::vector<WindowPiece> pieces(const LevelRect& samples) const {
        if (samples.size().x > samples_ || samples.size().y > samples_) {
            throw ContractError("ToroidalWindow: a rectangle larger than the window");
        }
        std::vector<WindowPiece> found;
        for (int y = samples.low.y; y < samples.high.y;) {
            const int south = std::min(samples.high.y, y + samples_ - wrapped(y));
            for (int x = samples.low.x; x < samples.high.x;) {
                const int east = std::min(samples.high.x, x + samples_ - wrapped(x));
                found.push_back({{{x, y}, {east, south}}, texel({x, y})});
                x = east;
            }
            y = south;
        }
        return found;
    }

private:
    [[nodiscard]] int wrapped(int coordinate) const {
        const int rest = coordinate % samples_;
        return rest < 0 ? rest + samples_ : rest;
    }

    int samples_;
    glm::ivec2 corner_;
    LevelRect target_, held_;
};

}  // namespace lodbench::common
