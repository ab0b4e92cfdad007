// lodbench-terrain-errors: the a-priori refinement criteria of longest-edge bisection, to look at
// and to check with other tools.

#include <chrono>

#include "base/console.h"
#include "cli/program.h"
#include "cli/terrain_options.h"
#include "common/leb_errors.h"
#include "results/json.h"
#include "terrain/raster_writer.h"

namespace lodbench::common {
namespace {

struct Options : cli::TerrainOptions {
    std::string scheme = "ppcs";
    std::string error = "midpoint";
};

using ComputeErrors = void (*)(LebGrid&, ErrorKind);

ComputeErrors scheme_of(const std::string& name) {
    if (name == "rpcs") return compute_errors_recursively;
    if (name == "ppcs-plain") return compute_errors_by_level_plain;
    return compute_errors_by_level;
}

/// The terrain's samples without padding; two channels, metres.
terrain::FloatRaster raster_of(const LebGrid& grid, const TerrainInfo& info,
                               const Options& options) {
    terrain::FloatRaster raster;
    raster.rows = info.rows;
    raster.columns = info.columns;
    raster.channels = {"error", "radius"};
    raster.attributes = {{"lodbench:scheme", options.scheme},
                         {"lodbench:error", options.error},
                         {"lodbench:terrain", info.name},
                         {"lodbench:checksum", info.checksum}};
    raster.values.reserve(2 * std::size_t(info.rows) * std::size_t(info.columns));
    for (int row = 0; row < info.rows; ++row) {
        for (int column = 0; column < info.columns; ++column) {
            const LebVertex& vertex = grid.at({row, column});
            raster.values.push_back(vertex.error);
            raster.values.push_back(vertex.radius);
        }
    }
    return raster;
}

void run(const Options& options, const CLI::App& command) {
    terrain::require_exr_output(options.output);  // before all the work
    const terrain::LoadedTerrain loaded = cli::load(options, command);
    cli::tell_warnings(loaded.field->info(), loaded.provenance);
    const TerrainInfo& info = loaded.field->info();
    LebGrid grid(*loaded.field);
    const auto start = std::chrono::steady_clock::now();
    scheme_of(options.scheme)(
        grid, options.error == "accumulated" ? ErrorKind::accumulated : ErrorKind::midpoint);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    terrain::write_exr(raster_of(grid, info, options), options.output);
    // What everything descends from.
    const LebVertex& centre = grid.at({grid.size() / 2, grid.size() / 2});
    if (options.json) {
        Json::Value object;
        object["name"] = info.name;
        object["scheme"] = options.scheme;
        object["error"] = options.error;
        object["rows"] = info.rows;
        object["columns"] = info.columns;
        object["padded_size"] = grid.size();
        object["seconds"] = seconds;
        object["centre_error_m"] = centre.error;
        object["centre_radius_m"] = centre.radius;
        object["written"] = options.output;
        base::print("{}\n", results::to_text(object, true));
        return;
    }
    base::print("name      {}\n", info.name);
    base::print("size      {} rows x {} columns, padded to {} x {}\n", info.rows, info.columns,
                grid.size(), grid.size());
    base::print("scheme    {}, {} errors, {:.1f} ms, {:.2f} ns a sample\n", options.scheme,
                options.error, seconds * 1e3, seconds * 1e9 / double(grid.vertex_count()));
    base::print("centre    error {} m, radius {} m\n", centre.error, centre.radius);
    base::print("written   {}: channels error and radius, metres\n", options.output);
}

void add_options(CLI::App& command, Options& options) {
    auto* file = command.add_option("FILE", options.source.file,
                                    "Elevation model, image, raw file or tiled store");
    auto* form = command.add_option("--synthetic", options.source.synthetic, "A synthetic form");
    file->excludes(form);
    command
        .add_option("-o,--output", options.output,
                    "OUT.exr: two channels of 32-bit floats in metres, error and radius")
        ->required();
    command
        .add_option("--scheme", options.scheme,
                    "ppcs: level by level, streamed; ppcs-plain: level by level; rpcs: recursion. "
                    "All give the same bits")
        ->check(CLI::IsMember({"ppcs", "ppcs-plain", "rpcs"}))
        ->capture_default_str();
    command
        .add_option("--error", options.error,
                    "midpoint: the largest of vertex and descendants; accumulated: the largest sum "
                    "along a path of descendants")
        ->check(CLI::IsMember({"midpoint", "accumulated"}))
        ->capture_default_str();
    cli::add_shape(command, options);
    cli::add_overrides(command, options);
    cli::add_file_overrides(command, options);
    command.footer(cli::forms_text());
}

}  // namespace
}  // namespace lodbench::common

int main(int argc, char** argv) {
    lodbench::base::secure_standard_streams();
    CLI::App app{
        "Writes the error and the nested radius of each sample, as longest-edge bisection has them",
        "lodbench-terrain-errors"};
    lodbench::common::Options options;
    lodbench::common::add_options(app, options);
    app.callback([&] { lodbench::common::run(options, app); });
    const int status = 0;
    return lodbench::cli::run_program(app, argc, argv, status);
}
