#pragma once
// A height field as a raw file that reads back to the bit.

#include <filesystem>

#include "terrain/height_field.h"

namespace lodbench::terrain {

/// Writes `file` (extension .raw: float32, little endian, row by row from the north) and its
/// sidecar
/// `<file>.toml`, whole or not at all: both are written beside their places and renamed at the end,
/// and an older sidecar is taken away first, so that no moment shows new heights with old words.
/// Throws InputError for another extension or a folder that is not there, EnvironmentError where
/// the disk refuses.
void write_raw(const HeightField& field, const std::filesystem::path& file);

}  // namespace lodbench::terrain
