// What is measured is what is timed: selections are repeatable, frozen, and drawn alike through
// every view.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "conformance/session.h"
#include "conformance/surface_renderer.h"

namespace lodbench::conformance {

namespace {

/// A view that has nothing to do with the selected camera: from the side, turned about, another
/// lens.
View other_view(const Camera& selected, const TerrainInfo& terrain) {
    Camera camera = selected;
    const glm::dvec3 aside(0.3 * low_flight(terrain), -0.2 * low_flight(terrain),
                           low_flight(terrain));
    camera.position += aside;
    camera.orientation = Camera::look(-selected.forward() + glm::dvec3(0.2, 0.1, -0.5));
    camera.vertical_fov = 1.4;
    return picture_view(camera);
}

/// From high above the middle: sees the whole terrain, whatever the selection was made for.
View overview(const Camera& selected, const TerrainInfo& terrain) {
    Camera camera = selected;
    camera.position = {0.5 * (terrain.extent_min() + terrain.extent_max()),
                       terrain.max_height + 6 * low_flight(terrain)};
    camera.orientation = Camera::look({0, 0, -1});
    return picture_view(camera);
}

/// Share of the pixels at which two depth images show another surface. Both draw the same vertices
/// to the bit, but as strips and as single triangles, so that interpolated depth differs by
/// rounding: a few steps of 2^-24 relative to the nearest vertex of the triangle, which reversed
/// depth puts at 1 or below.
double share_that_differs(const std::vector<float>& a, const std::vector<float>& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double allowed = 16 * 0x1p-24 + 0x1p-12 * std::max(a[i], b[i]);
        // Not "greater": a NaN differs from everything.
        if (!(std::abs(double(a[i]) - double(b[i])) <= allowed)) ++count;
    }
    return double(count) / double(std::max<std::size_t>(a.size(), 1));
}

}  // namespace

void draw_is_idempotent(const Subject& subject) {
    check_each_quality(subject, [](const Selected& at) {
        const auto before = at.session.picture();
        const auto captured = at.session.capture();
        const auto after = at.session.picture();
        require_same_depth(before, after, kViewport, at.where + ", picture after a capture");
        require_same_surface(captured, at.session.capture(), at.where + ", second capture");
    });
}

void select_is_repeatable(const Subject& subject) {
    check_each_quality(subject, [](const Selected& at) {
        const auto first = at.session.capture();
        at.session.select(at.camera, at.frame);
        require_same_surface(first, at.session.capture(), at.where + ", selected twice");
    });
}

void selection_is_frozen(const Subject& subject) {
    check_each_quality(subject, [](const Selected& at) {
        const auto picture = at.session.picture();
        const auto captured = at.session.capture();
        const auto expect = [&](std::uint64_t triangles, const char* view) {
            if (triangles == captured.triangle_count()) return;
            throw PromiseBroken(fmt::format("{}: {} triangles in the capture, {} through {}",
                                            at.where, captured.triangle_count(), triangles, view));
        };
        expect(at.session.triangles_through(picture_view(at.camera)), "the picture's view");
        expect(at.session.triangles_through(other_view(at.camera, at.session.terrain())),
               "a view turned about");
        expect(at.session.triangles_through(overview(at.camera, at.session.terrain())),
               "a view from above");
        require_same_depth(picture, at.session.picture(), kViewport,
                           at.where + ", picture after other views");
        require_same_surface(captured, at.session.capture(),
                             at.where + ", capture after other views");
    });
}

void picture_shows_the_capture(const Subject& subject) {
    check_each_quality(subject, [](const Selected& at) {
        SurfaceRenderer renderer(at.session.stage().device(), at.session.capture());
        const auto compare = [&](const View& view, const char* name) {
            const auto drawn = at.session.depth_through(view);
            renderer.draw(at.session.stage().device());
            const double share = share_that_differs(drawn, at.session.stage().read_depth());
            // One pixel in a thousand: triangles that clipping cuts get new corners, rounded
            // each its own way.
            if (share <= 1e-3) return;
            throw PromiseBroken(
                fmt::format("{}: through {}, {:.2f} % of the pixels show another surface than "
                            "the captured triangles "
                            "(draw calls past gl::Device, or positions that depend on the "
                            "view?)",
                            at.where, name, 100 * share));
        };
        compare(picture_view(at.camera), "the picture's view");
        compare(other_view(at.camera, at.session.terrain()), "a view turned about");
        compare(overview(at.camera, at.session.terrain()), "a view from above");
    });
}

void timing_equals_lockstep(const Subject& subject) {
    if ((subject.method.capabilities & kAsynchronous) != 0) {
        throw NotApplicable("the method is asynchronous: its timing replay may lag behind");
    }
    Random random(subject.seed);
    const int frames = random.integer(6, 24);
    const TerrainPointer terrain = ridged_terrain();
    const std::vector<Camera> flight = random_flight(random, terrain->info(), frames);
    std::vector<float> timed;
    {
        Session timing(subject, terrain);
        for (int frame = 0; frame < frames; ++frame) {
            timing.select_at_once(flight[std::size_t(frame)], frame);
            timing.stage().draw(picture_view(flight[std::size_t(frame)]));
        }
        timed = timing.stage().read_depth();
    }
    Session lockstep(subject, terrain);
    std::vector<float> replayed;
    for (int frame = 0; frame < frames; ++frame) {
        lockstep.select(flight[std::size_t(frame)], frame);
        static_cast<void>(lockstep.stage().count_primitives());
        if (frame % 3 == 0) static_cast<void>(lockstep.capture());
        replayed = lockstep.picture();
    }
    require_same_depth(
        timed, replayed, kViewport,
        fmt::format("frame {} of a flight of seed {}, timing replay against lockstep", frames - 1,
                    subject.seed));
}

void lockstep_is_repeatable(const Subject& subject) {
    constexpr int kFrames = 12;
    Random random(subject.seed);
    const TerrainPointer terrain = ridged_terrain();
    const std::vector<Camera> flight = random_flight(random, terrain->info(), kFrames);
    std::vector<measure::CapturedSurface> first;
    for (int replay = 0; replay < 2; ++replay) {
        Session session(subject, terrain);
        for (int frame = 0; frame < kFrames; ++frame) {
            session.select(flight[std::size_t(frame)], frame);
            const std::string where = fmt::format("frame {} of two lockstep replays", frame);
            auto surface = session.capture();
            const std::uint64_t count = session.stage().count_primitives();
            if (count != surface.triangle_count()) {
                throw PromiseBroken(
                    fmt::format("{}: the GPU generated {} triangles, the capture holds {}", where,
                                count, surface.triangle_count()));
            }
            if (replay == 0) {
                first.push_back(std::move(surface));
            } else {
                require_same_surface(first[std::size_t(frame)], surface, where);
            }
        }
    }
}

}  // namespace lodbench::conformance
