#include "picture/legend.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "picture/text.h"

namespace lodbench::picture {
namespace {

constexpr int kSignGap = 6;

}  // namespace

void cased_line(Canvas& canvas, const glm::dvec2& from, const glm::dvec2& to) {
    canvas.line(from, to, 4, kPaper);
    canvas.line(from, to, 1.5, kInk);
}

void cased_outline(Canvas& canvas, const std::vector<glm::dvec2>& closed) {
    // The casing of all edges first: it would cut the ink of the edge before.
    for (const auto& [width, color] : {std::pair(4.0, kPaper), std::pair(1.5, kInk)}) {
        for (std::size_t i = 0; i < closed.size(); ++i) {
            canvas.line(closed[i], closed[(i + 1) % closed.size()], width, color);
        }
    }
}

void cased_arrow(Canvas& canvas, const glm::dvec2& tail, const glm::dvec2& tip) {
    const glm::dvec2 along = glm::normalize(tip - tail);
    const glm::dvec2 across(-along.y, along.x);
    const glm::dvec2 left = tip - 8.0 * along + 5.0 * across;
    const glm::dvec2 right = tip - 8.0 * along - 5.0 * across;
    for (const auto& [width, color] : {std::pair(5.0, kPaper), std::pair(2.0, kInk)}) {
        canvas.line(tail, tip, width, color);
        canvas.line(left, tip, width, color);
        canvas.line(right, tip, width, color);
    }
}

void cased_ring(Canvas& canvas, const glm::dvec2& centre, double radius) {
    canvas.ring(centre, radius, 4, kInk);
    canvas.ring(centre, radius, 2, kPaper);
}

LegendEntry color_entry(Rgb color, std::string text) {
    return {[color](Canvas& canvas, const glm::dvec2& at) {
                const Rect square{int(at.x), int(at.y), kSwatchSize, kSwatchSize};
                canvas.fill(square, color);
                canvas.frame(square, kFrameColor);
            },
            std::move(text)};
}

LegendEntry ring_entry(std::string text) {
    return {[](Canvas& canvas, const glm::dvec2& at) {
                cased_ring(canvas, at + kSwatchSize / 2.0, kSwatchSize / 2.0 - 1);
            },
            std::move(text)};
}

Legend::Legend(std::vector<LegendEntry> entries, int width) : entries_(std::move(entries)) {
    constexpr int kGap = 18;
    constexpr int kLineHeight = kSmallSize + 2 * kLineSpace;
    glm::ivec2 place(0);
    for (const LegendEntry& entry : entries_) {
        const int wide =
            kSwatchSize + kSignGap + int(std::ceil(text_width(entry.text, kSmallSize)));
        if (place.x > 0 && place.x + wide > width) place = {0, place.y + kLineHeight};
        places_.push_back(place);
        place.x += wide + kGap;
    }
    height_ = place.y + kLineHeight;
}

void Legend::draw(Canvas& canvas, int x, int y) const {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const glm::dvec2 at = glm::dvec2(places_[i] + glm::ivec2(x, y));
        entries_[i].sign(canvas, at);
        canvas.text(at.x + kSwatchSize + kSignGap, at.y + (kSwatchSize - kSmallSize) / 2.0,
                    kSmallSize, kInk, entries_[i].text);
    }
}

}  // namespace lodbench::picture
