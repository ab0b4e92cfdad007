#pragma once
// Rasters of floats on disk.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lodbench::terrain {

/// Channels lie side by side: value (row, column, channel) is at
/// (row * columns + column) * channels.size() + channel. Row 0 is the top.
struct FloatRaster {
    int rows = 0;     ///< >= 1
    int columns = 0;  ///< >= 1
    std::vector<std::string> channels;
    std::vector<float> values;
    std::vector<std::pair<std::string, std::string>> attributes;  ///< name, text
};

/// Throws as write_exr does where `file` is not named so or its folder does not take it: for those
/// who have much to do before they write.
void require_exr_output(const std::filesystem::path& file);

/// Writes `file` (extension .exr: 32-bit floats, one layer, named channels, compressed without
/// loss), whole or not at all. OpenImageIO is loaded at the first call. Throws InputError for
/// another extension or a folder that is not there, EnvironmentError where the folder or the disk
/// refuses.
void write_exr(const FloatRaster& raster, const std::filesystem::path& file);

}  // namespace lodbench::terrain
