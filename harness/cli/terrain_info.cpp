// lodbench terrain info, and what other commands print of a terrain.

#include <fmt/format.h>

#include <memory>

#include "base/console.h"
#include "cli/terrain_options.h"
#include "results/json.h"
#include "terrain/open_terrain.h"
#include "terrain/tile_store.h"
#include "terrain/void_fill.h"

namespace lodbench::cli {
namespace {

Json::Value pair(glm::dvec2 value) {
    Json::Value array(Json::arrayValue);
    array.append(value.x);
    array.append(value.y);
    return array;
}

/// What x, y and z of a scenario's flight mean.
constexpr const char* kWorld = "x is east, y north, z up, in metres";

Json::Value json_of(const TerrainText& text) {
    const TerrainInfo& info = text.info;
    Json::Value object;
    object["name"] = info.name;
    object["source"] = text.provenance.kind;
    object["rows"] = info.rows;
    object["columns"] = info.columns;
    object["min_height_m"] = info.min_height;
    object["max_height_m"] = info.max_height;
    object["spacing_m"] = pair(info.spacing);
    object["spacing_assumed"] = text.provenance.spacing_assumed;
    object["reference"] = results::text_or_null(text.provenance.reference);
    object["world"] = kWorld;
    object["extent_min_m"] = pair(info.extent_min());
    object["extent_max_m"] = pair(info.extent_max());
    object["voids_filled"] = Json::UInt64(info.void_count);
    object["warnings"] = results::array_of(warnings_of(info, text.provenance));
    object["checksum"] = info.checksum;
    object["written"] = results::text_or_null(text.written);
    if (!text.store) return object;
    const terrain::StoreLayout layout(info.rows, info.columns, *text.store);
    Json::Value& store = object["store"];
    store["samples"] =
        text.store->type == terrain::StoreSamples::float32 ? "float32" : "uint16 steps";
    store["step_m"] = text.store->step > 0 ? Json::Value(text.store->step) : Json::Value();
    store["levels"] = layout.pyramid().levels();
    store["tiles"] = Json::UInt64(layout.pyramid().count());
    store["tile_bytes"] = Json::UInt64(layout.record_bytes());
    store["bytes"] = Json::UInt64(layout.file_bytes());
    return object;
}

void print_store(const TerrainText& text) {
    const TerrainInfo& info = text.info;
    const terrain::StoreLayout layout(info.rows, info.columns, *text.store);
    const TilePyramid& pyramid = layout.pyramid();
    base::print("samples   {}\n", text.store->text());
    base::print("levels    {}:", pyramid.levels());
    for (int level = 0; level < pyramid.levels(); ++level) {
        base::print(" {} x {}", pyramid.rows(level), pyramid.columns(level));
    }
    base::print("\ntiles     {} of {} bytes\n", pyramid.count(), layout.record_bytes());
    base::print("bytes     {}\n", layout.file_bytes());
}

void run(const TerrainOptions& options, const CLI::App& command) {
    const terrain::TerrainSource source = source_of(options, command);
    if (!source.file.empty() && terrain::is_store(source.file)) {
        terrain::check_source(source);
        const terrain::StoredTerrain store(source.file);
        const terrain::StoreSampling& sampling = store.sampling();
        return print(
            {.info = store.info(), .provenance = terrain::provenance_of(store), .store = sampling},
            options.json);
    }
    const terrain::LoadedTerrain loaded = load(options, command);
    print({.info = loaded.field->info(), .provenance = loaded.provenance}, options.json);
}

}  // namespace

std::vector<std::string> warnings_of(const TerrainInfo& info,
                                     const terrain::Provenance& provenance) {
    std::vector<std::string> warnings = provenance.warnings;
    if (std::string voids = terrain::warning_of_voids(info); !voids.empty()) {
        warnings.push_back(std::move(voids));
    }
    return warnings;
}

void tell_warnings(const TerrainInfo& info, const terrain::Provenance& provenance) {
    for (const std::string& warning : warnings_of(info, provenance)) {
        base::tell("warning: {}", warning);
    }
}

void print(const TerrainText& text, bool json) {
    tell_warnings(text.info, text.provenance);
    if (json) {
        base::print("{}\n", results::to_text(json_of(text), true));
        return;
    }
    const TerrainInfo& info = text.info;
    const glm::dvec2 extent = info.extent_max() - info.extent_min();
    base::print("name      {}\n", info.name);
    base::print("source    {}\n", text.provenance.kind);
    base::print("size      {} rows x {} columns\n", info.rows, info.columns);
    base::print("heights   {} to {} m\n", info.min_height, info.max_height);
    base::print(
        "spacing   {:.6g} m east, {:.6g} m north{}\n", info.spacing.x, info.spacing.y,
        text.provenance.spacing_assumed ? " (assumed: the file does not say; give --spacing)" : "");
    base::print("extent    {:.6g} x {:.6g} m, from ({:.2f}, {:.2f})\n", extent.x, extent.y,
                info.origin.x, info.origin.y);
    if (!text.provenance.reference.empty()) {
        base::print("reference {}\n", text.provenance.reference);
    }
    base::print("world     {}; the south-west sample stands at ({:.2f}, {:.2f})\n", kWorld,
                info.origin.x, info.origin.y);
    base::print("voids     {} filled\n", info.void_count);
    base::print("checksum  {}\n", info.checksum);
    if (text.store) print_store(text);
    if (text.written.empty()) return;
    if (!text.store) {
        base::print("written   {0} and {0}.toml\n", text.written);
        return;
    }
    const double megabytes = 4e-6 * info.rows * double(info.columns);
    base::print("written   {} in {:.1f} s, {:.0f} MB/s of float32 samples\n", text.written,
                text.seconds, megabytes / text.seconds);
}

void add_terrain_info(CLI::App& parent) {
    const auto options = std::make_shared<TerrainOptions>();
    CLI::App& command = *parent.add_subcommand(
        "info", "Show size, height range, spacing, extent, voids and checksum of a terrain");
    auto* file = command.add_option("FILE", options->source.file,
                                    "elevation model, image, raw file or tiled store (.tiles)");
    auto* form = command.add_option("--synthetic", options->source.synthetic, "A synthetic form");
    file->excludes(form);
    add_shape(command, *options);
    add_overrides(command, *options);
    add_file_overrides(command, *options);
    command.footer(forms_text());
    command.callback([&command, options] { run(*options, command); });
}

}  // namespace lodbench::cli
