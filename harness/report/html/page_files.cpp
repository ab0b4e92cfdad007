#include "report/html/page_files.h"

#include <array>
#include <cstdint>

#include "report/html/text.h"

#define LODBENCH_EMBED(name, file) \
    asm(".pushsection .rodata\n"   \
        ".hidden lodbench_" name   \
        "\n"                       \
        ".hidden lodbench_" name   \
        "_end\n"                   \
        ".globl lodbench_" name    \
        "\n"                       \
        ".globl lodbench_" name    \
        "_end\n"                   \
        "lodbench_" name           \
        ":\n"                      \
        ".incbin \"" file          \
        "\"\n"                     \
        "lodbench_" name           \
        "_end:\n"                  \
        ".byte 0\n"                \
        ".popsection\n")

LODBENCH_EMBED("page_css", LODBENCH_PAGE_CSS);
LODBENCH_EMBED("page_js", LODBENCH_PAGE_JS);
// NOLINTBEGIN(readability-identifier-naming)
extern "C" {
extern const char lodbench_page_css[], lodbench_page_css_end[];
extern const char lodbench_page_js[], lodbench_page_js_end[];
}
// NOLINTEND(readability-identifier-naming)

namespace lodbench::report::html {

namespace {

/// From hexadecimal, as CMake says it, to base 64, as the policy wants it.
std::string policy_hash(std::string_view hexadecimal) {
    std::array<std::uint8_t, 32> bytes{};
    const auto digit = [&](std::size_t i) {
        const char c = hexadecimal[i];
        return unsigned(c <= '9' ? c - '0' : c - 'a' + 10);
    };
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        bytes[i] = std::uint8_t(digit(2 * i) << 4 | digit(2 * i + 1));
    }
    return "sha256-" + base64(bytes);
}

std::string_view between(const char* begin, const char* end) {
    return {begin, std::size_t(end - begin)};
}

}  // namespace

PageFile page_css() {
    return {between(lodbench_page_css, lodbench_page_css_end),
            policy_hash(LODBENCH_PAGE_CSS_SHA256)};
}

PageFile page_js() {
    return {between(lodbench_page_js, lodbench_page_js_end), policy_hash(LODBENCH_PAGE_JS_SHA256)};
}

}  // namespace lodbench::report::html
