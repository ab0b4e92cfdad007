// lodbench describe METHOD: its paper, parameters and promises.

#include <CLI/CLI.hpp>
#include <memory>

#include "base/console.h"
#include "cli/commands.h"
#include "cli/method_json.h"
#include "cli/options.h"
#include "results/json.h"
#include "run/exit_status.h"
#include "run/plugin_library.h"

namespace lodbench::cli {

namespace {

struct Options {
    std::string method;
    std::vector<std::filesystem::path> plugin_dirs;
    bool json = false;
};

void print(const run::MethodInfo& method) {
    base::print("{}: {}\n", method.id, method.title);
    if (!method.citation.empty()) base::print("paper      {}\n", method.citation);
    base::print("version    {}\nplugin     {}, compiled {}\n", method.version,
                method.plugin.string(), method.compiled);
    base::print("quality    {}\n",
                method.quality_knob.empty() ? "exact: no knob" : method.quality_knob);
    base::print("claims     {}\n",
                method.claimed_bound.empty()
                    ? "no bound of the screen error"
                    : method.claimed_bound +
                          " bounds the screen error in pixels (its claim, not a measurement)");
    for (const std::string& name : method.gl_extensions) base::print("needs      {}\n", name);
    if (method.params.empty()) return;
    base::print("parameters\n");
    for (const run::ParamInfo& param : method.params) {
        base::print("  {:<18} {:<8} {:<10} {}\n  {:<18} {}\n", param.name, type_words(param),
                    default_words(param), range_words(param), "", param.help);
    }
}

int describe(const Options& options) {
    const auto plugins = find_plugins(options.plugin_dirs);
    const run::MethodInfo& method = run::find_method(plugins, options.method, "describe");
    if (options.json) {
        base::print("{}\n", results::to_text(method_json(method)));
    } else {
        print(method);
    }
    return run::kAllWell;
}

}  // namespace

void add_describe(CLI::App& app, int& status) {
    const auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("describe", "Show a method's paper, parameters and promises");
    command->add_option("METHOD", options->method, "id of the method")->required();
    add_plugin_dirs(*command, options->plugin_dirs);
    command->add_flag("--json", options->json, "JSON for programs");
    command->callback([options, &status] { status = describe(*options); });
}

}  // namespace lodbench::cli
