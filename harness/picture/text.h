#pragma once
// Text as pixels: UTF-8 in DejaVu Sans, which is built into the program, so that no font has to be
// installed where it runs. Left to right, without shaping. What is not UTF-8 and control characters
// become U+FFFD; what the font lacks becomes its empty box.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lodbench::picture {

/// A glyph in place: its coverage (0..255), row by row, of the pixels from (x, y) on.
struct PlacedGlyph {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> coverage;
};

/// The glyphs of one line whose top left corner is at (x, y), in pixels; `size` is the height from
/// the highest ascender to the lowest descender, > 0.
[[nodiscard]] std::vector<PlacedGlyph> glyphs(std::string_view text, double x, double y,
                                              double size);

/// Pixels that one line takes up.
[[nodiscard]] double text_width(std::string_view text, double size);

/// Lines no wider than `width`, broken at spaces, or where a word is wider than that, within it;
/// and at line feeds. A line has one character at least. What is beyond `max_lines` (>= 1) is cut,
/// and the last line then ends in an ellipsis.
[[nodiscard]] std::vector<std::string> wrap_text(std::string_view text, double size, double width,
                                                 std::size_t max_lines);

}  // namespace lodbench::picture
