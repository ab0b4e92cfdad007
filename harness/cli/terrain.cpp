// lodbench terrain: its commands are in terrain_*.cpp.

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/terrain_options.h"

namespace lodbench::cli {

void add_terrain(CLI::App& app, int& status) {
    CLI::App& command = *app.add_subcommand("terrain", "Look at, import and make terrains");
    command.require_subcommand(1);
    add_terrain_info(command);
    add_terrain_import(command);
    add_terrain_synth(command);
    add_terrain_upsample(command);
    add_terrain_verify(command, status);
}

}  // namespace lodbench::cli
