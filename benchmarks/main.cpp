// lodbench_benchmarks [SUBJECT...] [--size N] [--frames N] [--repetitions N]
//     [--terrain FILE --spacing METRES --vertical-scale METRES]

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks.h"

namespace lodbench::benchmarks {

std::shared_ptr<const terrain::HeightField> north_west_corner(const Terrain& whole, int size) {
    TerrainInfo info = whole.info();
    info.rows = std::min(info.rows, size);
    info.columns = std::min(info.columns, size);
    std::vector<float> heights(std::size_t(info.rows) * std::size_t(info.columns));
    whole.read({0, 0, info.rows, info.columns}, heights);
    return std::make_shared<terrain::HeightField>(info, std::move(heights));
}

}  // namespace lodbench::benchmarks

int main(int argc, char** argv) {
    lodbench::benchmarks::Options options;
    CLI::App app("Rates of lodbench's own code, printed as measured in this run");
    const std::vector<std::string> known = {"blocks",    "errors",      "flights", "harness",
                                            "lindstrom", "patches",     "rays",    "staleness",
                                            "store",     "tile-counts", "tiles",   "truth"};
    std::vector<std::string> subjects = known;
    app.add_option("subjects", subjects,
                   fmt::format("{}; all when none is named", fmt::join(known, ", ")))
        ->check(CLI::IsMember(known));
    app.add_option("--size", options.size, "samples a side of the terrain")
        ->check(CLI::Range(3, 32769));
    app.add_option("--frames", options.frames, "cameras of a repetition")
        ->check(CLI::Range(1, 10000));
    app.add_option("--repetitions", options.repetitions)->check(CLI::Range(1, 1000));
    app.add_option("--terrain", options.terrain, "a raster; a ridged terrain when none is named");
    app.add_option("--spacing", options.spacing, "metres between samples");
    app.add_option("--vertical-scale", options.vertical_scale, "metres per unit of the raster");
    CLI11_PARSE(app, argc, argv);
    const auto wanted = [&](const char* subject) {
        return std::find(subjects.begin(), subjects.end(), subject) != subjects.end();
    };
    try {
        if (wanted("blocks")) lodbench::benchmarks::blocks_cost(options);
        if (wanted("errors")) lodbench::benchmarks::errors_cost(options);
        if (wanted("flights")) lodbench::benchmarks::flights_search(options);
        if (wanted("harness")) lodbench::benchmarks::harness_cost();
        if (wanted("lindstrom")) lodbench::benchmarks::lindstrom_cost(options);
        if (wanted("rays")) lodbench::benchmarks::ray_caster_cost(options);
        if (wanted("patches")) lodbench::benchmarks::patches_cost(options);
        if (wanted("store")) lodbench::benchmarks::store_cost(options);
        if (wanted("staleness")) lodbench::benchmarks::staleness_cost(options);
        if (wanted("tile-counts")) lodbench::benchmarks::tile_counts(options);
        if (wanted("tiles")) lodbench::benchmarks::tiles_cost(options);
        if (wanted("truth")) lodbench::benchmarks::truth_cost(options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "lodbench_benchmarks: {}\n", error.what());
        return 1;
    }
    return 0;
}
