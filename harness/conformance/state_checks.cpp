// What a method leaves behind: pipeline state, errors, objects.

#include <fmt/format.h>

#include <functional>
#include <set>

#include "conformance/session.h"
#include "gl/host/alive_objects.h"

namespace lodbench::conformance {

namespace {

/// Takes stock before the method makes its first object, and compares after `release`.
class Inventory {
public:
    explicit Inventory(run::Stage& stage)
        : stage_(stage), counted_(stage.device().objects()), alive_(gl::count_alive_objects()) {}

    /// `host_pictures`: 1 where the stage has made its framebuffer (two textures) since, else 0.
    void require_restored(int host_pictures, const std::string& when) const {
        gl::ObjectCounts expected = counted_;
        expected.textures += 2 * host_pictures;
        expected.framebuffers += host_pictures;
        const gl::ObjectCounts& now = stage_.device().objects();
        std::string left;
        const auto compare = [&](const char* kind, int before, int after) {
            if (before != after)
                left += fmt::format("{}{} {}", left.empty() ? "" : ", ", after - before, kind);
        };
        compare("buffers", expected.buffers, now.buffers);
        compare("textures", expected.textures, now.textures);
        compare("programs", expected.programs, now.programs);
        compare("vertex arrays", expected.vertex_arrays, now.vertex_arrays);
        compare("framebuffers", expected.framebuffers, now.framebuffers);
        compare("queries", expected.queries, now.queries);
        compare("fences", expected.fences, now.fences);
        if (!left.empty())
            throw PromiseBroken(fmt::format("{}: not given back to gl/: {}", when, left));
        gl::AliveObjects alive = alive_;
        alive.textures += 2 * host_pictures;
        alive.framebuffers += host_pictures;
        const auto grown = gl::differences(alive, gl::count_alive_objects());
        if (!grown.empty()) {
            throw PromiseBroken(fmt::format("{}: made by bare GL and not deleted: {}", when,
                                            fmt::join(grown, "; ")));
        }
    }

private:
    run::Stage& stage_;
    gl::ObjectCounts counted_;
    gl::AliveObjects alive_;
};

run::StageSetup setup_of(const Subject& subject, TerrainPointer terrain) {
    return {.terrain = std::move(terrain),
            .plugin = subject.method.plugin,
            .method = subject.method.id,
            .settings = subject.settings,
            .device = subject.device};
}

void require_line(const std::string& text, const std::string& what) {
    if (text.empty()) throw PromiseBroken(what + " is empty");
    for (const char c : text) {
        if (static_cast<unsigned char>(c) < 0x20) {
            throw PromiseBroken(what + " is not one line: it holds a control character");
        }
    }
}

/// Flies every call of the interface, in an order in which the harness makes them.
void fly_every_call(run::Stage& stage, const Subject& subject,
                    const std::function<void(const char* call)>& after_each) {
    Random random(subject.seed);
    stage.prepare();
    after_each("prepare");
    stage.upload();
    after_each("upload");
    stage.resize(kViewport);
    after_each("resize");
    const std::vector<Camera> flight = random_flight(random, stage.terrain().info(), 6);
    for (int frame = 0; frame < int(flight.size()); ++frame) {
        stage.select(flight[std::size_t(frame)], clock_of(frame));
        after_each("select");
        stage.settle();
        after_each("settle");
        stage.draw_picture();
        after_each("draw");
        stage.pause_background();
        after_each("pause_background");
        static_cast<void>(stage.capture());
        after_each("draw in a capture");
        stage.resume_background();
        after_each("resume_background");
        stage.draw_picture(true);
        after_each("draw of the wireframe");
        static_cast<void>(stage.counters());
        after_each("counters");
    }
    stage.release();
    after_each("release");
}

}  // namespace

void descriptor_is_sane(const Subject& subject) {
    // Names, ranges and types are checked whenever a plugin is loaded; this is what people read.
    const run::MethodInfo& method = subject.method;
    require_line(method.title, "the title");
    require_line(method.version, "the version");
    if (!method.citation.empty()) require_line(method.citation, "the citation");
    for (const run::ParamInfo& param : method.params) {
        const std::string what = fmt::format("parameter '{}'", param.name);
        require_line(param.help, "the help of " + what);
        if (std::set(param.choices.begin(), param.choices.end()).size() != param.choices.size()) {
            throw PromiseBroken(what + " has a choice twice");
        }
        if (param.name == method.quality_knob && param.minimum >= param.maximum) {
            throw PromiseBroken(what + " is the quality knob but has one value only");
        }
        if (param.name == method.claimed_bound && param.type != ParamType::real) {
            throw PromiseBroken(what + " is the claimed bound in pixels but no real number");
        }
    }
}

void pipeline_state_is_restored(const Subject& subject) {
    std::string left;
    run::StageSetup setup = setup_of(subject, ridged_terrain());
    setup.warn = [&](const std::string& words) { left += (left.empty() ? "" : "; ") + words; };
    run::Stage stage(std::move(setup), *subject.signs);
    stage.check_state(true);
    fly_every_call(stage, subject, [](const char*) {});
    if (!left.empty()) throw PromiseBroken(left);
}

void no_gl_errors(const Subject& subject) {
    run::Stage stage(setup_of(subject, ridged_terrain()), *subject.signs);
    // The stage hears the driver's debug messages; the error flag is asked besides, as a plugin can
    // turn the messages off.
    fly_every_call(stage, subject, [](const char* call) {
        const GLenum error = glGetError();
        if (error != GL_NO_ERROR) {
            throw PromiseBroken(fmt::format("{} left the GL error 0x{:04x}", call, error));
        }
    });
}

void objects_are_given_back(const Subject& subject) {
    run::Stage stage(setup_of(subject, ridged_terrain()), *subject.signs);
    const Inventory inventory(stage);
    fly_every_call(stage, subject, [](const char*) {});
    inventory.require_restored(1, "after release");
}

void release_without_frames(const Subject& subject) {
    { const run::Stage created_only(setup_of(subject, ridged_terrain()), *subject.signs); }
    run::Stage stage(setup_of(subject, ridged_terrain()), *subject.signs);
    const Inventory inventory(stage);
    stage.prepare();
    stage.upload();
    stage.release();
    inventory.require_restored(0, "after prepare, upload, release");
}

void resize_and_back(const Subject& subject) {
    Session session(subject, ridged_terrain());
    Random random(subject.seed);
    const Camera camera = random_camera(random, session.terrain());
    session.select(camera, 0);
    const auto picture = session.picture();
    const auto surface = session.capture();
    for (const Viewport& size : {Viewport{97, 211}, Viewport{1, 1}, Viewport{640, 64}}) {
        const std::string where = fmt::format("{}x{}", size.width, size.height);
        session.stage().resize(size);
        Camera resized = camera;
        resized.viewport = size;
        session.select(resized, 0);
        static_cast<void>(session.picture());
        require_finite(session.capture(), "viewport " + where);
        session.stage().resize(kViewport);
        session.select(camera, 0);
        require_same_depth(picture, session.picture(), kViewport, "back from " + where);
        require_same_surface(surface, session.capture(), "back from " + where);
    }
}

}  // namespace lodbench::conformance
