#include "picture/text.h"

#include <stb_truetype.h>

#include <algorithm>
#include <cmath>

#include "api/error.h"

// The font's file as it is, between two labels: an array literal of its 750 kB takes a compiler
// seconds.
asm(R"(
    .pushsection .rodata
    .balign 16
    .globl lodbench_font
    .hidden lodbench_font
lodbench_font:
    .incbin ")" LODBENCH_FONT R"("
    .popsection
)");
extern "C" const unsigned char lodbench_font[];  // NOLINT(readability-identifier-naming)

namespace lodbench::picture {
namespace {

constexpr char32_t kReplacement = 0xFFFD;
constexpr std::string_view kEllipsis = "…";

const stbtt_fontinfo& font() {
    static const stbtt_fontinfo info = [] {
        stbtt_fontinfo result;
        if (stbtt_InitFont(&result, lodbench_font, 0) == 0) {
            throw ContractError("text: " LODBENCH_FONT " is not a TrueType font");
        }
        return result;
    }();
    return info;
}

/// Takes one character off the front of `text`, which is not empty; one byte where it is not UTF-8.
char32_t take_character(std::string_view& text) {
    const auto byte = [&](std::size_t i) { return std::uint8_t(text[i]); };
    const std::uint8_t lead = byte(0);
    const std::size_t length = lead < 0x80   ? 1
                               : lead < 0xC0 ? 0
                               : lead < 0xE0 ? 2
                               : lead < 0xF0 ? 3
                                             : 4;
    char32_t code = lead < 0x80 ? lead : lead & (0xFF >> (length + 1));
    bool valid = length > 0 && length <= text.size() && lead < 0xF8;
    for (std::size_t i = 1; valid && i < length; ++i) {
        valid = (byte(i) & 0xC0) == 0x80;
        code = (code << 6) | (byte(i) & 0x3F);
    }
    constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    valid = valid && code >= kLeast[length] && code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF);
    text.remove_prefix(valid ? length : 1);
    if (code == '\t') return ' ';
    return valid && code >= 0x20 && code != 0x7F ? code : kReplacement;
}

double scale_of(double size) {
    return stbtt_ScaleForPixelHeight(&font(), float(size));
}

double advance(char32_t character, double scale) {
    int width = 0;
    stbtt_GetCodepointHMetrics(&font(), int(character), &width, nullptr);
    return width * scale;
}

}  // namespace

std::vector<PlacedGlyph> glyphs(std::string_view text, double x, double y, double size) {
    const double scale = scale_of(size);
    int ascent = 0;
    stbtt_GetFontVMetrics(&font(), &ascent, nullptr, nullptr);
    const double baseline = std::round(y + ascent * scale);
    std::vector<PlacedGlyph> result;
    while (!text.empty()) {
        const char32_t character = take_character(text);
        const float part = float(x - std::floor(x));
        int left = 0;
        int top = 0;
        int right = 0;
        int bottom = 0;
        stbtt_GetCodepointBitmapBoxSubpixel(&font(), int(character), float(scale), float(scale),
                                            part, 0, &left, &top, &right, &bottom);
        PlacedGlyph glyph{
            int(std::floor(x)) + left, int(baseline) + top, right - left, bottom - top, {}};
        if (glyph.width > 0 && glyph.height > 0) {
            glyph.coverage.resize(std::size_t(glyph.width) * glyph.height);
            stbtt_MakeCodepointBitmapSubpixel(&font(), glyph.coverage.data(), glyph.width,
                                              glyph.height, glyph.width, float(scale), float(scale),
                                              part, 0, int(character));
            result.push_back(std::move(glyph));
        }
        x += advance(character, scale);
    }
    return result;
}

double text_width(std::string_view text, double size) {
    const double scale = scale_of(size);
    double width = 0;
    while (!text.empty()) width += advance(take_character(text), scale);
    return width;
}

std::vector<std::string> wrap_text(std::string_view text, double size, double width,
                                   std::size_t max_lines) {
    const double scale = scale_of(size);
    const double ellipsis_width = text_width(kEllipsis, size);
    std::vector<std::string> lines;
    while (!text.empty()) {
        std::string_view rest = text;
        double used = 0;
        std::size_t taken = 0;              // bytes that fit
        std::size_t taken_by_word = 0;      // up to the last space among them
        std::size_t taken_by_ellipsis = 0;  // that leave room for an ellipsis
        while (!rest.empty() && rest.front() != '\n') {
            std::string_view after = rest;
            used += advance(take_character(after), scale);
            if (used > width && taken > 0) break;
            if (rest.front() == ' ') taken_by_word = taken;
            taken = text.size() - after.size();
            if (used + ellipsis_width <= width) taken_by_ellipsis = taken;
            rest = after;
        }
        const bool whole = rest.empty() || rest.front() == '\n';
        if (!whole && rest.front() != ' ' && taken_by_word > 0) taken = taken_by_word;
        std::string_view left = text.substr(taken);
        if (whole && !left.empty()) left.remove_prefix(1);
        while (!whole && !left.empty() && left.front() == ' ') left.remove_prefix(1);
        if (lines.size() + 1 == max_lines && !left.empty()) {
            lines.emplace_back(text.substr(0, taken_by_ellipsis)).append(kEllipsis);
            break;
        }
        lines.emplace_back(text.substr(0, taken));
        text = left;
    }
    return lines;
}

}  // namespace lodbench::picture
