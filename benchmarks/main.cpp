// lodbench_benchmarks [SUBJECT...] [--size N] [--frames N] [--repetitions N]
//     [--terrain FILE --spacing METRES --vertical-scale METRES] [--method ID --set PARAM=VALUE]

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "api/error.h"
#include "benchmarks.h"
#include "run/locations.h"

namespace lodbench::benchmarks {

std::shared_ptr<const terrain::HeightField> north_west_corner(const Terrain& whole, int size) {
    TerrainInfo info = whole.info();
    info.rows = std::min(info.rows, size);
    info.columns = std::min(info.columns, size);
    std::vector<float> heights(std::size_t(info.rows) * std::size_t(info.columns));
    whole.read({0, 0, info.rows, info.columns}, heights);
    return std::make_shared<terrain::HeightField>(info, std::move(heights));
}

run::MethodInfo flown_method(const Options& options) {
    const auto plugins = run::list_plugins({run::default_plugin_folder()});
    if (!options.method.empty()) return run::find_method(plugins, options.method, "--method");
    for (const run::PluginListing& plugin : plugins) {
        for (const run::MethodInfo& method : plugin.methods) {
            if ((method.capabilities & kExample) == 0) return method;
        }
    }
    throw InputError("there is no method but examples; name one with --method");
}

}  // namespace lodbench::benchmarks

int main(int argc, char** argv) {
    lodbench::benchmarks::Options options;
    CLI::App app("Rates of lodbench's own code, printed as measured in this run");
    std::vector<std::string> chosen;
    for (const auto& subject : lodbench::benchmarks::subjects()) chosen.emplace_back(subject.name);
    const std::vector<std::string> known = chosen;
    app.add_option("subjects", chosen,
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
    app.add_option("--method", options.method,
                   "the method that harness and truth fly; the first one where none is named");
    std::vector<std::string> settings;
    app.add_option("--set", settings, "PARAM=VALUE of the method; may be repeated")
        ->allow_extra_args(false)
        ->check(CLI::Validator(
            [](const std::string& word) {
                return word.find('=') == word.npos ? "expected PARAM=VALUE" : "";
            },
            ""));
    CLI11_PARSE(app, argc, argv);
    for (const std::string& word : settings) {
        const std::size_t sign = word.find('=');
        options.settings.emplace_back(word.substr(0, sign), word.substr(sign + 1));
    }
    try {
        for (const auto& subject : lodbench::benchmarks::subjects()) {
            if (std::ranges::find(chosen, subject.name) != chosen.end()) subject.run(options);
        }
    } catch (const std::exception& error) {
        fmt::print(stderr, "lodbench_benchmarks: {}\n", error.what());
        return 1;
    }
    return 0;
}
