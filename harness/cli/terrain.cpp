// lodbench terrain info | import | synth; errors: terrain_errors.cpp

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "cli/commands.h"
#include "cli/terrain_options.h"
#include "report/json.h"
#include "terrain/export_raw.h"

namespace lodbench::cli {
namespace {

using terrain::LoadedTerrain;
using Options = TerrainOptions;

Json::Value pair(glm::dvec2 value) {
    Json::Value array(Json::arrayValue);
    array.append(value.x);
    array.append(value.y);
    return array;
}

void print_json(const LoadedTerrain& loaded, const std::string& output) {
    const TerrainInfo& info = loaded.field->info();
    Json::Value object;
    object["name"] = info.name;
    object["source"] = loaded.kind;
    object["rows"] = info.rows;
    object["columns"] = info.columns;
    object["min_height_m"] = info.min_height;
    object["max_height_m"] = info.max_height;
    object["spacing_m"] = pair(info.spacing);
    object["spacing_assumed"] = loaded.spacing_assumed;
    object["extent_min_m"] = pair(info.extent_min());
    object["extent_max_m"] = pair(info.extent_max());
    object["voids_filled"] = Json::UInt64(info.void_count);
    object["checksum"] = info.checksum;
    object["written"] = output.empty() ? Json::Value() : Json::Value(output);
    fmt::print("{}\n", report::to_text(object, true));
}

void print(const LoadedTerrain& loaded, const Options& options) {
    if (options.json) return print_json(loaded, options.output);
    const TerrainInfo& info = loaded.field->info();
    const glm::dvec2 extent = info.extent_max() - info.extent_min();
    fmt::print("name      {}\n", info.name);
    fmt::print("source    {}\n", loaded.kind);
    fmt::print("size      {} rows x {} columns\n", info.rows, info.columns);
    fmt::print("heights   {} to {} m\n", info.min_height, info.max_height);
    fmt::print("spacing   {:.6g} m east, {:.6g} m north{}\n", info.spacing.x, info.spacing.y,
               loaded.spacing_assumed ? " (assumed: the file does not say; give --spacing)" : "");
    fmt::print("extent    {:.6g} x {:.6g} m, from ({:.2f}, {:.2f})\n", extent.x, extent.y,
               info.origin.x, info.origin.y);
    fmt::print("voids     {} filled\n", info.void_count);
    fmt::print("checksum  {}\n", info.checksum);
    if (!options.output.empty()) {
        fmt::print("written   {} and {}.toml\n", options.output, options.output);
    }
}

/// Runs a command: load, write where asked, print.
void finish(CLI::App& command, const std::shared_ptr<Options>& options) {
    command.callback([&command, options] {
        const LoadedTerrain loaded = load(*options, command);
        if (!options->output.empty()) terrain::write_raw(*loaded.field, options->output);
        print(loaded, *options);
    });
}

void add_info(CLI::App& parent) {
    const auto options = std::make_shared<Options>();
    CLI::App& command = *parent.add_subcommand(
        "info", "Size, height range, spacing, extent, voids and checksum of a terrain");
    auto* file =
        command.add_option("FILE", options->source.file, "Elevation model, image or raw file");
    auto* form = command.add_option("--synthetic", options->source.synthetic, "A synthetic form");
    file->excludes(form);
    add_shape(command, *options);
    add_overrides(command, *options);
    add_file_overrides(command, *options);
    command.footer(forms_text());
    finish(command, options);
}

void add_import(CLI::App& parent) {
    const auto options = std::make_shared<Options>();
    CLI::App& command = *parent.add_subcommand(
        "import", "Reads a terrain, fills its voids and writes it as float32 heights in metres");
    command.add_option("FILE", options->source.file, "Elevation model, image or raw file")
        ->required();
    command
        .add_option("-o,--output", options->output, "OUT.raw; OUT.raw.toml is written beside it")
        ->required();
    add_overrides(command, *options);
    add_file_overrides(command, *options);
    finish(command, options);
}

void add_synth(CLI::App& parent) {
    const auto options = std::make_shared<Options>();
    CLI::App& command =
        *parent.add_subcommand("synth", "Makes a synthetic terrain and writes its heights");
    command.add_option("NAME", options->source.synthetic, "The form")->required();
    command
        .add_option("-o,--output", options->output, "OUT.raw; OUT.raw.toml is written beside it")
        ->required();
    add_shape(command, *options);
    add_overrides(command, *options);
    command.footer(forms_text());
    finish(command, options);
}

}  // namespace

void add_terrain(CLI::App& app, int& /*status*/) {
    CLI::App& command =
        *app.add_subcommand("terrain", "Looks at, imports, makes and preprocesses terrains");
    command.require_subcommand(1);
    add_info(command);
    add_import(command);
    add_synth(command);
    add_terrain_errors(command);
}

}  // namespace lodbench::cli
