#pragma once
// frames/<cell>.csv as text, so that equal means equal to the bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace lodbench::test {

/// A frame's row: column to text.
using FrameTexts = std::map<std::string, std::string>;

inline std::vector<FrameTexts> read_frames_csv(const std::filesystem::path& path) {
    const auto split = [](const std::string& line) {
        std::vector<std::string> fields(1);
        for (const char c : line) {
            if (c == ',') {
                fields.emplace_back();
            } else {
                fields.back() += c;
            }
        }
        return fields;
    };
    std::ifstream stream(path);
    std::string line;
    std::getline(stream, line);
    const std::vector<std::string> names = split(line);
    std::vector<FrameTexts> rows;
    while (std::getline(stream, line)) {
        const std::vector<std::string> fields = split(line);
        EXPECT_EQ(fields.size(), names.size()) << path << ": " << line;
        FrameTexts& row = rows.emplace_back();
        for (std::size_t i = 0; i < std::min(fields.size(), names.size()); ++i) {
            row[names[i]] = fields[i];
        }
    }
    return rows;
}

/// Columns of counts, equal in every replay.
inline constexpr const char* kCountColumns[] = {"triangles", "triangles_nondegenerate",
                                                "draw_calls", "uploaded_bytes"};

/// Columns that the truth fills.
inline constexpr const char* kTruthColumns[] = {
    "screen_max_px",     "screen_p999_px",  "screen_rms_px",
    "visible_max_px",    "visible_p999_px", "pixel_max_px",
    "pixel_p999_px",     "pixel_rms_px",    "uncovered_samples",
    "crack_pixels",      "skirt_pixels",    "silhouette_pixels",
    "silhouette_max_px", "popping_max_px",  "popping_p999_px",
    "height_rmse_m",     "psnr_db",         "ssim"};

/// Fields of a cell that the truth fills from the lockstep replay.
inline constexpr const char* kLockstepFields[] = {
    "truth_frames", "screen_error_px", "visible_error_px",  "pixel_error_px",  "crack_pixels",
    "skirt_pixels", "silhouette_px",   "uncovered_samples", "popping_px",      "height_rmse_m",
    "image",        "bound_honesty",   "clipped_segments",  "unjudged_pixels", "undecided_pixels"};

}  // namespace lodbench::test
