// lodbench terrain info | import | synth

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <memory>

#include "api/error.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "report/json.h"
#include "run/settings.h"
#include "terrain/export_raw.h"
#include "terrain/load_terrain.h"
#include "terrain/synthetic.h"

namespace lodbench::cli {
namespace {

using terrain::LoadedTerrain;
using terrain::TerrainSource;

/// What the three commands take; each fills its part.
struct Options {
    TerrainSource source;
    std::optional<double> spacing;  ///< both axes
    std::vector<std::string> settings;
    std::string output;
    bool json = false;
};

void add_overrides(CLI::App& command, Options& options) {
    TerrainSource& source = options.source;
    command.add_option("--spacing", options.spacing, "Metres between samples, both axes");
    command.add_option("--spacing-x", source.spacing_x, "Metres between columns");
    command.add_option("--spacing-y", source.spacing_y, "Metres between rows");
    command.add_option("--origin-x", source.origin_x, "World x of the south-west sample, metres");
    command.add_option("--origin-y", source.origin_y, "World y of the south-west sample, metres");
    command.add_flag("--json", options.json, "One JSON object on standard output");
}

void add_file_overrides(CLI::App& command, Options& options) {
    TerrainSource& source = options.source;
    command.add_option("--vertical-scale", source.vertical_scale, "Metres per unit of the file");
    command.add_option("--vertical-offset", source.vertical_offset, "Metres, added after scaling");
    command.add_option("--no-data", source.no_data, "Value of samples without data; may be nan");
}

void add_shape(CLI::App& command, Options& options) {
    TerrainSource& source = options.source;
    command.add_option("--rows", source.rows, "Rows of a synthetic terrain")->capture_default_str();
    command.add_option("--columns", source.columns, "Columns of a synthetic terrain")
        ->capture_default_str();
    add_seed(command, source.seed, "Seed of a synthetic terrain");
    add_repeated(command, "--set", options.settings,
                 "A parameter of the synthetic form, as key=value");
}

/// The forms and their parameters, for --help.
std::string forms_text() {
    std::string text = "Synthetic forms and their parameters (--set key=value):\n";
    for (const terrain::SyntheticForm& form : terrain::synthetic_forms()) {
        text += fmt::format("  {}: {}\n", form.name, form.help);
        for (const terrain::ShapeParam& param : form.params) {
            text += fmt::format("    {:<12} {} (default: {})\n", param.name, param.help,
                                param.default_text);
        }
    }
    return text;
}

void add_to_shape(const std::string& text, TerrainSource& source) {
    constexpr const char* kForm = "key=value with a number for the value";
    const run::Setting setting = run::parse_setting(text, kForm);
    const std::string& value = setting.value;
    double number = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (!setting.method.empty() || error != std::errc() || end != value.data() + value.size()) {
        throw InputError(fmt::format("--set {}: expected {}", text, kForm));
    }
    if (!source.shape.emplace(setting.name, number).second) {
        throw InputError(fmt::format("--set {}: the key is set twice; set it once", text));
    }
}

LoadedTerrain load(Options& options, const CLI::App& command) {
    TerrainSource source = options.source;
    if (source.synthetic.empty()) {
        for (const char* option : {"--rows", "--columns", "--seed", "--set"}) {
            const CLI::Option* given = command.get_option_no_throw(option);
            if (given != nullptr && given->count() > 0) {
                throw InputError(
                    fmt::format("{}: belongs to synthetic terrains; leave it out or "
                                "name one with --synthetic",
                                option));
            }
        }
    }
    if (options.spacing) {
        if (!source.spacing_x) source.spacing_x = options.spacing;
        if (!source.spacing_y) source.spacing_y = options.spacing;
    }
    for (const std::string& setting : options.settings) add_to_shape(setting, source);
    return terrain::load_terrain_with_provenance(source);
}

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
    CLI::App& command = *app.add_subcommand("terrain", "Looks at, imports and makes terrains");
    command.require_subcommand(1);
    add_info(command);
    add_import(command);
    add_synth(command);
}

}  // namespace lodbench::cli
