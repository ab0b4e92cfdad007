#pragma once
// What the commands of `lodbench terrain` take, each its part of it.

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "terrain/load_terrain.h"
#include "terrain/tile_store_format.h"

namespace lodbench::cli {

struct TerrainOptions {
    terrain::TerrainSource source;
    std::optional<double> spacing;  ///< both axes
    std::vector<std::string> settings;
    std::string output;
    bool json = false;
};

/// Spacing and origin, and --json.
void add_overrides(CLI::App& command, TerrainOptions& options);
/// What belongs to files alone.
void add_file_overrides(CLI::App& command, TerrainOptions& options);
/// What belongs to synthetic terrains alone.
void add_shape(CLI::App& command, TerrainOptions& options);
/// The forms and their parameters, for --help.
[[nodiscard]] std::string forms_text();

/// The source that the options name. Throws InputError.
[[nodiscard]] terrain::TerrainSource source_of(const TerrainOptions& options,
                                               const CLI::App& command);
/// Loads it. Throws InputError.
[[nodiscard]] terrain::LoadedTerrain load(const TerrainOptions& options, const CLI::App& command);

/// The warnings of `provenance`, and one where a hundredth or more of the samples had no data.
[[nodiscard]] std::vector<std::string> warnings_of(const TerrainInfo& info,
                                                   const terrain::Provenance& provenance);
/// Tells them on standard error.
void tell_warnings(const TerrainInfo& info, const terrain::Provenance& provenance);

/// What is said of a terrain, of one in a store too.
struct TerrainText {
    TerrainInfo info = {};
    terrain::Provenance provenance = {};
    std::optional<terrain::StoreSampling> store = {};  ///< empty where it is none
    std::string written = {};                          ///< file; empty where none was written
    double seconds = 0;                                ///< that writing a store took
};
/// To standard output; warnings to standard error too, in JSON as well.
void print(const TerrainText& text, bool json);

/// One command each: `lodbench terrain ...`.
void add_terrain_info(CLI::App& parent);
void add_terrain_import(CLI::App& parent);
void add_terrain_synth(CLI::App& parent);
void add_terrain_upsample(CLI::App& parent);
void add_terrain_verify(CLI::App& parent, int& status);

}  // namespace lodbench::cli
