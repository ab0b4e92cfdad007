#pragma once
// World files: six lines of text beside an image that say where it lies.

#include <filesystem>
#include <optional>

#include "terrain/raster_reader.h"

namespace lodbench::terrain {

/// The world file of an image: its name with .wld, with the extension's first and last letter and a
/// w (a.tfw for a.tif), or with a w after the extension (a.tifw), in lower or upper case. Nothing
/// where none lies beside it.
[[nodiscard]] std::optional<std::filesystem::path> find_world_file(
    const std::filesystem::path& image);

/// The file beside `image` with its name and `extension` (".prj"), in lower or upper case.
[[nodiscard]] std::optional<std::filesystem::path> find_beside(const std::filesystem::path& image,
                                                               const std::string& extension);

/// `description` of `image` with spacing and origin of its world file, where it has one and says
/// neither itself: metres, unless the numbers look like degrees or a .prj says what they are, which
/// leaves the spacing open and says why. Throws InputError, "FILE: what; remedy", for a world file
/// that is not six numbers, is rotated or runs from south to north or east to west.
[[nodiscard]] RasterDescription with_world_file(const std::filesystem::path& image,
                                                RasterDescription description);

}  // namespace lodbench::terrain
