// lodbench frames: the pictures of a flight, of a method and of the true terrain, for tools that
// judge videos.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
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
#include "measure/hidden_ground.h"
#include "picture/png.h"
#include "results/json.h"
#include "results/record_json.h"
#include "run/locations.h"
#include "run/shared_signs.h"
#include "run/stage.h"
#include "scenario/camera_string.h"
#include "scenario/camera_track.h"
#include "scenario/scenario.h"
#include "terrain/mapped_terrain.h"
#include "terrain/open_terrain.h"

namespace lodbench::cli {

namespace {

struct FramesOptions {
    std::string method, scenario, device;
    std::filesystem::path out;
    std::vector<std::string> settings;
    std::vector<std::filesystem::path> plugin_dirs;
    std::optional<double> time_limit_s;
    scenario::Overrides overrides;
    bool no_reference = false;
};

/// Made here, or empty: nobody's files are written over.
void make_empty_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder)) {
        throw EnvironmentError(fmt::format("cannot make the folder {}: {}; choose another with -o",
                                           folder.string(), error.message()));
    }
    if (!std::filesystem::is_empty(folder, error)) {
        throw InputError(
            fmt::format("-o {}: the folder is not empty; name a new one", folder.string()));
    }
}

/// Flies in lockstep, as the truth is measured, and writes each frame as it is drawn.
class Filming {
public:
    Filming(const FramesOptions& options, const scenario::Scenario& scenario,
            const run::MethodInfo& method, const run::Settings& settings, run::VitalSigns& signs)
        : options_(options), scenario_(scenario), method_(method), signs_(signs) {
        terrain::OpenTerrain opened = terrain::open_terrain_with_provenance(scenario.terrain);
        tell_warnings(opened.terrain->info(), opened.provenance);
        terrain_ = std::move(opened.terrain);
        track_.emplace(scenario, *terrain_);
        if (!options.no_reference) truth_ = whole_terrain();
        stage_ = std::make_unique<run::Stage>(
            run::StageSetup{
                .terrain = terrain_,
                .plugin = method.plugin,
                .method = method.id,
                .settings = settings,
                .device = options.device,
                .warn = [](const std::string& words) { base::tell("warning: {}", words); }},
            signs);
    }

    std::string film() {
        stage_->prepare();
        stage_->upload();
        stage_->resize(scenario_.viewport);
        // As a cell's replay begins.
        for (int i = 0; i < scenario_.warmup_frames; ++i) {
            const int frame = std::min(track_->first_frame() + i, 0);
            stage_->select(track_->camera(frame), track_->clock(frame));
            stage_->draw_picture();
        }
        Json::Value cameras = Json::arrayValue;
        for (int frame = 0; frame < scenario_.frames; ++frame) {
            take(frame);
            cameras.append(scenario::camera_string(track_->camera(frame)));
        }
        // Last: a folder without it is not whole.
        base::write_whole(options_.out / "frames.json", results::to_text(about(cameras), true));
        stage_->release();
        return fmt::format("{}: {} frames of {}{}, {} a second", options_.out.string(),
                           scenario_.frames, method_.id, truth_ ? " and of the reference" : "",
                           scenario_.rate_hz);
    }

private:
    [[nodiscard]] std::shared_ptr<const terrain::WholeTerrain> whole_terrain() const {
        if (!scenario_.terrain.out_of_core) return terrain::whole_field(terrain_);
        return std::make_shared<const terrain::MappedTerrain>(terrain_, options_.out);
    }

    void take(int frame) {
        signs_.frame = frame;
        stage_->select(track_->camera(frame), track_->clock(frame));
        stage_->settle();
        stage_->pause_background();
        stage_->draw_picture();
        write("method", frame);
        if (truth_) {
            stage_->draw_reference_picture(truth_);
            write("reference", frame);
        }
        stage_->resume_background();
    }

    void write(const char* which, int frame) {
        const std::filesystem::path folder = options_.out / which;
        std::filesystem::create_directories(folder);
        picture::write_png(folder / fmt::format("{:05}.png", frame), scenario_.viewport.width,
                           scenario_.viewport.height, stage_->read_color());
    }

    [[nodiscard]] Json::Value about(const Json::Value& cameras) const {
        Json::Value json;
        json["lodbench"] = LODBENCH_VERSION;
        json["method"] = method_.id;
        json["method_version"] = method_.version;
        json["params"] = results::encode(stage_->params());
        json["scenario"] = scenario_.name;
        json["terrain"] = terrain_->info().name;
        json["terrain_checksum"] = terrain_->info().checksum;
        json["rate_hz"] = scenario_.rate_hz;
        json["frames"] = scenario_.frames;
        json["width"] = scenario_.viewport.width;
        json["height"] = scenario_.viewport.height;
        json["pictures"] = Json::arrayValue;
        json["pictures"].append("method/%05d.png");
        if (truth_) json["pictures"].append("reference/%05d.png");
        json["cameras"] = cameras;
        return json;
    }

    const FramesOptions& options_;
    const scenario::Scenario& scenario_;
    const run::MethodInfo& method_;
    run::VitalSigns& signs_;
    std::shared_ptr<const Terrain> terrain_;
    std::shared_ptr<const terrain::WholeTerrain> truth_;
    std::optional<scenario::CameraTrack> track_;
    std::unique_ptr<run::Stage> stage_;
};

int run_frames(const FramesOptions& options) {
    const std::filesystem::path file =
        options.scenario.empty() ? run::demo_scenario() : std::filesystem::path(options.scenario);
    const scenario::Scenario scenario = scenario::load_scenario(file, options.overrides);
    const run::MethodInfo method =
        run::find_method(find_plugins(options.plugin_dirs), options.method, "frames");
    const run::Settings settings = method_settings(scenario, method, options.settings);
    static_cast<void>(run::make_params(method, settings, "--set or scenario " + scenario.name));
    make_empty_folder(options.out);
    const std::shared_ptr<run::VitalSigns> signs = run::map_signs();
    const auto fly = [&] { return Filming(options, scenario, method, settings, *signs).film(); };
    return fly_apart(method, options.time_limit_s.value_or(scenario.cell_time_limit_s), *signs, fly,
                     [&] { return fmt::format(", in frame {}", signs->frame.load()); });
}

}  // namespace

void add_frames(CLI::App& app, int& status) {
    const auto options = std::make_shared<FramesOptions>();
    CLI::App* command = app.add_subcommand(
        "frames",
        "Write the pictures of a flight, of a method and of the true terrain, as numbered PNGs");
    command->add_option("METHOD", options->method, "id of the method, see `lodbench list`")
        ->required();
    command->add_option("SCENARIO", options->scenario,
                        "scenario file; none: the demo over Puget Sound");
    command
        ->add_option("-o,--out", options->out,
                     "new folder: method/00000.png, reference/00000.png, ..., frames.json")
        ->required();
    add_repeated(*command, "--set", options->settings, "[METHOD.]PARAM=VALUE");
    add_overrides(*command, options->overrides);
    add_time_limit(*command, options->time_limit_s,
                   "of all of it, seconds; as the scenario's cell_time_limit_s says");
    add_device(*command, options->device);
    add_plugin_dirs(*command, options->plugin_dirs);
    command->add_flag("--no-reference", options->no_reference, "the method's pictures alone");
    command->callback([options, &status] { status = run_frames(*options); });
}

}  // namespace lodbench::cli
