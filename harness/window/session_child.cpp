#include "window/session_child.h"

#include <GL/glcorearb.h>
#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>

#include "api/error.h"
#include "base/child_process.h"
#include "base/console.h"
#include "gl/host/alive_objects.h"
#include "measure/drawn_surface.h"
#include "measure/pixel_errors.h"
#include "measure/pixel_projection.h"
#include "measure/timer_verdict.h"
#include "picture/truth_panels.h"
#include "results/frame.h"
#include "run/cell.h"
#include "run/exit_status.h"
#include "run/frame_measurer.h"
#include "run/shared_signs.h"
#include "run/stage.h"
#include "run/timing.h"
#include "scenario/camera_track.h"
#include "scenario/scenario.h"
#include "terrain/open_terrain.h"
#include "terrain/toml_file.h"
#include "window/level_picture.h"
#include "window/messages.h"

namespace lodbench::window {
namespace {

constexpr int kShades = 256;

/// 0 to 1 of the scale's top.
std::array<picture::Rgb, kShades> error_colors() {
    std::array<picture::Rgb, kShades> colors;
    for (int i = 0; i < kShades; ++i) {
        colors[std::size_t(i)] = picture::error_color(double(i) / (kShades - 1));
    }
    return colors;
}

void put(std::vector<std::uint8_t>& rgb, std::size_t pixel, picture::Rgb color) {
    rgb[3 * pixel] = color.r;
    rgb[3 * pixel + 1] = color.g;
    rgb[3 * pixel + 2] = color.b;
}

/// Where there is an error, its colour in the place of the shaded one.
void paint_errors(const measure::PixelErrors& errors, double scale_px,
                  std::vector<std::uint8_t>& rgb) {
    static const std::array<picture::Rgb, kShades> colors = error_colors();
    for (std::size_t i = 0; i < errors.marks.size(); ++i) {
        const float error = std::fmax(errors.drawn_px[i], errors.reference_px[i]);
        if ((errors.marks[i] & measure::kCrackMark) != 0) {
            put(rgb, i, picture::kCrackColor);
        } else if (std::isinf(error)) {
            put(rgb, i, picture::kUncoveredColor);
        } else if (!std::isnan(error)) {
            const double share = std::clamp(double(error) / scale_px, 0.0, 1.0);
            put(rgb, i, colors[std::size_t(std::lround(share * (kShades - 1)))]);
        }
    }
}

/// Grey, and cracks in a colour, three pixels wide so that one is seen.
void paint_cracks(const measure::PixelErrors& errors, const Viewport& size,
                  std::vector<std::uint8_t>& rgb) {
    for (std::size_t i = 0; i < errors.marks.size(); ++i) {
        const auto grey = std::uint8_t((rgb[3 * i] + 2 * rgb[3 * i + 1] + rgb[3 * i + 2]) / 4);
        put(rgb, i, {grey, grey, grey});
    }
    for (int row = 0; row < size.height; ++row) {
        for (int column = 0; column < size.width; ++column) {
            const auto mark = errors.marks[std::size_t(row * size.width + column)];
            if ((mark & measure::kCrackMark) == 0) continue;
            for (int y = std::max(row - 1, 0); y <= std::min(row + 1, size.height - 1); ++y) {
                for (int x = std::max(column - 1, 0); x <= std::min(column + 1, size.width - 1);
                     ++x) {
                    put(rgb, std::size_t(y * size.width + x), picture::kCrackColor);
                }
            }
        }
    }
}

class Child {
public:
    Child(int socket, std::shared_ptr<run::VitalSigns> signs, std::uint8_t* picture)
        : socket_(socket), signs_(std::move(signs)), picture_(picture) {}

    int serve() {
        while (const auto message = receive_message(socket_)) {
            Json::Value answer;
            answer["did"] = (*message)["do"];
            try {
                answer = handle(*message);
            } catch (const run::MethodSkipped& error) {
                answer["failed"] = error.what();
            } catch (const run::MethodFailure& error) {
                answer["failed"] = error.what();
            } catch (const std::exception& error) {
                answer["refused"] = error.what();
            }
            const bool failed = answer.isMember("failed");
            if (!send_message(socket_, answer)) break;
            // What a method that failed left behind is nobody's to clean up.
            if (failed) return run::kCellFailed;
        }
        close_stage();
        return run::kAllWell;
    }

private:
    Json::Value handle(const Json::Value& message) {
        const std::string what = message["do"].asString();
        if (what == "open") return open(message);
        if (!stage_) throw InputError("no method is open");
        if (what == "picture") return draw(picture_request(message));
        if (what == "probe") return probe(message["x"].asDouble(), message["y"].asDouble());
        if (what == "measure") return measure(message["frame"].asInt(), message["flown"].asBool());
        throw InputError(fmt::format("there is no '{}'", what));
    }

    Json::Value open(const Json::Value& message) {
        spec_ = run::read_spec(message["spec"].asString(), "message");
        if (message.isMember("timer_trusted")) {  // the process before this one has tested it
            verdict_ = measure::TimerVerdict{message["timer_trusted"].asBool(), "", 0, 0};
        }
        Json::Value answer;
        answer["did"] = "open";
        answer["method"] = spec_.method;
        answer["leaks"] = close_stage();
        load();
        make_stage();
        answer["renderer"] = stage_->device().info().renderer;
        answer["timer_trusted"] = verdict_->trustworthy;
        answer["asynchronous"] = (stage_->method().capabilities & kAsynchronous) != 0;
        return answer;
    }

    /// Once: every method flies over the same.
    void load() {
        if (terrain_) return;
        signs_->enter(run::Call::load_terrain);
        scenario_ = scenario::parse_scenario(
            terrain::read_toml_text(spec_.scenario_file), spec_.scenario_origin,
            scenario::kept_flight(spec_.scenario_file), spec_.overrides);
        terrain_ = terrain::open_terrain_with_provenance(scenario_.terrain).terrain;
        track_.emplace(scenario_, *terrain_);
        signs_->enter(run::Call::none);
    }

    void make_stage() {
        stage_ = std::make_unique<run::Stage>(
            run::StageSetup{
                .terrain = terrain_,
                .plugin = spec_.plugin,
                .method = spec_.method,
                .settings = spec_.settings,
                .device = spec_.device,
                .warn = [](const std::string& words) { base::tell("warning: {}", words); }},
            *signs_);
        stage_->check_state(true);
        if (!verdict_) verdict_ = measure::test_timer(stage_->device());
        alive_ = gl::count_alive_objects();
        stage_->prepare();
        stage_->upload();
        opened_anew_ = true;
    }

    /// What the method did not give back, in words.
    std::string close_stage() {
        if (!stage_) return {};
        levels_.reset();
        forget_surface();
        const bool pure = !drew_reference_ && sized_;
        stage_->release();
        std::string leaks;
        if (pure) {
            gl::AliveObjects expected = alive_;
            expected.textures += 2;  // the stage's own picture
            expected.framebuffers += 1;
            const auto found = gl::differences(expected, gl::count_alive_objects());
            leaks = fmt::format("{}", fmt::join(found, "; "));
        }
        stage_.reset();
        selected_.reset();
        drew_reference_ = sized_ = false;
        return leaks;
    }

    void forget_surface() {
        surface_.reset();
        drawn_.reset();
    }

    void resize(const Viewport& size) {
        stage_->resize(size);
        sized_ = true;
    }

    void select(const Camera& camera, const Clock& clock) {
        forget_surface();
        selected_.reset();
        stage_->select(camera, clock);
        selected_ = camera;
    }

    [[nodiscard]] bool holds(const PictureRequest& request) const {
        return request.frozen && selected_ && selected_->position == request.selected.position &&
               selected_->orientation == request.selected.orientation &&
               selected_->viewport == request.selected.viewport;
    }

    Json::Value draw(const PictureRequest& request) {
        resize(request.selected.viewport);
        PictureReply reply;
        reply.width = request.selected.viewport.width;
        reply.height = request.selected.viewport.height;
        const std::uint64_t uploaded = stage_->method_uploaded_bytes();
        const std::uint64_t calls = stage_->device().draw_calls();
        view_ = request.view;
        const View view = picture_view(request.view);
        glFinish();
        const run::Stopwatch watch;
        const Clock clock{request.frame, double(request.frame) / scenario_.rate_hz};
        if (!holds(request)) select(request.selected, clock);
        reply.select_ms = watch.seconds() * 1e3;
        draw_timed(view, watch, reply);
        reply.uploaded_bytes = stage_->method_uploaded_bytes() - uploaded;
        reply.draw_calls = stage_->device().draw_calls() - calls;
        reply.gpu_bytes = stage_->method_gpu_bytes();
        stage_->pause_background();
        show(paint(request, view, reply));
        stage_->resume_background();
        return to_json(reply);
    }

    /// The method's draw, counted and timed.
    void draw_timed(const View& view, const run::Stopwatch& watch, PictureReply& reply) {
        gl::Query primitives(stage_->device(), "window: primitives", GL_PRIMITIVES_GENERATED);
        gl::Query begin(stage_->device(), "window: begin", GL_TIMESTAMP);
        gl::Query end(stage_->device(), "window: end", GL_TIMESTAMP);
        const double before = watch.seconds();
        begin.timestamp();
        primitives.begin();
        stage_->draw(view);
        primitives.end();
        end.timestamp();
        const double submitted = watch.seconds();
        glFinish();
        reply.wall_ms = watch.seconds() * 1e3;
        reply.submit_ms = (submitted - before) * 1e3;
        // As the timing replay has it.
        reply.gpu_ms = verdict_->trustworthy ? double(end.wait() - begin.wait()) * 1e-6
                                             : reply.wall_ms - before * 1e3;
        reply.triangles = primitives.wait();
    }

    std::vector<std::uint8_t> paint(const PictureRequest& request, const View& view,
                                    PictureReply& reply) {
        const bool judged = request.style == Style::errors || request.style == Style::cracks;
        std::vector<std::uint8_t> rgb;
        measure::PixelErrors errors;
        if (judged) errors = judge(request.view, reply);
        if (request.style == Style::levels) {
            if (!levels_) levels_ = std::make_unique<LevelPicture>(stage_->device());
            const measure::CapturedSurface& captured = surface();
            stage_->draw(view);
            levels_->draw(captured, view, terrain_->info().spacing);
        }
        if (request.wireframe) {
            if (judged) rgb = stage_->read_color();
            stage_->draw_picture(view, true);
        }
        if (rgb.empty()) rgb = stage_->read_color();
        if (request.style == Style::errors) paint_errors(errors, request.scale_px, rgb);
        if (request.style == Style::cracks) paint_cracks(errors, request.view.viewport, rgb);
        return rgb;
    }

    /// Every pixel of the picture that was drawn, against rays through the true surface.
    measure::PixelErrors judge(const Camera& view, PictureReply& reply) {
        const std::vector<float> depth = stage_->read_depth();
        measure::ErrorPool pool;
        measure::PixelErrors errors =
            measure_pixels(reference(), drawn(), view, measure::reference_hits(reference(), view),
                           depth, std::numeric_limits<double>::infinity(), pool);
        const measure::ErrorSummary summary = pool.summary(false);
        reply.pixel_max_px = summary.max;
        reply.pixel_p999_px = summary.p999;
        reply.pixel_rms_px = summary.rms;
        reply.crack_pixels = errors.crack_pixels;
        return errors;
    }

    void show(const std::vector<std::uint8_t>& rgb) const {
        std::memcpy(picture_, rgb.data(), std::min(rgb.size(), kPictureBytes));
    }

    const std::shared_ptr<const terrain::WholeTerrain>& truth() {
        if (!truth_) truth_ = terrain::whole_field(terrain_);
        return truth_;
    }
    const measure::ReferenceTerrain& reference() {
        if (!reference_) reference_.emplace(truth()->samples(), terrain_->info());
        return *reference_;
    }
    const measure::CapturedSurface& surface() {
        if (!surface_) surface_ = stage_->capture();
        return *surface_;
    }
    const measure::DrawnSurface& drawn() {
        if (!drawn_) {
            measure::CapturedSurface copy = surface();
            drawn_ = std::make_unique<measure::DrawnSurface>(std::move(copy), terrain_->info());
        }
        return *drawn_;
    }

    /// At a pixel of the picture that was drawn last, from its top left corner.
    Json::Value probe(double x, double y) {
        ProbeReply reply;
        const int column = int(x), row = int(y);
        const Viewport& size = view_.viewport;
        if (!selected_ || column < 0 || row < 0 || column >= size.width || row >= size.height) {
            return to_json(reply);
        }
        stage_->pause_background();
        stage_->draw(picture_view(view_));
        const std::vector<float> depth = stage_->read_depth();
        const double here =
            double(depth[std::size_t(row) * std::size_t(size.width) + std::size_t(column)]);
        if (here > 0) look(column + 0.5, row + 0.5, view_.near_plane / here, reply);
        stage_->resume_background();
        return to_json(reply);
    }

    void look(double x, double y, double along, ProbeReply& reply) {
        const measure::PixelProjection projection(view_);
        const TerrainInfo& info = terrain_->info();
        const glm::dvec3 point = view_.position + along * projection.direction(x, y);
        const glm::dvec2 place =
            glm::clamp(glm::dvec2(point), info.extent_min(), info.extent_max());
        const glm::dvec2 cells = (place - info.extent_min()) / info.spacing;
        reply.hit = true;
        reply.x = place.x;
        reply.y = place.y;
        reply.column = int(std::lround(cells.x));
        reply.row = info.rows - 1 - int(std::lround(cells.y));
        const measure::HeightInterval ground = reference().interval(place);
        reply.true_low = ground.low;
        reply.true_high = ground.high;
        reply.drawn = drawn().height(place);
        reply.level = level_at(place);
        if (!reply.drawn) return;
        const double nearest = std::clamp(*reply.drawn, ground.low, ground.high);
        reply.error_m = *reply.drawn - nearest;
        reply.error_px = projection
                             .distance(projection.local({place, *reply.drawn}),
                                       projection.local({place, nearest}))
                             .px;
    }

    /// Of the highest captured triangle over a place.
    std::optional<int> level_at(const glm::dvec2& place) {
        const measure::CapturedSurface& captured = surface();
        const glm::dvec2 here = place - glm::dvec2(captured.origin);
        std::optional<int> level;
        double highest = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i + 2 < captured.vertices.size(); i += 3) {
            const glm::dvec3 a(captured.vertices[i]), b(captured.vertices[i + 1]),
                c(captured.vertices[i + 2]);
            const auto cross = [](const glm::dvec2& u, const glm::dvec2& v) {
                return u.x * v.y - u.y * v.x;
            };
            const glm::dvec2 ab(b - a), ac(c - a), ap = here - glm::dvec2(a);
            const double area = cross(ab, ac);
            if (area == 0) continue;
            const double v = cross(ap, ac) / area, w = cross(ab, ap) / area;
            if (v < 0 || w < 0 || v + w > 1) continue;
            const double height = a.z + v * (b.z - a.z) + w * (c.z - a.z);
            if (height <= highest) continue;
            highest = height;
            level = level_of(longest_edge(captured, i), glm::length(terrain_->info().spacing));
        }
        return level;
    }

    /// As the lockstep replay of a cell does, with the same code. `flown`: of that frame of the
    /// scenario's flight, to which a fresh method flies, for what it keeps from frame to frame is
    /// part of what it draws; else of what is selected now.
    Json::Value measure(int frame, bool flown) {
        if (flown && (frame < 0 || frame >= scenario_.frames)) {
            throw InputError(fmt::format("the flight has no frame {}", frame));
        }
        if (!flown && !selected_) throw InputError("nothing was drawn yet");
        results::FrameRecord record;
        record.frame = frame;
        std::uint64_t uploaded = stage_->method_uploaded_bytes();
        if (flown) uploaded = fly_to(frame);
        stage_->settle();
        stage_->pause_background();
        forget_surface();
        const std::uint64_t calls = stage_->device().draw_calls();
        record.triangles = stage_->count_primitives();
        record.draw_calls = stage_->device().draw_calls() - calls;
        record.uploaded_bytes = stage_->method_uploaded_bytes() - uploaded;
        const std::string& bound = stage_->method().claimed_bound;
        std::optional<double> claimed;
        if (!bound.empty()) claimed = stage_->params().real(bound);
        drew_reference_ = true;
        run::FrameMeasurer measurer(*stage_, claimed, truth());
        measurer.take(frame, record, nullptr);
        measurer.measure(record);
        stage_->resume_background();
        Json::Value answer;
        answer["did"] = "measure";
        answer["flown"] = flown;
        answer["record"] = results::encode(record);
        return answer;
    }

    /// Bytes that were uploaded before the last selection.
    std::uint64_t fly_to(int frame) {
        if (!opened_anew_) {
            static_cast<void>(close_stage());
            make_stage();
        }
        resize(scenario_.viewport);
        for (int i = 0; i < scenario_.warmup_frames; ++i) {
            const int first = std::min(track_->first_frame() + i, 0);
            select(track_->camera(first), track_->clock(first));
            stage_->draw_picture();
        }
        std::uint64_t uploaded = 0;
        for (int f = 0; f <= frame; ++f) {
            uploaded = stage_->method_uploaded_bytes();
            select(track_->camera(f), track_->clock(f));
            stage_->settle();
        }
        view_ = track_->camera(frame);
        opened_anew_ = false;
        return uploaded;
    }

    int socket_;
    std::shared_ptr<run::VitalSigns> signs_;
    std::uint8_t* picture_;
    run::CellSpec spec_;
    scenario::Scenario scenario_;
    std::shared_ptr<const Terrain> terrain_;
    std::optional<scenario::CameraTrack> track_;
    std::shared_ptr<const terrain::WholeTerrain> truth_;
    std::optional<measure::ReferenceTerrain> reference_;  // of truth_
    std::optional<measure::TimerVerdict> verdict_;
    std::unique_ptr<run::Stage> stage_;
    std::unique_ptr<LevelPicture> levels_;  // needs the stage
    gl::AliveObjects alive_;                // before the method made any
    std::optional<Camera> selected_;
    Camera view_;                                      // of the last picture
    std::optional<measure::CapturedSurface> surface_;  // of the selection
    std::unique_ptr<measure::DrawnSurface> drawn_;     // of surface_
    bool drew_reference_ = false, sized_ = false, opened_anew_ = false;
};

}  // namespace

int serve_session(int socket, int signs, int picture) {
    void* const memory =
        mmap(nullptr, kPictureBytes, PROT_READ | PROT_WRITE, MAP_SHARED, picture, 0);
    if (memory == MAP_FAILED) {
        throw EnvironmentError(
            fmt::format("the memory for pictures cannot be mapped: {}", std::strerror(errno)));
    }
    return Child(socket, run::map_signs(signs), static_cast<std::uint8_t*>(memory)).serve();
}

}  // namespace lodbench::window
