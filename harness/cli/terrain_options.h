#pragma once
// What the commands of `lodbench terrain` take, each its part of it.

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "terrain/load_terrain.h"

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

/// Throws InputError.
[[nodiscard]] terrain::LoadedTerrain load(const TerrainOptions& options, const CLI::App& command);

/// `lodbench terrain errors`.
void add_terrain_errors(CLI::App& parent);

}  // namespace lodbench::cli
