#pragma once
// A PNG looked over before libpng sees it: libpng writes its own words to stderr when a file is
// damaged.

#include <cstdint>
#include <filesystem>

namespace lodbench::terrain {

struct PngHeader {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    int bit_depth = 0;  ///< 1, 2, 4, 8 or 16
};

/// Walks over all chunks (PNG, second edition, chapters 5 and 11.2.2): signature, header first and
/// sane, every chunk whole and of the checksum that it carries, up to the end chunk. Throws
/// InputError.
[[nodiscard]] PngHeader check_png(const std::filesystem::path& file);

}  // namespace lodbench::terrain
