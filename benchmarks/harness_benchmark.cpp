// What the harness itself adds to a frame: a method that does nothing, and one that draws, flown in
// turns on scenarios/trade/high.toml; its share is that of the latter's frame.

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "benchmarks.h"
#include "measure/statistics.h"
#include "run/locations.h"
#include "run/stage.h"
#include "run/timing.h"
#include "scenario/camera_track.h"
#include "scenario/scenario.h"

namespace lodbench::benchmarks {

namespace {

struct Flown {
    std::vector<double> wall_ms, host_ms;
};

class Aircraft {
public:
    Aircraft(const scenario::Scenario& scenario,
             std::shared_ptr<const terrain::HeightField> terrain,
             const std::filesystem::path& plugin, const std::string& method,
             const run::Settings& settings)
        : scenario_(scenario),
          track_(scenario, *terrain),
          stage_(run::StageSetup{std::move(terrain), plugin, method, settings, ""}, signs_) {
        stage_.prepare();
        stage_.upload();
        stage_.resize(scenario.viewport);
    }

    // wall: the whole frame; host: selection and submission alone, without clearing and finishing.
    Flown fly() {
        measure::TimerVerdict bracket;  // not trusted: every frame ends with glFinish
        run::FrameTimer timer(stage_.device(), bracket);
        for (int frame = 0; frame < scenario_.frames; ++frame) {
            const Camera camera = track_.camera(frame);
            timer.begin_frame();
            stage_.select(camera, track_.clock(frame));
            timer.end_select();
            stage_.draw(picture_view(camera));
            timer.end_submit();
        }
        timer.finish();
        Flown flown;
        for (const run::FrameTimes& times : timer.frames()) {
            flown.wall_ms.push_back(times.wall_ms);
            flown.host_ms.push_back(times.select_ms + times.submit_ms);
        }
        return flown;
    }

private:
    const scenario::Scenario& scenario_;
    run::VitalSigns signs_;
    scenario::CameraTrack track_;
    run::Stage stage_;
};

double median(const std::vector<double>& values) {
    return *measure::percentile(values, 0.5);
}

}  // namespace

void harness_benchmark(const Options& options) {
    const run::MethodInfo method = flown_method(options);
    const scenario::Scenario scenario =
        scenario::load_scenario(run::scenario_folder() / "trade/high.toml");
    const std::shared_ptr<const terrain::HeightField> terrain =
        terrain::load_terrain(scenario.terrain);
    std::vector<double> nothing_wall, nothing_host, other_wall;
    for (int round = 0; round < 3; ++round) {
        // One context at a time is current on a thread: each flies and goes.
        const Flown nothing =
            Aircraft(scenario, terrain, LODBENCH_NOTHING_PLUGIN, "nothing", {}).fly();
        const Flown other =
            Aircraft(scenario, terrain, method.plugin, method.id, options.settings).fly();
        nothing_wall.insert(nothing_wall.end(), nothing.wall_ms.begin(), nothing.wall_ms.end());
        nothing_host.insert(nothing_host.end(), nothing.host_ms.begin(), nothing.host_ms.end());
        other_wall.insert(other_wall.end(), other.wall_ms.begin(), other.wall_ms.end());
    }
    const double host = median(nothing_host);
    const double wall = median(nothing_wall);
    const double other = median(other_wall);
    fmt::print("harness, a method that does nothing, {} frames at {}x{}, medians:\n",
               nothing_wall.size(), scenario.viewport.width, scenario.viewport.height);
    fmt::print("  host calls per frame            {:8.1f} us   {:.3f} % of {}'s frame\n",
               host * 1e3, 100 * host / other, method.id);
    fmt::print("  with clearing and glFinish      {:8.1f} us   {:.3f} %\n", wall * 1e3,
               100 * wall / other);
    fmt::print("  {:<31} {:8.1f} us\n", method.id + "'s frame", other * 1e3);
}

}  // namespace lodbench::benchmarks
