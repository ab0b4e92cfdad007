#pragma once
// The folder of one campaign, read back whole and checked: what a report is made of.

#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "results/cell.h"
#include "results/match.h"
#include "results/run_record.h"

namespace lodbench::results {

/// frames/<cell>.csv. Of its columns only those that are wanted are kept.
struct FrameTable {
    std::map<std::string, std::vector<double>, std::less<>> columns;  ///< NaN: absent
    std::size_t rows = 0;
    /// nullptr where there is no such column, or nothing in it.
    [[nodiscard]] const std::vector<double>* find(std::string_view column) const;
};

/// What the views of a flight needed: of all frames together, the tiles of 65 × 65 samples in view
/// at the coarsest level that keeps a screen error.
struct NeededTiles {
    double target_px = 0;
    double tiles = 0, samples = 0, most_tiles_in_a_frame = 0;
};

/// flights/<scenario>.json: where the cameras of a flight stood, and the ground below.
struct FlightRecord {
    glm::dvec2 low{0.0}, high{0.0};  ///< corners of the terrain, metres
    glm::dvec2 spacing{0.0};         ///< metres between samples
    int rows = 0, columns = 0;       ///< samples
    double min_height = 0, max_height = 0;
    std::vector<glm::dvec3> positions;   ///< of each frame, metres
    std::vector<glm::dvec3> directions;  ///< of view, length 1
    std::vector<NeededTiles> needed;     ///< by rising error; empty where it is not said
    std::filesystem::path hillshade;     ///< PNG; empty where there is none
};

/// What is read of frames/.
struct FramesWanted {
    std::span<const std::string_view> columns;
    bool required = true;  ///< false: a cell without the file has no table
};
/// What a report draws, and all cells must have.
[[nodiscard]] FramesWanted frames_of_report();

struct ResultFolder {
    std::filesystem::path path;
    std::string name;  ///< the folder's own name
    RunRecord run;     ///< run.json
    std::vector<CellRecord> cells;
    std::map<std::string, FrameTable> frames;     ///< by cell; of the cells that are ok
    std::map<std::string, FlightRecord> flights;  ///< by scenario; of those that have one
    std::optional<MatchRecord> match;             ///< of a folder that `match` wrote
    std::vector<std::string> warnings;            ///< that something is not there yet
};

/// Reads and checks all of it. Throws InputError with file, line and remedy where something in it
/// is missing, damaged, or of another schema version; results that were not measured, pictures and
/// flights may be missing.
[[nodiscard]] ResultFolder read_result_folder(const std::filesystem::path& path,
                                              const FramesWanted& wanted = frames_of_report());

/// Throws InputError unless nothing or a plain file lies there: a link leads out of the folder, and
/// reading a pipe never ends.
void expect_plain_file(const std::filesystem::path& file);

/// `where` names the file in messages.
[[nodiscard]] FrameTable parse_frame_table(std::string_view csv, const std::string& where,
                                           const FramesWanted& wanted = frames_of_report());

/// Throws InputError naming the file unless a cell's frames are those that it was written with.
void expect_frames(const CellRecord& cell, std::string_view csv, const std::string& where);

}  // namespace lodbench::results
