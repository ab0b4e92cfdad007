// lodbench terrain import | synth | upsample

#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "api/error.h"
#include "cli/options.h"
#include "cli/terrain_options.h"
#include "terrain/export_raw.h"
#include "terrain/terrain_rows.h"
#include "terrain/tile_store_writer.h"
#include "terrain/upsample.h"

namespace lodbench::cli {
namespace {

struct WriteOptions : TerrainOptions {
    std::optional<double> step;
    terrain::Upsampling upsampling;
};

void add_step(CLI::App& command, WriteOptions& options) {
    command.add_option("--step", options.step,
                       "tiled stores: round heights to multiples of so many metres and keep 16 "
                       "bits of each; float32 without");
}

/// Passes over the source once and builds the store, larger than memory as both may be.
void write_tiles(const WriteOptions& options, const terrain::TerrainSource& source) {
    terrain::require_store_name(options.output);
    TerrainText text;
    text.written = options.output;
    const auto start = std::chrono::steady_clock::now();
    terrain::with_rows(source, [&](terrain::TerrainRows& rows) {
        terrain::StoreWriter writer(terrain::upsampled(rows.info(), options.upsampling),
                                    options.step, options.output);
        terrain::upsample(rows, options.upsampling,
                          [&](std::span<const float> row) { writer.push(row); });
        text.provenance = rows.provenance();
        text.info = writer.finish();
        text.store = writer.sampling();
    });
    text.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    print(text, options.json);
}

/// As the name of the file says: raw heights or a store.
void write(const WriteOptions& options, const CLI::App& command) {
    if (terrain::is_store(options.output)) return write_tiles(options, source_of(options, command));
    if (options.step) {
        throw InputError(
            fmt::format("--step {}: belongs to tiled stores; write OUT.tiles", *options.step));
    }
    const terrain::LoadedTerrain loaded = load(options, command);
    terrain::write_raw(*loaded.field, options.output);
    print(
        {.info = loaded.field->info(), .provenance = loaded.provenance, .written = options.output},
        options.json);
}

void add_output(CLI::App& command, WriteOptions& options) {
    command
        .add_option("-o,--output", options.output,
                    "OUT.tiles, a tiled store; or OUT.raw, with OUT.raw.toml beside it")
        ->required();
}

}  // namespace

void add_terrain_import(CLI::App& parent) {
    const auto options = std::make_shared<WriteOptions>();
    options->upsampling.factor = 1;
    CLI::App& command = *parent.add_subcommand(
        "import", "Read a terrain, fill its voids and write it as a tiled store or as raw heights");
    command
        .add_option("FILE", options->source.file, "elevation model, image, raw file or tiled store")
        ->required();
    add_output(command, *options);
    add_step(command, *options);
    add_overrides(command, *options);
    add_file_overrides(command, *options);
    command.callback([&command, options] { write(*options, command); });
}

void add_terrain_synth(CLI::App& parent) {
    const auto options = std::make_shared<WriteOptions>();
    options->upsampling.factor = 1;
    CLI::App& command =
        *parent.add_subcommand("synth", "Make a synthetic terrain and write its heights");
    command.add_option("NAME", options->source.synthetic, "the form")->required();
    add_output(command, *options);
    add_step(command, *options);
    add_shape(command, *options);
    add_overrides(command, *options);
    command.footer(forms_text());
    command.callback([&command, options] { write(*options, command); });
}

void add_terrain_upsample(CLI::App& parent) {
    const auto options = std::make_shared<WriteOptions>();
    terrain::Upsampling& upsampling = options->upsampling;
    CLI::App& command = *parent.add_subcommand(
        "upsample",
        "Make a larger terrain through the samples of a smaller one (bicubic), as a tiled store");
    command
        .add_option("FILE", options->source.file, "elevation model, image, raw file or tiled store")
        ->required();
    command.add_option("-o,--output", options->output, "OUT.tiles")->required();
    command
        .add_option("--factor", upsampling.factor,
                    "the result has (rows - 1) * factor + 1 rows, columns likewise")
        ->capture_default_str();
    command.add_option("--fractal", upsampling.fractal_amplitude,
                       "metres of noise between the samples: so much halfway, less nearer to them; "
                       "the factor is a power of two then");
    add_seed(command, upsampling.seed, "Seed of the noise");
    command.add_option("--rows", upsampling.rows, "rows that are kept, from the north");
    command.add_option("--columns", upsampling.columns, "columns that are kept, from the west");
    add_step(command, *options);
    add_overrides(command, *options);
    add_file_overrides(command, *options);
    command.callback([options] {
        terrain::TerrainSource source = options->source;
        if (options->spacing) {
            if (!source.spacing_x) source.spacing_x = options->spacing;
            if (!source.spacing_y) source.spacing_y = options->spacing;
        }
        write_tiles(*options, source);
    });
}

}  // namespace lodbench::cli
