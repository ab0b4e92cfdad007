#include "view/command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>

#include "api/error.h"
#include "cli/method_settings.h"
#include "cli/options.h"
#include "run/exit_status.h"
#include "run/locations.h"
#include "run/plan.h"
#include "scenario/scenario.h"
#include "terrain/open_terrain.h"
#include "view/viewer.h"

namespace lodbench::view {

namespace {

struct Options {
    std::string scenario, device, api = "any";
    std::vector<std::string> methods, settings;
    std::vector<std::filesystem::path> plugin_dirs;
    std::filesystem::path out = ".", log;
    scenario::Overrides overrides;
    double scale = 0;
};

/// Of all methods, what the scenario and --set say; what the scenario sweeps begins with its
/// first value.
run::Settings settings_of(const scenario::Scenario& scenario, const run::MethodInfo& method,
                          const std::vector<std::string>& texts) {
    scenario::Scenario first = scenario;
    for (scenario::MethodRequest& request : first.methods) {
        for (auto& [name, values] : request.settings) values.resize(1);
    }
    std::vector<std::string> own;
    for (const std::string& text : texts) {
        const run::Setting setting = run::parse_setting(text, "METHOD.PARAM=VALUE");
        if (setting.method.empty()) {
            throw InputError(fmt::format("--set {}: name the method, as lindstrom.tau=2", text));
        }
        if (setting.method == method.id) own.push_back(text);
    }
    run::Settings settings = cli::method_settings(first, method, own);
    static_cast<void>(run::make_params(method, settings, "--set or scenario " + scenario.name));
    return settings;
}

ContextApi api_of(const std::string& name) {
    return name == "egl" ? ContextApi::egl : name == "glx" ? ContextApi::glx : ContextApi::any;
}

int view(const Options& options) {
    Setup setup;
    setup.file = std::filesystem::absolute(
        options.scenario.empty() ? run::demo_scenario() : std::filesystem::path(options.scenario));
    setup.overrides = options.overrides;
    setup.scenario = scenario::load_scenario(setup.file, options.overrides);
    const std::vector<run::PluginListing> plugins = cli::find_plugins(options.plugin_dirs);
    for (const run::PluginListing& listing : plugins) {
        for (const run::MethodInfo& method : listing.methods) {
            setup.methods.push_back(method);
            setup.settings.push_back(settings_of(setup.scenario, method, options.settings));
        }
    }
    for (std::size_t i = 0; i < options.methods.size(); ++i) {
        setup.shown.at(i) = run::find_method(plugins, options.methods[i], "--method").id;
    }
    if (setup.methods.empty()) throw InputError("no method was found; see `lodbench list`");
    if (options.methods.empty()) {
        setup.shown[0] = setup.scenario.methods.empty() ? setup.methods.front().id
                                                        : setup.scenario.methods.front().id;
        static_cast<void>(run::find_method(plugins, setup.shown[0], "the scenario's method"));
    }
    setup.terrain = terrain::open_terrain(setup.scenario.terrain);
    setup.device = options.device;
    setup.program = run::executable_path();
    setup.out = options.out;
    setup.log = options.log;
    setup.window = {setup.scenario.viewport, api_of(options.api), options.scale};
    Viewer(std::move(setup)).run();
    return run::kAllWell;
}

}  // namespace

void add_view_options(CLI::App& app, int& status) {
    const auto options = std::make_shared<Options>();
    app.add_option("SCENARIO", options->scenario, "scenario file; none: the demo over Puget Sound");
    app.add_option("--method,-m", options->methods,
                   "method to see; a second one stands beside it (again for that)")
        ->allow_extra_args(false)
        ->expected(1, 2);
    cli::add_repeated(app, "--set", options->settings, "METHOD.PARAM=VALUE");
    cli::add_overrides(app, options->overrides);
    cli::add_device(app, options->device);
    cli::add_plugin_dirs(app, options->plugin_dirs);
    app.add_option("--out,-o", options->out, "folder for screenshots and paths")
        ->check(CLI::ExistingDirectory);
    app.add_option("--context", options->api, "how the window's OpenGL context is made")
        ->check(CLI::IsMember({"any", "glx", "egl"}));
    app.add_option("--scale", options->scale, "size of text and margins; as the display says")
        ->check(CLI::Range(0.5, 8.0));
    app.add_option("--log", options->log, "file for what happens: a JSON object a line");
    app.callback([options, &status] { status = view(*options); });
}

}  // namespace lodbench::view
