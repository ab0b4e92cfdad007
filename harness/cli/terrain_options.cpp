#include "cli/terrain_options.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include <charconv>

#include "api/error.h"
#include "cli/options.h"
#include "run/settings.h"
#include "terrain/synthetic.h"

namespace lodbench::cli {

void add_overrides(CLI::App& command, TerrainOptions& options) {
    terrain::TerrainSource& source = options.source;
    command.add_option("--spacing", options.spacing, "metres between samples, both axes");
    command.add_option("--spacing-x", source.spacing_x, "metres between columns");
    command.add_option("--spacing-y", source.spacing_y, "metres between rows");
    command.add_option("--origin-x", source.origin_x, "world x of the south-west sample, metres");
    command.add_option("--origin-y", source.origin_y, "world y of the south-west sample, metres");
    command.add_flag("--json", options.json, "one JSON object on standard output");
}

void add_file_overrides(CLI::App& command, TerrainOptions& options) {
    terrain::TerrainSource& source = options.source;
    command.add_option("--vertical-scale", source.vertical_scale, "metres per unit of the file")
        ->check([](const std::string& text) {
            // As in a scenario: scaled by 0, every terrain is flat.
            const double scale = std::strtod(text.c_str(), nullptr);
            return std::isfinite(scale) && scale != 0
                       ? std::string()
                       : "the scale is " + text + ": expected a finite number, not 0";
        });
    command.add_option("--vertical-offset", source.vertical_offset, "metres, added after scaling");
    command.add_option("--no-data", source.no_data, "value of samples without data; may be nan");
}

void add_shape(CLI::App& command, TerrainOptions& options) {
    terrain::TerrainSource& source = options.source;
    command.add_option("--rows", source.rows, "rows of a synthetic terrain")->capture_default_str();
    command.add_option("--columns", source.columns, "columns of a synthetic terrain")
        ->capture_default_str();
    add_seed(command, source.seed, "Seed of a synthetic terrain");
    add_repeated(command, "--set", options.settings,
                 "A parameter of the synthetic form, as key=value");
}

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

namespace {

void add_to_shape(const std::string& text, terrain::TerrainSource& source) {
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

}  // namespace

terrain::TerrainSource source_of(const TerrainOptions& options, const CLI::App& command) {
    terrain::TerrainSource source = options.source;
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
    return source;
}

terrain::LoadedTerrain load(const TerrainOptions& options, const CLI::App& command) {
    return terrain::load_terrain_with_provenance(source_of(options, command));
}

}  // namespace lodbench::cli
