// What a method draws: finite, everywhere, for every terrain, place on the planet and parameter.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "conformance/session.h"

namespace lodbench::conformance {

namespace {

/// Captured positions are floats relative to the eye after a few roundings (differences of samples,
/// offset, height), each at most 2^-24 of the farthest coordinate.
double rounding_of(const measure::CapturedSurface& surface) {
    double reach = 1;
    for (const glm::vec3& v : surface.vertices) {
        reach =
            std::max({reach, std::abs(double(v.x)), std::abs(double(v.y)), std::abs(double(v.z))});
    }
    return 8 * 0x1p-24 * reach;
}

/// Which samples lie in or on a triangle seen from above, edges moved outward by `slack` metres.
class Coverage {
public:
    Coverage(const TerrainInfo& terrain, double slack)
        : terrain_(terrain),
          slack_(slack),
          covered_(std::size_t(terrain.rows) * std::size_t(terrain.columns), false) {}

    void add(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
        const double twice = cross(b - a, c - a);
        if (twice == 0) return;
        const std::array<glm::dvec2, 3> corner =
            twice > 0 ? std::array{a, b, c} : std::array{a, c, b};
        const glm::dvec2 low =
            (glm::min(glm::min(a, b), c) - slack_ - terrain_.origin) / terrain_.spacing;
        const glm::dvec2 high =
            (glm::max(glm::max(a, b), c) + slack_ - terrain_.origin) / terrain_.spacing;
        const auto clamped = [](double value, int count) {
            return int(std::clamp(value, 0.0, double(count - 1)));
        };
        const int last_column = clamped(std::floor(high.x), terrain_.columns);
        const int last_row = clamped(std::floor(high.y), terrain_.rows);
        for (int y = clamped(std::ceil(low.y), terrain_.rows); y <= last_row; ++y) {
            for (int x = clamped(std::ceil(low.x), terrain_.columns); x <= last_column; ++x) {
                if (contains(corner, terrain_.origin + terrain_.spacing * glm::dvec2(x, y))) {
                    covered_[index(terrain_.rows - 1 - y, x)] = true;
                }
            }
        }
    }
    [[nodiscard]] bool covered(int row, int column) const { return covered_[index(row, column)]; }

private:
    static double cross(const glm::dvec2& u, const glm::dvec2& v) { return u.x * v.y - u.y * v.x; }
    [[nodiscard]] bool contains(const std::array<glm::dvec2, 3>& corner,
                                const glm::dvec2& p) const {
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2 edge = corner[(i + 1) % 3] - corner[i];
            if (cross(edge, p - corner[i]) < -slack_ * glm::length(edge)) return false;
        }
        return true;
    }
    [[nodiscard]] std::size_t index(int row, int column) const {
        return std::size_t(row) * std::size_t(terrain_.columns) + std::size_t(column);
    }
    const TerrainInfo& terrain_;
    double slack_;
    std::vector<bool> covered_;
};

/// Samples of the terrain whose picture lies at least a pixel inside the image.
void require_covered(Session& session, const Camera& camera, const std::string& where) {
    const auto surface = session.capture();
    const TerrainInfo& info = session.terrain();
    Coverage coverage(info, rounding_of(surface));
    const std::vector<glm::dvec3> triangles = measure::clipped_triangles(surface, info);
    for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
        coverage.add(glm::dvec2(triangles[i]), glm::dvec2(triangles[i + 1]),
                     glm::dvec2(triangles[i + 2]));
    }
    std::vector<float> heights(std::size_t(info.rows) * std::size_t(info.columns));
    session.stage().terrain().read({0, 0, info.rows, info.columns}, heights);
    int in_view = 0, uncovered = 0, first_row = 0, first_column = 0;
    for (int row = 0; row < info.rows; ++row) {
        for (int column = 0; column < info.columns; ++column) {
            const float height =
                heights[std::size_t(row) * std::size_t(info.columns) + std::size_t(column)];
            const auto pixel = camera.project({info.position(row, column), height});
            if (!pixel || pixel->x < 1 || pixel->y < 1 || pixel->x > camera.viewport.width - 1 ||
                pixel->y > camera.viewport.height - 1) {
                continue;
            }
            ++in_view;
            if (coverage.covered(row, column)) continue;
            if (uncovered++ == 0) {
                first_row = row;
                first_column = column;
            }
        }
    }
    if (uncovered == 0) return;
    throw PromiseBroken(fmt::format(
        "{}: {} of {} samples in view are covered by no triangle, first at row {}, column {}",
        where, uncovered, in_view, first_row, first_column));
}

Camera straight_down(const TerrainInfo& terrain) {
    Camera camera;
    camera.viewport = kViewport;
    camera.position = {0.5 * (terrain.extent_min() + terrain.extent_max()),
                       terrain.max_height + low_flight(terrain)};
    camera.orientation = Camera::look({0, 0, -1});
    return camera;
}

/// The values at which a parameter is tried: both ends and the default, or every choice.
std::vector<std::string> trial_values(const run::ParamInfo& param) {
    switch (param.type) {
        case ParamType::boolean: return {"false", "true"};
        case ParamType::choice: return param.choices;
        case ParamType::integer:
            return {fmt::format("{:.0f}", param.minimum),
                    fmt::format("{:.0f}", param.default_number),
                    fmt::format("{:.0f}", param.maximum)};
        case ParamType::real:
            return {fmt::format("{}", param.minimum), fmt::format("{}", param.default_number),
                    fmt::format("{}", param.maximum)};
    }
    return {};
}

}  // namespace

void vertices_are_finite(const Subject& subject) {
    for (const TerrainPointer& terrain : {ridged_terrain(), make_terrain("plane", 33, 33)}) {
        Session session(subject, terrain);
        int frame = 0;
        for (const NamedCamera& hard : hard_cameras(*terrain)) {
            session.select(hard.camera, frame++);
            static_cast<void>(session.picture());
            require_finite(session.capture(),
                           fmt::format("camera {} on {}", hard.name, terrain->info().name));
        }
    }
}

void any_terrain_works(const Subject& subject) {
    struct Form {
        const char* name;
        int rows, columns;
    };
    constexpr Form kForms[] = {{"plane", 2, 2},     {"ridged", 2, 2},       {"ridged", 3, 5},
                               {"ridged", 5, 3},    {"ridged", 2, 65},      {"ridged", 65, 2},
                               {"plane", 65, 65},   {"step", 65, 65},       {"ramp", 33, 17},
                               {"bump", 64, 64},    {"sphere-cap", 50, 70}, {"ridged", 100, 37},
                               {"ridged", 129, 129}};
    for (const Form& form : kForms) {
        Session session(subject, make_terrain(form.name, form.rows, form.columns));
        const std::string where = fmt::format("{} {}x{}", form.name, form.rows, form.columns);
        Random random(subject.seed);
        session.select(straight_down(session.terrain()), 0);
        static_cast<void>(session.picture());
        const auto from_above = session.capture();
        require_finite(from_above, where);
        if (measure::clipped_triangles(from_above, session.terrain()).empty()) {
            throw PromiseBroken(where + ": nothing is drawn of a terrain that fills the picture");
        }
        for (int frame = 1; frame < 4; ++frame) {
            session.select(random_camera(random, session.terrain()), frame);
            static_cast<void>(session.picture());
            require_finite(session.capture(), where);
        }
        session.stage().release();
    }
}

void origin_does_not_matter(const Subject& subject) {
    constexpr int kCameras = 4;
    // Whole metres, so that moving the camera along is exact: its position keeps 2^-29 m there.
    const glm::dvec2 far_away(1e7, -1e7);
    // One after the other: a thread has one context.
    const auto capture_all = [&](const glm::dvec2& origin) {
        Session session(subject, make_terrain("ridged", 129, 129, origin));
        const TerrainPointer unmoved = make_terrain("ridged", 129, 129);
        Random random(subject.seed);
        std::vector<measure::CapturedSurface> captures;
        for (int i = 0; i < kCameras; ++i) {
            Camera camera = random_camera(random, unmoved->info());
            camera.position = glm::round(camera.position * 1024.0) / 1024.0;
            camera.position += glm::dvec3(origin, 0);
            session.select(camera, i);
            captures.push_back(session.capture());
        }
        return captures;
    };
    const auto at_origin = capture_all({0, 0});
    const auto moved_away = capture_all(far_away);
    for (int i = 0; i < kCameras; ++i) {
        const measure::CapturedSurface& expected = at_origin[std::size_t(i)];
        const measure::CapturedSurface& found = moved_away[std::size_t(i)];
        const std::string where = fmt::format("camera {} of seed {}", i, subject.seed);
        if (expected.triangle_count() != found.triangle_count()) {
            throw PromiseBroken(
                fmt::format("{}: {} triangles at origin 0, {} at origin (1e7, -1e7)", where,
                            expected.triangle_count(), found.triangle_count()));
        }
        const double allowed = rounding_of(expected);
        for (std::size_t v = 0; v < expected.vertices.size(); ++v) {
            const glm::dvec3 moved =
                glm::dvec3(found.vertices[v]) - glm::dvec3(expected.vertices[v]);
            const double distance =
                std::max({std::abs(moved.x), std::abs(moved.y), std::abs(moved.z)});
            if (distance <= allowed) continue;
            throw PromiseBroken(
                fmt::format("{}: at origin (1e7, -1e7) a vertex of triangle {} lies {:.3g} m from "
                            "where it is at origin 0; "
                            "rounding allows {:.3g} m",
                            where, v / 3, distance, allowed));
        }
    }
}

void parameters_at_their_limits(const Subject& subject) {
    // Above this a capture costs more memory than the promise is worth; the picture is drawn all
    // the same.
    constexpr std::uint64_t kMostCaptured = 4'000'000;
    if (subject.method.params.empty()) throw NotApplicable("the method has no parameters");
    const TerrainPointer terrain = make_terrain("ridged", 33, 33);
    for (const run::ParamInfo& param : subject.method.params) {
        for (const std::string& value : trial_values(param)) {
            const std::string where = fmt::format("{} = {}", param.name, value);
            try {
                Session session(subject, terrain, {{param.name, value}}, {64, 48});
                Camera camera = straight_down(terrain->info());
                camera.viewport = {64, 48};
                session.select(camera, 0);
                static_cast<void>(session.picture());
                if (session.stage().count_primitives() <= kMostCaptured) {
                    require_finite(session.capture(), "a capture");
                }
                session.stage().release();
            } catch (const run::MethodFailure& failure) {
                throw PromiseBroken(fmt::format("{}: {}", where, failure.what()));
            } catch (const PromiseBroken& broken) {
                throw PromiseBroken(fmt::format("{}: {}", where, broken.what()));
            }
        }
    }
}

void terrain_in_view_is_covered(const Subject& subject) {
    if (subject.method.claimed_bound.empty() && !subject.method.quality_knob.empty()) {
        throw NotApplicable("the method claims no bound on its error");
    }
    for (const TerrainPointer& terrain : {ridged_terrain(), make_terrain("ridged", 100, 37)}) {
        Session session(subject, terrain);
        Random random(subject.seed);
        int frame = 0;
        for (const NamedCamera& hard : hard_cameras(*terrain)) {
            session.select(hard.camera, frame++);
            require_covered(session, hard.camera, "camera " + hard.name);
        }
        for (int i = 0; i < 6; ++i) {
            const Camera camera = random_camera(random, terrain->info());
            session.select(camera, frame++);
            require_covered(session, camera, fmt::format("camera {} of seed {}", i, subject.seed));
        }
    }
    check_each_quality(
        subject, [](const Selected& at) { require_covered(at.session, at.camera, at.where); });
}

}  // namespace lodbench::conformance
