// A libFuzzer target (clang, -DLODBENCH_FUZZ=ON): scenario_fuzz [--seeds FOLDER | libFuzzer's own
// arguments]. Any bytes as a scenario: refused as InputError in one plain line that begins with the
// file, or a scenario of finite numbers within their documented ranges whose path, where one can be
// made, gives finite cameras.

#include <unistd.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <initializer_list>

#include "api/error.h"
#include "fuzz/refusal.h"
#include "fuzz/seeds.h"
#include "scenario/camera_track.h"
#include "scenario/scenario.h"
#include "support/fake_terrain.h"

namespace lodbench::test {
namespace {

/// A folder with what scenarios may name; it stays as long as the process.
const std::filesystem::path& folder() {
    static const std::filesystem::path path = [] {
        const auto made =
            std::filesystem::temp_directory_path() / ("scenario_fuzz_" + std::to_string(getpid()));
        std::filesystem::create_directories(made);
        std::ofstream(made / "f.csv") << "frame,x,y,z,heading,pitch,roll\n"
                                         "0,0,0,100,0,-30,0\n1,10,0,100,0,-30,0\n";
        std::ofstream(made / "t.tif") << "never opened by the parser";
        return made;
    }();
    return path;
}

void require(bool holds, const char* what) {
    if (!holds) finding(std::string("accepted, but not ") + what);
}

void require_finite(std::initializer_list<double> numbers, const char* what) {
    for (const double number : numbers) require(std::isfinite(number), what);
}

void check_path_spec(const scenario::PathSpec& path) {
    for (const scenario::Keyframe& key : path.keyframes) {
        require_finite({key.position.x, key.position.y, key.position.z, key.heading.value_or(0),
                        key.pitch, key.roll},
                       "finite keyframes");
    }
    require_finite({path.speed, path.centre.x, path.centre.y, path.centre.z, path.radius,
                    path.height, path.turns, path.bearing, path.smoothing, path.margin.value_or(0)},
                   "a finite path");
}

void check_numbers(const scenario::Scenario& scenario) {
    const terrain::TerrainSource& terrain = scenario.terrain;
    require_finite(
        {terrain.no_data.value_or(0), terrain.spacing_x.value_or(1), terrain.spacing_y.value_or(1),
         terrain.vertical_scale.value_or(1), terrain.vertical_offset.value_or(0),
         terrain.origin_x.value_or(0), terrain.origin_y.value_or(0)},
        "a finite terrain");
    for (const auto& [name, value] : terrain.shape) require_finite({value}, "a finite shape");
    require(terrain.rows >= 2 && terrain.columns >= 2, "a terrain of 2 samples a side");
    require(!scenario.name.empty() && scenario.name.size() <= 64, "a short name");
    require(scenario.viewport.width >= 1 && scenario.viewport.height >= 1, "a viewport");
    require(scenario.vertical_fov > 0 && scenario.vertical_fov < 3.1415926, "a field of view");
    require(scenario.near_plane > 0 && std::isfinite(scenario.near_plane), "a near plane");
    require(scenario.rate_hz > 0 && std::isfinite(scenario.rate_hz), "a rate");
    require(scenario.frames >= 1 && scenario.warmup_frames >= 0, "frames");
    require(scenario.repetitions >= 1 && scenario.measure.every >= 1, "counts of at least 1");
    require_finite(
        {scenario.cell_time_limit_s, scenario.frame_time_limit_s, scenario.measure.budget_ms},
        "finite limits");
    for (const auto* frames : {&scenario.measure.shots, &scenario.measure.economy}) {
        for (const int frame : *frames) require(frame >= 0 && frame < scenario.frames, "a frame");
    }
    if (terrain.upsampling) {
        require(terrain.upsampling->factor >= 2, "a factor");
        require_finite({terrain.upsampling->fractal_amplitude}, "a finite fractal");
    }
    if (scenario.equal) {
        require(scenario.equal->error_px > 0 && scenario.equal->tolerance > 0, "an equal error");
        require_finite({scenario.equal->error_px, scenario.equal->tolerance}, "finite errors");
    }
    for (const scenario::MethodRequest& method : scenario.methods) {
        require(!method.id.empty(), "a method's id");
        for (const auto& [key, values] : method.settings) require(!values.empty(), "a setting");
    }
    check_path_spec(scenario.path);
}

/// Cameras: the first of a warm-up that flies, first, second, middle and last.
void check_flight(const scenario::Scenario& scenario) {
    FakeTerrain terrain(5, 9);
    terrain.height = [](int row, int column) { return float(100 * row - 30 * column); };
    const scenario::CameraTrack track(scenario, terrain);
    for (const int frame : {track.first_frame(), 0, std::min(1, scenario.frames - 1),
                            scenario.frames / 2, scenario.frames - 1}) {
        const Camera camera = track.camera(frame);
        const glm::dvec3& eye = camera.position;
        require_finite({eye.x, eye.y, eye.z}, "a finite camera");
        require(std::abs(glm::length(camera.orientation) - 1) < 1e-9, "an orientation");
    }
}

void use_as_scenario(std::string_view text) {
    const std::filesystem::path file = folder() / "fuzz.toml";
    try {
        scenario::Scenario scenario = scenario::parse_scenario(text, file);
        check_numbers(scenario);
        check_flight(scenario);
    } catch (const InputError& error) {
        check_refusal(error.what(), file.string());
    }
}

std::vector<std::string> seeds() {
    const std::string terrain =
        "[terrain]\nsynthetic = \"ridged\"\nrows = 65\ncolumns = 33\nseed = 3\n"
        "spacing = [10, 20.5]\nvertical_scale = 2\nvertical_offset = -1.5\n"
        "origin = [1e3, -2e3]\n[terrain.shape]\nheight = 600\nbase = -10\n"
        "[terrain.upsample]\nfactor = 4\nfractal = 2.5\nseed = 9\n"
        "[equal]\nerror_px = 1\ntolerance = 0.1\n[equal.knobs]\npgm = 240\n[equal.off]\npgm = "
        "'far'\n";
    const std::string rest =
        "[camera]\nvertical_fov = 45\nnear = 0.5\n[viewport]\nwidth = 320\nheight = 200\n"
        "[measure]\nevery = 5\ntruth = false\nshots = [0, 9]\neconomy = [3]\nbudget_ms = 33\n"
        "[run]\nrepetitions = 2\nseed = 7\ncell_time_limit_s = 60\nframe_time_limit_s = 5\n"
        "memory_limit_mib = 512\n[[method]]\nid = \"lindstrom\"\ntau = [0.25, 1, 4]\n"
        "[[method]]\nid = \"pgm\"\nflag = true\ntext = \"some\"\n";
    std::vector<std::string> seeds;
    for (const char* flight :
         {"kind = \"line\"\nrelative = true\nstart = [0.1, 0.5, 900]\nend = [0.9, 0.5, 300]\n"
          "pitch = -30\nroll = 5\nframes = 10\nrate_hz = 30\nwarmup_frames = 1\nwarmup_flies = "
          "true\n",
          "kind = \"line\"\nstart = [0, 0, 900]\nheading = 90\nspeed = 250\nabove_ground = "
          "true\nframes = 10\n",
          "kind = \"spline\"\nframes = 10\n[[flight.keyframe]]\nposition = [0, 0, 50]\nheading = "
          "350\n"
          "[[flight.keyframe]]\nposition = [9, 9, 60]\nheading = 10\n"
          "[[flight.keyframe]]\nposition = [90, 9, 60]\nheading = 20\n",
          "kind = \"orbit\"\nrelative = true\ncentre = [0.5, 0.5, 10]\nradius = 3000\nheight = "
          "900\nturns = -2\n"
          "bearing = 90\nframes = 10\n",
          "kind = \"terrain-following\"\nstart = [0, 0]\nend = [90, 0]\nheight = 50\nsmoothing = "
          "9\nmargin = 20\n"
          "frames = 10\n",
          "kind = \"terrain-following\"\nheight = 50\nframes = 10\nspeed = 3\n[[flight.keyframe]]\n"
          "position = [0, 0]\n[[flight.keyframe]]\nposition = [9, 9]\n",
          "kind = \"recorded\"\nfile = \"f.csv\"\nframes = 2\n"}) {
        seeds.push_back("name = \"some_name-1\"\n" + terrain + "[flight]\n" + flight + rest);
    }
    seeds.push_back(
        "[terrain]\nfile = \"t.tif\"\nno_data = -9999\ncold = true\nout_of_core = true\nspacing = "
        "30\n"
        "[flight]\nkind = \"recorded\"\nfile = \"f.csv\"\n");
    return seeds;
}

}  // namespace
}  // namespace lodbench::test

LODBENCH_FUZZ_TARGET(lodbench::test::use_as_scenario, lodbench::test::seeds)
