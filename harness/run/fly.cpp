// One cell: load, prepare, then the same flight twice. The timing replay captures nothing; the
// lockstep replay counts and measures and is never timed. A picture that both draw ties them
// together. An asynchronous method flies a third time, at the pace that the timing replay had: what
// it drew then is what that pace showed.

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <new>
#include <thread>
#include <utility>

#include "base/debugger.h"
#include "base/files.h"
#include "base/hash.h"
#include "base/modules.h"
#include "measure/timer_verdict.h"
#include "picture/png.h"
#include "run/cell.h"
#include "run/flight_record.h"
#include "run/frame_measurer.h"
#include "run/stage.h"
#include "run/timing.h"
#include "scenario/camera_track.h"
#include "scenario/scenario.h"
#include "terrain/mapped_terrain.h"
#include "terrain/open_terrain.h"
#include "terrain/toml_file.h"

namespace lodbench::run {

namespace {

scenario::Scenario read_scenario(const CellSpec& spec) {
    return scenario::parse_scenario(terrain::read_toml_text(spec.scenario_file),
                                    spec.scenario_origin, scenario::kept_flight(spec.scenario_file),
                                    spec.overrides);
}

double process_cpu_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// VmHWM, the highest resident size so far.
std::optional<std::uint64_t> peak_rss_bytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
    }
    return std::nullopt;
}

std::string file_checksum(const std::filesystem::path& file) {
    base::Fnv1a hash;
    for (const char byte : base::read_text(file)) hash.add(static_cast<unsigned char>(byte));
    return hash.hex();
}

class Flight {
public:
    Flight(const CellSpec& spec, VitalSigns& signs, results::CellResult& result)
        : spec_(spec), signs_(signs), result_(result), scenario_(read_scenario(spec)) {}

    void fly() {
        open();
        prepare();
        choose_frames();
        const int replays = 2 + int(measures_realtime()) + int(measures_whole());
        signs_.frames_total = replays * (scenario_.warmup_frames + scenario_.frames);
        fly_for_time();
        // The method's own: what measuring needs comes later.
        result_.cell.peak_rss_bytes = peak_rss_bytes();
        result_.cell.samples_served = stage_->served().samples_served();
        result_.cell.tiles_served = stage_->served().tiles_served();
        result_.cell.terrain_bytes_read = stage_->served().bytes_read();
        fly_in_lockstep();
        if (measures_realtime()) fly_in_real_time();
        if (measures_whole()) fly_for_whole();
        measurer_->finish(result_.cell);
        measurer_->write_picture(shot_path("worst"), spec_.id);
        measurer_.reset();
        stage_->release();
        const std::vector<std::string> warnings =
            record_flight(spec_.out, scenario_.name, *terrain_, scenario_.frames,
                          [this](int frame) { return camera_at(frame); });
        result_.flight_warnings.insert(result_.flight_warnings.end(), warnings.begin(),
                                       warnings.end());
    }

    [[nodiscard]] std::string where() const {
        return replay_ == Replay::none
                   ? ""
                   : fmt::format(", frame {} of the {} replay", frame_, name_of(replay_));
    }

    /// True once the plugin was opened: what fails in this process from then on may be its doing.
    [[nodiscard]] bool plugin_opened() const {
        return opened_ || signs_.call.load() >= Call::open_plugin;
    }

private:
    void open();
    [[nodiscard]] std::string plugin_checksum() const;
    void warn(std::string words);
    void make_stage(const Settings& settings);
    void start_anew(const Settings& settings);  ///< a method as fresh as for the timing replay
    void prepare();
    void choose_frames();
    void fly_for_time();
    void fly_in_lockstep();
    void fly_in_real_time();
    void fly_for_whole();
    void warm_up();
    [[nodiscard]] bool is_asynchronous() const {
        return (stage_->method().capabilities & kAsynchronous) != 0;
    }
    [[nodiscard]] bool measures_realtime() const { return is_asynchronous() && measures_truth(); }
    /// Lockstep replays agree to the bit: one repetition says it all.
    [[nodiscard]] bool measures_truth() const {
        return scenario_.measure.truth && spec_.repetition == 0;
    }
    [[nodiscard]] bool measures_whole() const {
        return scenario_.measure.whole && measures_truth();
    }
    /// The cell's, with culling off where the method has it.
    [[nodiscard]] Settings settings_without_culling() const;
    [[nodiscard]] bool is_shot(int frame) const {
        return std::ranges::find(shots_, frame) != shots_.end();
    }
    /// What is measured against; nothing where nothing is.
    [[nodiscard]] std::shared_ptr<const terrain::WholeTerrain> whole_terrain() const;
    void measure_frame(int frame);
    void shoot(int frame);  ///< the picture that is drawn, and its wireframe
    [[nodiscard]] std::filesystem::path shot_path(const std::string& which) const {
        return spec_.out / "shots" / fmt::format("{}__{}.png", spec_.id, which);
    }
    void begin_frame(int frame) {
        frame_ = frame;
        signs_.frame = frame;
        signs_.frames_begun.fetch_add(1, std::memory_order_relaxed);
        signs_.beats.fetch_add(1, std::memory_order_relaxed);
    }
    void begin_replay(Replay replay) {
        replay_ = replay;
        signs_.frames_of_replay = scenario_.frames;
        signs_.replay = replay;
    }
    [[nodiscard]] Camera camera_at(int frame) const { return track_->camera(frame); }
    [[nodiscard]] Clock clock_at(int frame) const { return track_->clock(frame); }

    const CellSpec& spec_;
    VitalSigns& signs_;
    results::CellResult& result_;
    scenario::Scenario scenario_;
    std::shared_ptr<const Terrain> terrain_;          ///< what the harness reads
    std::shared_ptr<const Terrain> methods_terrain_;  ///< the same; its reading is the method's own
    std::optional<scenario::CameraTrack> track_;
    std::unique_ptr<Stage> stage_;
    std::unique_ptr<FrameMeasurer> measurer_;  // needs the stage
    measure::TimerVerdict verdict_;
    std::vector<int> shots_;
    int hashed_frame_ = 0;
    std::string timing_hash_;
    Replay replay_ = Replay::none;
    int frame_ = 0;
    bool opened_ = false;
};

/// Each warning once: a method that is made anew for another replay does the same again.
void Flight::warn(std::string words) {
    if (std::ranges::find(result_.cell.warnings, words) == result_.cell.warnings.end()) {
        result_.cell.warnings.push_back(std::move(words));
    }
}

void Flight::open() {
    signs_.enter(Call::load_terrain);
    terrain::OpenTerrain opened = terrain::open_terrain_with_provenance(scenario_.terrain);
    terrain_ = std::move(opened.terrain);
    result_.flight_warnings = std::move(opened.provenance.warnings);
    const bool stored = std::dynamic_pointer_cast<const terrain::HeightField>(terrain_) == nullptr;
    methods_terrain_ = stored ? terrain::open_terrain(scenario_.terrain) : terrain_;
    // Known before an hour's flight, not after.
    if (stored && measures_truth() && !scenario_.terrain.out_of_core) {
        terrain::require_room_for_whole(terrain_->info());
    }
    track_.emplace(scenario_, *terrain_);
    result_.cell.plugin_checksum = plugin_checksum();
    result_.cell.terrain = terrain_->info().name;
    result_.cell.terrain_checksum = terrain_->info().checksum;
    signs_.enter(Call::start);
    if (spec_.wait_for_debugger) {
        signs_.enter(Call::open_plugin);
        // Stays mapped, so that breakpoints find its functions.
        static_cast<void>(PluginLibrary(spec_.plugin));
        base::await_debugger();
    }
    make_stage(spec_.settings);
    if (const std::string now = plugin_checksum(); now != result_.cell.plugin_checksum) {
        // Which of the two was opened nobody knows: the cell has none.
        const std::string before = std::exchange(result_.cell.plugin_checksum, "");
        throw MethodFailure(
            fmt::format("plugin {} changed while it was opened: its checksum was {} and is {}",
                        spec_.plugin.string(), before, now));
    }
    const gl::DeviceInfo& info = stage_->device().info();
    result_.gl_vendor = info.vendor;
    result_.gl_renderer = info.renderer;
    result_.gl_version = info.version;
    result_.software = info.software;
    result_.device_description = stage_->context().description();
    signs_.gpu.write(stage_->context().gpu());
    signs_.gpu_told = 1;
    if (const std::string& bound = stage_->method().claimed_bound; !bound.empty()) {
        result_.cell.claimed_px = stage_->params().real(bound);
    }
    if (scenario_.terrain.out_of_core && (stage_->method().capabilities & kOutOfCore) == 0) {
        throw MethodSkipped(fmt::format(
            "method '{}' holds the whole terrain in memory, and the scenario is out of core",
            stage_->method().id));
    }
    verdict_ = measure::test_timer(stage_->device());
    result_.cell.timer_verdict = verdict_.text;
}

/// Of the file as it is now: 16 hex digits. It was there when it was listed.
std::string Flight::plugin_checksum() const {
    try {
        return file_checksum(spec_.plugin);
    } catch (const EnvironmentError& error) {
        throw MethodFailure(error.what());
    }
}

void Flight::make_stage(const Settings& settings) {
    stage_.reset();  // one context at a time
    stage_ = std::make_unique<Stage>(
        StageSetup{.terrain = methods_terrain_,
                   .plugin = spec_.plugin,
                   .method = spec_.method,
                   .settings = settings,
                   .device = spec_.device,
                   .warn = [this](std::string words) { warn(std::move(words)); }},
        signs_);
    opened_ = true;
    stage_->check_state(true);
}

void Flight::prepare() {
    const Stopwatch wall;
    const double cpu = process_cpu_seconds();
    stage_->prepare();
    glFinish();
    result_.cell.samples_prepared = stage_->served().samples_served();
    result_.cell.prepare_s = wall.seconds();
    result_.cell.prepare_cpu_s = process_cpu_seconds() - cpu;
    const Stopwatch upload;
    stage_->upload();
    glFinish();
    result_.cell.upload_s = upload.seconds();
    stage_->resize(scenario_.viewport);
}

void Flight::choose_frames() {
    shots_ = scenario_.measure.shots;
    if (shots_.empty()) shots_ = {0, scenario_.frames / 2, scenario_.frames - 1};
    // The frame whose picture is compared between the replays: by the seed, different per
    // repetition.
    base::SplitMix64 random(spec_.seed);
    random.skip(std::uint64_t(spec_.repetition));
    hashed_frame_ = int(random.below(std::uint64_t(scenario_.frames)));
}

void Flight::warm_up() {
    for (int i = 0; i < scenario_.warmup_frames; ++i) {
        const int frame = std::min(track_->first_frame() + i, 0);
        begin_frame(0);
        const Stopwatch wall;
        stage_->select(camera_at(frame), clock_at(frame));
        stage_->draw_picture();
        glFinish();
        if (!result_.cell.first_frame_ms) result_.cell.first_frame_ms = 1e3 * wall.seconds();
    }
}

void Flight::fly_for_time() {
    begin_replay(Replay::timing);
    warm_up();
    stage_->check_state(false);
    FrameTimer timer(stage_->device(), verdict_);
    result_.frames.resize(std::size_t(scenario_.frames));
    for (int frame = 0; frame < scenario_.frames; ++frame) {
        begin_frame(frame);
        const Camera camera = camera_at(frame);
        const View view = picture_view(camera);
        timer.begin_frame();
        stage_->select(camera, clock_at(frame));
        timer.end_select();
        stage_->draw(view);
        timer.end_submit();
        if (frame == hashed_frame_) {
            timer.drain();
            timing_hash_ = stage_->depth_hash();
        }
    }
    timer.finish();
    result_.cell.warmup_frames = scenario_.warmup_frames;
    result_.cell.frames_in_flight = timer.frames_in_flight();
    for (int frame = 0; frame < scenario_.frames; ++frame) {
        const FrameTimes& times = timer.frames()[std::size_t(frame)];
        results::FrameRecord& record = result_.frames[std::size_t(frame)];
        record.frame = frame;
        record.wall_ms = times.wall_ms;
        record.select_ms = times.select_ms;
        record.submit_ms = times.submit_ms;
        record.cpu_ms = times.cpu_ms;
        record.gpu_ms = times.gpu_ms;
    }
    if (!result_.cell.first_frame_ms) {  // no warm-up
        result_.cell.first_frame_ms = result_.frames.front().wall_ms;
    }
    if (!timer.warning().empty()) result_.cell.warnings.push_back(timer.warning());
    stage_->check_state(true);
}

void Flight::fly_in_lockstep() {
    begin_replay(Replay::lockstep);
    // Not before: what it takes is none of the method's.
    signs_.enter(Call::load_terrain);
    const std::shared_ptr<const terrain::WholeTerrain> truth = whole_terrain();
    signs_.enter(Call::none);
    measurer_ = std::make_unique<FrameMeasurer>(
        *stage_, measures_truth() ? result_.cell.claimed_px : std::nullopt, truth,
        ViewCache(spec_.views, scenario_.name, result_.cell.terrain_checksum,
                  result_.gl_vendor + "\n" + result_.gl_renderer + "\n" + result_.gl_version),
        scenario_.measure.pixels_only ? measure::Extent::pixels : measure::Extent::all);
    warm_up();  // as the timing replay began
    std::map<std::string, double> sums;
    base::Fnv1a shots_hash;
    for (int frame = 0; frame < scenario_.frames; ++frame) {
        begin_frame(frame);
        results::FrameRecord& record = result_.frames[std::size_t(frame)];
        const std::uint64_t uploaded = stage_->method_uploaded_bytes();
        stage_->select(camera_at(frame), clock_at(frame));
        stage_->settle();
        // What is counted, captured and drawn from here on is one selection.
        stage_->pause_background();
        const std::uint64_t draw_calls = stage_->device().draw_calls();
        record.triangles = stage_->count_primitives();
        record.draw_calls = stage_->device().draw_calls() - draw_calls;
        record.uploaded_bytes = stage_->method_uploaded_bytes() - uploaded;
        for (const auto& [name, value] : stage_->counters()) {
            // What is counted since the beginning has its last value; of the rest the mean is told.
            double& sum = sums[name];
            sum = name.ends_with("_so_far") ? value * scenario_.frames : sum + value;
        }
        measure_frame(frame);
        if (frame == hashed_frame_) {
            stage_->draw_picture();
            result_.cell.depth_hash = stage_->depth_hash();
            if (!is_asynchronous() && result_.cell.depth_hash != timing_hash_) {
                throw MethodFailure(fmt::format(
                    "plugin {} draws another picture in the timing replay (depth hash {}) than in "
                    "lockstep ({}): what is measured would not be what is timed",
                    spec_.plugin.filename().string(), timing_hash_, result_.cell.depth_hash));
            }
        }
        if (is_shot(frame)) {
            stage_->draw_picture();
            stage_->add_depth_to(shots_hash);
            if (spec_.repetition == 0) shoot(frame);
        }
        stage_->resume_background();
    }
    result_.cell.shots_hash = shots_hash.hex();
    for (const auto& [name, sum] : sums) {
        result_.cell.counters.emplace_back(name, sum / scenario_.frames);
    }
    const auto empty = std::ranges::count(result_.frames, 0U, &results::FrameRecord::triangles);
    if (empty > 0) {
        result_.cell.warnings.push_back(
            fmt::format("drew no triangle in {} of {} frames", empty, scenario_.frames));
    }
    result_.cell.gpu_bytes = stage_->method_gpu_bytes();
}

std::shared_ptr<const terrain::WholeTerrain> Flight::whole_terrain() const {
    if (!measures_truth()) return nullptr;
    if (!scenario_.terrain.out_of_core) return terrain::whole_field(terrain_);
    return std::make_shared<const terrain::MappedTerrain>(terrain_, spec_.out);
}

/// Every n-th frame, and for popping the frame after it.
void Flight::measure_frame(int frame) {
    const int every = scenario_.measure.every;
    const bool economy = measures_truth() && std::ranges::find(scenario_.measure.economy, frame) !=
                                                 scenario_.measure.economy.end();
    const bool measured = frame % every == 0 || economy;
    const bool successor =
        measures_truth() && !scenario_.measure.pixels_only && frame > 0 && (frame - 1) % every == 0;
    if (!measured && !successor) return;
    results::FrameRecord* const before =
        successor ? &result_.frames[std::size_t(frame - 1)] : nullptr;
    measurer_->take(frame, result_.frames[std::size_t(frame)], before);
    if (measured) measurer_->measure(result_.frames[std::size_t(frame)]);
    if (!economy) return;
    signs_.enter(Call::none);  // it takes seconds, and none of them are the method's
    measurer_->find_economy();
}

void Flight::start_anew(const Settings& settings) {
    stage_->release();
    make_stage(settings);
    stage_->prepare();
    stage_->upload();
    stage_->resize(scenario_.viewport);
    measurer_->move_to(*stage_);
}

/// A method as fresh as in the timing replay: what the lockstep replay loaded and settled would
/// flatter it. Frame f begins when the frames before it had taken what they took in the timing
/// replay; the time that measuring takes stands still.
void Flight::fly_in_real_time() {
    start_anew(spec_.settings);
    begin_replay(Replay::realtime);
    warm_up();
    const Stopwatch clock;
    double begins_s = 0;
    double measuring_s = 0;
    double late_s = 0;
    for (int frame = 0; frame < scenario_.frames; ++frame) {
        begin_frame(frame);
        while (clock.seconds() - measuring_s < begins_s) {
            std::this_thread::sleep_for(std::chrono::microseconds(200));
        }
        late_s = std::max(late_s, clock.seconds() - measuring_s - begins_s);
        begins_s += result_.frames[std::size_t(frame)].wall_ms * 1e-3;
        const Camera camera = camera_at(frame);
        stage_->select(camera, clock_at(frame));
        stage_->draw(picture_view(camera));
        glFinish();
        if (frame % scenario_.measure.every != 0) continue;
        const Stopwatch measuring;
        stage_->pause_background();
        measurer_->measure_realtime(frame);
        // Not before: the time that measuring takes is none of the flight's.
        stage_->resume_background();
        measuring_s += measuring.seconds();
    }
    constexpr double kTolerated = 0.05;
    if (late_s > kTolerated * begins_s) {
        result_.cell.warnings.push_back(fmt::format(
            "the real-time replay fell {:.1f} ms behind the timing replay's pace, over {:.1f} ms: "
            "background work had more time than that pace gives it",
            late_s * 1e3, begins_s * 1e3));
    }
}

Settings Flight::settings_without_culling() const {
    Settings settings = spec_.settings;
    if (culling_param(stage_->method()) == nullptr) return settings;
    std::erase_if(settings, [](const auto& setting) { return setting.first == "culling"; });
    settings.emplace_back("culling", "false");
    return settings;
}

/// The flight once more in lockstep, for the surface that a method draws of all the terrain. What
/// was measured of it with culling stays as it is.
void Flight::fly_for_whole() {
    start_anew(settings_without_culling());
    begin_replay(Replay::whole);
    warm_up();
    for (int frame = 0; frame < scenario_.frames; ++frame) {
        begin_frame(frame);
        stage_->select(camera_at(frame), clock_at(frame));
        stage_->settle();
        if (frame % scenario_.measure.every != 0) continue;
        stage_->pause_background();
        measurer_->measure_whole(result_.frames[std::size_t(frame)]);
        if (is_shot(frame)) {
            measurer_->write_heights(
                shot_path(fmt::format("f{:05}__heights", frame)),
                fmt::format("{}, frame {}: height difference over all of the terrain", spec_.id,
                            frame));
        }
        stage_->resume_background();
    }
}

void Flight::shoot(int frame) {
    const auto path = [&](const char* suffix) {
        return shot_path(fmt::format("f{:05}{}", frame, suffix));
    };
    const Viewport& size = scenario_.viewport;
    picture::write_png(path(""), size.width, size.height, stage_->read_color());
    stage_->draw_picture(true);
    picture::write_png(path("__wireframe"), size.width, size.height, stage_->read_color());
}

}  // namespace

results::CellResult fly_cell(const CellSpec& spec, VitalSigns& signs) {
    results::CellResult result;
    result.cell.cell = spec.id;
    result.cell.method = spec.method;
    result.cell.scenario = spec.scenario_file.stem().string();
    std::unique_ptr<Flight> flight;
    const auto where = [&] { return flight ? flight->where() : std::string(); };
    // Descriptors, limits and the plugin's own file are the plugin's to spoil; what was asked for
    // had been checked before the plugin was opened.
    const auto blame = [&](const char* words, std::string& else_of) {
        if (flight && flight->plugin_opened()) {
            result.cell.status = results::CellStatus::failed;
            result.cell.reason = words + where();
        } else {
            else_of = words;
        }
    };
    try {
        flight = std::make_unique<Flight>(spec, signs, result);
        flight->fly();
        result.cell.status = results::CellStatus::ok;
        result.cell.modules = base::loaded_modules();
    } catch (const MethodSkipped& skipped) {
        result.cell.status = results::CellStatus::skipped;
        result.cell.reason = skipped.what();
    } catch (const TerrainError& error) {
        // Met by the harness: the path follows the ground, or the truth needs the whole. It is this
        // terrain's, and other cells may fly another.
        result.cell.status = results::CellStatus::failed;
        result.cell.reason = fmt::format("reading the terrain: {}{}", error.what(), where());
    } catch (const base::DiskFullError& error) {
        result.environment_error = error.what();  // no plugin's to spoil
    } catch (const EnvironmentError& error) {
        blame(error.what(), result.environment_error);
    } catch (const InputError& error) {
        blame(error.what(), result.input_error);
    } catch (const std::bad_alloc&) {
        result.cell.status = results::CellStatus::failed;
        result.cell.reason = "memory ran out" + where();
    } catch (const std::exception& error) {
        result.cell.status = results::CellStatus::failed;
        result.cell.reason = error.what() + where();
    }
    flight.reset();  // what the method does while it is destroyed is warned of as well
    // A plugin's words may hold anything; a reason is one line.
    std::ranges::replace_if(
        result.cell.reason, [](unsigned char c) { return c < 0x20; }, ' ');
    if (result.cell.status != results::CellStatus::ok) forget_measured(result);
    return result;
}

}  // namespace lodbench::run
