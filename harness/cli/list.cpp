// lodbench list: which methods there are, which plugins cannot be used and why, which devices.

#include <CLI/CLI.hpp>
#include <memory>

#include "base/console.h"
#include "cli/commands.h"
#include "cli/method_json.h"
#include "cli/options.h"
#include "platform/context.h"
#include "results/json.h"
#include "run/exit_status.h"
#include "run/plugin_library.h"

namespace lodbench::cli {

namespace {

struct Options {
    std::vector<std::filesystem::path> plugin_dirs;
    bool json = false;
    bool devices = false;
};

int list_devices(bool json) {
    Json::Value array = Json::arrayValue;
    int count = 0;
    for (const platform::DeviceEntry& device : platform::list_devices()) {
        ++count;
        if (!json) {
            base::print("{:>3}  {}{}\n", device.number, device.name,
                        device.software ? "  (software)" : "");
            continue;
        }
        Json::Value entry;
        entry["number"] = device.number;
        entry["name"] = device.name;
        entry["software"] = device.software;
        array.append(entry);
    }
    if (json) base::print("{}\n", results::to_text(array));
    if (count > 0) return run::kAllWell;
    base::tell(
        "lodbench: EGL names no device: no driver is installed, or none is found where "
        "__EGL_VENDOR_LIBRARY_DIRS or the system says; install libegl-mesa0");
    return run::kNothingMeasured;
}

int list_methods(const Options& options) {
    const auto plugins = find_plugins(options.plugin_dirs);
    Json::Value object;
    object["methods"] = Json::arrayValue;
    object["refused"] = Json::arrayValue;
    object["left_out"] = Json::arrayValue;
    for (const run::PluginListing& plugin : plugins) {
        if (!plugin.refusal.empty()) {
            base::tell("warning: {}", plugin.refusal);
            Json::Value refused;
            refused["path"] = plugin.path.string();
            refused["refusal"] = plugin.refusal;
            object["refused"].append(refused);
        }
        for (const std::string& words : plugin.left_out) {
            base::tell("warning: {}", words);
            object["left_out"].append(words);
        }
        for (const run::MethodInfo& method : plugin.methods) {
            object["methods"].append(method_json(method));
            if (!options.json) base::print("{:<20} {}\n", method.id, method.title);
        }
    }
    if (options.json) base::print("{}\n", results::to_text(object));
    return 0;
}

}  // namespace

void add_list(CLI::App& app, int& status) {
    const auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("list", "Show the methods that were found, and the devices");
    add_plugin_dirs(*command, options->plugin_dirs);
    command->add_flag("--devices", options->devices, "the EGL devices instead, for --device");
    command->add_flag("--json", options->json, "JSON for programs");
    command->callback([options, &status] {
        status = options->devices ? list_devices(options->json) : list_methods(*options);
    });
}

}  // namespace lodbench::cli
