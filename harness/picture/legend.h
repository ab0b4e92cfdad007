#pragma once
// What the panels of a picture share: paper and ink, shapes that are seen on any colour, legends.

#include <functional>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "picture/canvas.h"

namespace lodbench::picture {

inline constexpr Rgb kPaper = {255, 255, 255};
inline constexpr Rgb kInk = {25, 25, 25};
inline constexpr Rgb kFrameColor = {110, 110, 110};
inline constexpr int kSmallSize = 15;  // pixels, of text
inline constexpr int kLineSpace = 4;
inline constexpr int kSwatchSize = 14;

// Whatever the colours below, ink on paper shows.
void cased_line(Canvas& canvas, const glm::dvec2& from, const glm::dvec2& to);
void cased_outline(Canvas& canvas, const std::vector<glm::dvec2>& closed);
void cased_arrow(Canvas& canvas, const glm::dvec2& tail, const glm::dvec2& tip);
void cased_ring(Canvas& canvas, const glm::dvec2& centre, double radius);

/// A sign, drawn into a square of kSwatchSize pixels from `top_left` on, and what it stands for.
struct LegendEntry {
    std::function<void(Canvas&, const glm::dvec2& top_left)> sign;
    std::string text;
};
[[nodiscard]] LegendEntry color_entry(Rgb color, std::string text);
[[nodiscard]] LegendEntry ring_entry(std::string text);

/// Entries that flow into lines of `width` pixels; one that is wider has a line of its own.
class Legend {
public:
    Legend(std::vector<LegendEntry> entries, int width);
    [[nodiscard]] int height() const { return height_; }
    void draw(Canvas& canvas, int x, int y) const;

private:
    std::vector<LegendEntry> entries_;
    std::vector<glm::ivec2> places_;  // of the signs, from the legend's top left corner
    int height_ = 0;
};

}  // namespace lodbench::picture
