#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "picture/canvas.h"

namespace lodbench::picture {

/// Writes an 8-bit RGB picture, row 0 at the top, width * height * 3 bytes, whole or not at all.
/// Throws EnvironmentError with the file and the system's words.
void write_png(const std::filesystem::path& path, int width, int height,
               std::span<const std::uint8_t> rgb);

/// The picture in a PNG file's bytes as 8-bit RGB; nothing where they are none.
[[nodiscard]] std::optional<Image> read_png(std::span<const std::uint8_t> file);

}  // namespace lodbench::picture
