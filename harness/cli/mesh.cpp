// lodbench mesh: the triangles that a method draws in one frame of a scenario, as PLY.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/console.h"
#include "base/files.h"
#include "cli/commands.h"
#include "cli/method_settings.h"
#include "cli/options.h"
#include "cli/terrain_options.h"
#include "results/cell_groups.h"
#include "run/locations.h"
#include "run/mesh_export.h"
#include "run/plan.h"
#include "run/shared_signs.h"
#include "run/stage.h"
#include "scenario/camera_track.h"
#include "scenario/scenario.h"
#include "terrain/open_terrain.h"

namespace lodbench::cli {

namespace {

struct MeshOptions {
    std::string method, scenario, out, device;
    std::vector<std::string> settings;
    std::vector<std::filesystem::path> plugin_dirs;
    int frame = 0;
    std::optional<double> time_limit_s;
    scenario::Overrides overrides;
    bool before_clipping = false;
    bool json = false;
};

/// Flies to the frame in lockstep, as a method may keep state from frame to frame, and writes the
/// file. Returns what is to be printed.
std::string export_mesh(const MeshOptions& options, const scenario::Scenario& scenario,
                        const run::MethodInfo& method, const run::Settings& settings,
                        run::VitalSigns& signs) {
    terrain::OpenTerrain opened = terrain::open_terrain_with_provenance(scenario.terrain);
    tell_warnings(opened.terrain->info(), opened.provenance);
    const std::shared_ptr<const Terrain> terrain = std::move(opened.terrain);
    const scenario::CameraTrack track(scenario, *terrain);
    run::Stage stage({.terrain = terrain,
                      .plugin = method.plugin,
                      .method = method.id,
                      .settings = settings,
                      .device = options.device,
                      .warn = [](const std::string& words) { base::tell("warning: {}", words); }},
                     signs);
    stage.prepare();
    stage.upload();
    stage.resize(scenario.viewport);
    for (int frame = track.first_frame(); frame <= options.frame; ++frame) {
        stage.select(track.camera(frame), track.clock(frame));
        stage.settle();
    }
    stage.pause_background();
    const measure::CapturedSurface surface = stage.capture();
    stage.resume_background();
    if (const std::uint64_t count = run::not_finite_count(surface); count > 0) {
        throw run::MethodFailure(fmt::format(
            "{} of the {} vertices that '{}' draws in frame {} are NaN or infinite: nothing was "
            "written; "
            "`lodbench validate {}` finds the camera",
            count, surface.vertices.size(), method.id, options.frame, method.plugin.string()));
    }
    run::MeshContext context;
    context.lodbench_version = LODBENCH_VERSION;
    context.method = method.id;
    context.method_version = method.version;
    context.scenario = scenario.name;
    for (const auto& [name, value] : stage.params().values()) {
        context.params.emplace_back(name, results::value_text(value));
    }
    context.terrain = terrain->info();
    context.frame = options.frame;
    context.camera = track.camera(options.frame);
    context.clipped = !options.before_clipping;
    const run::Mesh mesh = options.before_clipping
                               ? run::weld(surface)
                               : run::weld(measure::clipped_triangles(surface, terrain->info()));
    base::write_whole(options.out, run::ply(mesh, context));
    stage.release();
    return options.json
               ? fmt::format("{{\"vertices\": {}, \"triangles\": {}}}", mesh.vertices.size(),
                             mesh.triangles.size())
               : fmt::format("{}: {} triangles, {} vertices, frame {} of {}", options.out,
                             mesh.triangles.size(), mesh.vertices.size(), options.frame, method.id);
}

int run_mesh(const MeshOptions& options) {
    const std::filesystem::path file =
        options.scenario.empty() ? run::demo_scenario() : std::filesystem::path(options.scenario);
    scenario::Scenario scenario = scenario::load_scenario(file, options.overrides);
    if (options.frame >= scenario.frames) {
        throw InputError(fmt::format("--frame {}: the flight of {} has frames 0 to {}",
                                     options.frame, scenario.name, scenario.frames - 1));
    }
    const run::MethodInfo method =
        run::find_method(find_plugins(options.plugin_dirs), options.method, "mesh");
    const run::Settings settings = method_settings(scenario, method, options.settings);
    static_cast<void>(run::make_params(method, settings, "--set or scenario " + scenario.name));
    const std::shared_ptr<run::VitalSigns> signs = run::map_signs();
    const auto fly = [&] { return export_mesh(options, scenario, method, settings, *signs); };
    return fly_apart(method, options.time_limit_s.value_or(scenario.cell_time_limit_s), *signs,
                     fly);
}

}  // namespace

void add_mesh(CLI::App& app, int& status) {
    const auto options = std::make_shared<MeshOptions>();
    CLI::App* command = app.add_subcommand("mesh",
                                           "Write the triangles that a method draws in one frame "
                                           "(binary PLY, world metres in double)");
    command->add_option("METHOD", options->method, "id of the method, see `lodbench list`")
        ->required();
    command->add_option("SCENARIO", options->scenario,
                        "scenario file; none: the demo over Puget Sound");
    command->add_option("--frame", options->frame, "index on the flight path, 0 when not given")
        ->check(CLI::Range(0, 999999));
    command->add_option("-o,--out", options->out, "file to write, whole or not at all")->required();
    add_repeated(*command, "--set", options->settings, "[METHOD.]PARAM=VALUE");
    add_overrides(*command, options->overrides);
    add_time_limit(
        *command, options->time_limit_s,
        "of the flight to that frame, seconds; as the scenario's cell_time_limit_s says");
    add_device(*command, options->device);
    add_plugin_dirs(*command, options->plugin_dirs);
    command->add_flag("--before-clipping", options->before_clipping,
                      "as the method sent it: padding and degenerate triangles included");
    command->add_flag("--json", options->json, "print the counts as JSON");
    command->callback([options, &status] { status = run_mesh(*options); });
}

}  // namespace lodbench::cli
