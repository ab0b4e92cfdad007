#include "run/stage.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <optional>

#include "api/error.h"
#include "base/console.h"
#include "base/hash.h"
#include "base/printable.h"
#include "gl/frame_blocks.h"
#include "gl/host/state.h"

namespace lodbench::run {

namespace {

constexpr float kSky[] = {0.62F, 0.74F, 0.88F, 1.0F};

}  // namespace

Stage::Stage(StageSetup setup, VitalSigns& signs)
    : setup_(std::move(setup)),
      served_(setup_.terrain),
      plugin_name_(setup_.plugin.filename().string()),
      signs_(signs),
      process_(getpid()),
      modes_(FloatModes::capture()),
      context_(std::make_unique<platform::Context>(setup_.device)),
      device_(std::make_unique<gl::Device>()),
      library_((signs.enter(Call::open_plugin), setup_.plugin)) {
    end_copies("a constructor");
    restore_process("a constructor that runs while it is loaded");
    info_ = find_method({{setup_.plugin, library_.methods(), ""}}, setup_.method,
                        "plugin " + setup_.plugin.string());
    params_ = make_params(info_, setup_.settings, "settings of " + setup_.method);
    signs_.enter(Call::none);  // not before: a plugin that was exchanged is at fault for the above
    for (const std::string& extension : info_.gl_extensions) {
        if (!device_->has_extension(extension)) {
            throw MethodSkipped(fmt::format("method '{}' needs {}, which {} does not have",
                                            info_.id, extension, device_->info().renderer));
        }
    }
    device_->set_context_factory([this] { return context_->make_shared(); });
    frame_block_ = gl::Buffer(*device_, "host: Frame", sizeof(gl::Frame));
    frozen_block_ = gl::Buffer(*device_, "host: Frozen", sizeof(gl::Frozen));
    guarded(Call::create, [&] { method_ = library_.create(info_.id, params_); });
}

Stage::~Stage() {
    if (uploaded_) {
        // Only on the way out of a failure: a second one changes nothing any more.
        try {
            release();
        } catch (const std::exception&) {
        }
    }
    signs_.enter(Call::destroy);
    method_.reset();
    end_copies(name_of(Call::destroy));
    restore_process(name_of(Call::destroy));
    for (const std::string& what : unplaced_) warn_once(what, "the timing replay");
    signs_.enter(Call::none);
}

void Stage::check_state(bool on) {
    // What a replay without checks left is not the next call's; which call does it, a replay with
    // checks may show.
    if (on && !check_state_) {
        for (std::string& what : process_state_.restore()) unplaced_.insert(std::move(what));
    }
    check_state_ = on;
}

void Stage::restore_process(const char* where) {
    warn_of(modes_.restore(), where);
    warn_of(process_state_.restore(), where);
}

void Stage::warn_of(const std::vector<std::string>& changed, const char* where) {
    for (const std::string& what : changed) warn_once(what, where);
}

void Stage::warn_once(const std::string& what, const char* where) {
    if (!warned_.insert(what).second || !setup_.warn) return;
    setup_.warn(fmt::format("left {} changed in {}", what, where));
}

/// A plugin that forks and comes back twice would have two processes write one result.
void Stage::end_copies(const char* where) {
    if (getpid() == process_) return;
    base::tell("a copy of the process came back from {} of plugin {} and was ended", where,
               plugin_name_);
    signs_.copies.fetch_add(1);
    _exit(0);
}

void Stage::guarded(Call call, const std::function<void()>& body) {
    std::optional<gl::PipelineState> before;
    if (check_state_) before = gl::PipelineState::capture();
    const std::uint64_t allocated = device_->allocated_bytes();
    const std::uint64_t uploaded = device_->uploaded_bytes();
    signs_.enter(call);
    std::exception_ptr thrown;
    try {
        body();
    } catch (...) {
        thrown = std::current_exception();
    }
    end_copies(name_of(call));
    if (thrown) fail(call, thrown);
    signs_.enter(Call::none);
    warn_of(modes_.restore(), name_of(call));
    if (check_state_) {
        warn_of(process_state_.restore(), name_of(call));
        if (const std::string lowered = process_state_.raise_limits(); !lowered.empty()) {
            throw MethodFailure(fmt::format("{} of plugin {} lowered a limit of its process: {}",
                                            name_of(call), plugin_name_, lowered));
        }
    }
    allocated_bytes_ += std::int64_t(device_->allocated_bytes() - allocated);
    peak_bytes_ = std::max(peak_bytes_, allocated_bytes_);
    uploaded_bytes_ += device_->uploaded_bytes() - uploaded;
    auto errors = device_->take_errors();
    // A method that switched the driver's messages off is caught by the error flag.
    if (check_state_ && glGetError() != GL_NO_ERROR && errors.empty()) {
        errors.emplace_back("glGetError says so, the debug messages do not");
    }
    if (!errors.empty()) {
        throw MethodFailure(fmt::format(
            "{} of plugin {} raised {} GL error{}, the first: {}", name_of(call), plugin_name_,
            errors.size(), errors.size() == 1 ? "" : "s", base::bounded(errors.front())));
    }
    if (before) {
        const auto differences = before->differences(gl::PipelineState::capture());
        if (!differences.empty()) {
            before->restore();
            throw MethodFailure(fmt::format("{} of plugin {} left GL state changed: {}",
                                            name_of(call), plugin_name_,
                                            fmt::join(differences, "; ")));
        }
    }
}

void Stage::fail(Call call, const std::exception_ptr& thrown) const {
    try {
        std::rethrow_exception(thrown);
    } catch (const UnsupportedError& error) {
        throw MethodSkipped(
            fmt::format("method '{}' cannot run here: {}", info_.id, base::bounded(error.what())));
    } catch (const std::exception& error) {
        throw MethodFailure(fmt::format("{} of plugin {} threw: {}", name_of(call), plugin_name_,
                                        base::bounded(error.what())));
    } catch (...) {
        throw MethodFailure(
            fmt::format("{} of plugin {} threw something that is not a std::exception",
                        name_of(call), plugin_name_));
    }
}

void Stage::prepare() {
    guarded(Call::prepare, [&] { method_->prepare(served_, *device_); });
}

void Stage::upload() {
    uploaded_ = true;
    guarded(Call::upload, [&] { method_->upload(*device_); });
}

void Stage::resize(const Viewport& viewport) {
    if (viewport == viewport_) return;
    viewport_ = viewport;
    framebuffer_ = {};
    color_ = gl::Texture(*device_, "host: color", GL_TEXTURE_2D, GL_RGBA8, viewport.width,
                         viewport.height);
    depth_ = gl::Texture(*device_, "host: depth", GL_TEXTURE_2D, GL_DEPTH_COMPONENT32F,
                         viewport.width, viewport.height);
    framebuffer_ = gl::Framebuffer(*device_, "host: picture", &color_, &depth_);
    set_pipeline_state();
    guarded(Call::resize, [&] { method_->resize(viewport); });
}

void Stage::select(const Camera& camera, const Clock& clock) {
    camera_ = camera;
    const gl::Frozen frozen = gl::make_frozen(camera, setup_.terrain->info());
    frozen_block_.write(0, sizeof frozen, &frozen);
    frozen_block_.bind_uniform(gl::kFrozenBinding);
    guarded(Call::select, [&] { method_->select(camera, clock); });
}

void Stage::settle() {
    guarded(Call::settle, [&] { method_->settle(); });
}

void Stage::pause_background() {
    guarded(Call::pause_background, [&] { method_->pause_background(); });
}

void Stage::resume_background() {
    guarded(Call::resume_background, [&] { method_->resume_background(); });
}

Counters Stage::counters() {
    Counters result;
    guarded(Call::counters, [&] { result = method_->counters(); });
    return result;
}

void Stage::release() {
    uploaded_ = false;
    guarded(Call::release, [&] { method_->release(*device_); });
}

void Stage::set_pipeline_state() {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, viewport_.width, viewport_.height);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_STENCIL_TEST);
    // Strips and mapped grids turn their triangles either way round; a terrain is seen from both
    // sides.
    glDisable(GL_CULL_FACE);
    glDisable(GL_RASTERIZER_DISCARD);
    glDisable(GL_PRIMITIVE_RESTART);
    glDisable(GL_POLYGON_OFFSET_LINE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    for (GLenum i = 0; i < 4; ++i) glEnable(GL_CLIP_DISTANCE0 + i);
}

void Stage::fill_blocks(const View& view, bool wireframe) {
    const gl::Frame frame = gl::make_frame(view, camera_, setup_.terrain->info(), wireframe);
    frame_block_.write(0, sizeof frame, &frame);
    frame_block_.bind_uniform(gl::kFrameBinding);
    frozen_block_.bind_uniform(gl::kFrozenBinding);
}

void Stage::begin_picture(const View& view) {
    set_pipeline_state();
    const float farthest = 0.0F;
    glClearNamedFramebufferfv(framebuffer_.name(), GL_COLOR, 0, kSky);
    glClearNamedFramebufferfv(framebuffer_.name(), GL_DEPTH, 0, &farthest);
    fill_blocks(view, false);
}

void Stage::draw(const View& view) {
    begin_picture(view);
    guarded(Call::draw, [&] { method_->draw(view); });
}

void Stage::draw_reference_picture(const std::shared_ptr<const terrain::WholeTerrain>& whole,
                                   const measure::HiddenGround* hidden) {
    if (!reference_picture_) {
        reference_picture_ = std::make_unique<ReferencePicture>(*device_, whole);
    }
    begin_picture(picture_view(camera_));
    // A large terrain takes a software rasteriser longer than silence is allowed to last.
    reference_picture_->draw(camera_, hidden, [&] { signs_.enter(Call::none); });
    // Left to the next call of the method, they would be laid at its door.
    if (const auto errors = device_->take_errors(); !errors.empty()) {
        throw EnvironmentError(
            fmt::format("drawing the reference picture: {} GL error{}, the first: {}",
                        errors.size(), errors.size() == 1 ? "" : "s", errors.front()));
    }
}

void Stage::draw_picture(bool wireframe) {
    draw_picture(picture_view(camera_), wireframe);
}

void Stage::draw_picture(const View& view, bool wireframe) {
    draw(view);
    if (!wireframe) return;
    fill_blocks(view, true);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    // Depth is reversed: a positive offset is towards the eye.
    glEnable(GL_POLYGON_OFFSET_LINE);
    glPolygonOffset(1.0F, 1.0F);
    guarded(Call::draw, [&] { method_->draw(view); });
    set_pipeline_state();
}

measure::CapturedSurface Stage::capture() {
    const measure::CaptureView view = measure::capture_view(camera_, setup_.terrain->info());
    set_pipeline_state();
    fill_blocks(view.view, false);
    return measure::capture(*device_, view,
                            [&] { guarded(Call::draw, [&] { method_->draw(view.view); }); });
}

std::uint64_t Stage::count_primitives() {
    set_pipeline_state();
    fill_blocks(picture_view(camera_), false);
    gl::Query query(*device_, "host: primitives", GL_PRIMITIVES_GENERATED);
    glEnable(GL_RASTERIZER_DISCARD);
    query.begin();
    guarded(Call::draw, [&] { method_->draw(picture_view(camera_)); });
    query.end();
    glDisable(GL_RASTERIZER_DISCARD);
    return query.wait();
}

std::vector<float> Stage::read_depth() {
    const std::size_t width = std::size_t(viewport_.width);
    const std::size_t height = std::size_t(viewport_.height);
    std::vector<float> upward(width * height);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, viewport_.width, viewport_.height, GL_DEPTH_COMPONENT, GL_FLOAT,
                 upward.data());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    std::vector<float> rows(upward.size());
    for (std::size_t row = 0; row < height; ++row) {
        std::copy_n(&upward[(height - 1 - row) * width], width, &rows[row * width]);
    }
    return rows;
}

std::vector<std::uint8_t> Stage::read_color() {
    const std::size_t stride = 3 * std::size_t(viewport_.width);
    const std::size_t height = std::size_t(viewport_.height);
    std::vector<std::uint8_t> upward(stride * height);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, viewport_.width, viewport_.height, GL_RGB, GL_UNSIGNED_BYTE, upward.data());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    std::vector<std::uint8_t> rows(upward.size());
    for (std::size_t row = 0; row < height; ++row) {
        std::copy_n(&upward[(height - 1 - row) * stride], stride, &rows[row * stride]);
    }
    return rows;
}

void Stage::add_depth_to(base::Fnv1a& hash) {
    for (const float depth : read_depth()) hash.add(std::bit_cast<std::uint32_t>(depth));
}

std::string Stage::depth_hash() {
    base::Fnv1a hash;
    add_depth_to(hash);
    return hash.hex();
}

}  // namespace lodbench::run
