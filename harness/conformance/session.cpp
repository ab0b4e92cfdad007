#include "conformance/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

namespace lodbench::conformance {

TerrainPointer make_terrain(const std::string& form, int rows, int columns,
                            const glm::dvec2& origin) {
    terrain::TerrainSource source;
    source.synthetic = form;
    source.rows = rows;
    source.columns = columns;
    source.spacing_x = source.spacing_y = 10.0;
    source.origin_x = origin.x;
    source.origin_y = origin.y;
    return terrain::load_terrain(source);
}

TerrainPointer ridged_terrain() {
    return make_terrain("ridged", 129, 129);
}

double low_flight(const TerrainInfo& terrain) {
    const glm::dvec2 size = terrain.extent_max() - terrain.extent_min();
    return 0.25 * std::max(size.x, size.y);
}

Camera random_camera(Random& random, const TerrainInfo& terrain) {
    const glm::dvec2 low = terrain.extent_min();
    const glm::dvec2 size = terrain.extent_max() - low;
    Camera camera;
    camera.viewport = kViewport;
    camera.position = {low.x + size.x * random.between(-0.2, 1.2),
                       low.y + size.y * random.between(-0.2, 1.2),
                       terrain.max_height + low_flight(terrain) * random.between(0.05, 2.0)};
    // Towards a place inside the terrain, so that there is something to see.
    const glm::dvec3 target(low.x + size.x * random.between(0.25, 0.75),
                            low.y + size.y * random.between(0.25, 0.75), terrain.min_height);
    camera.orientation = Camera::look(target - camera.position);
    return camera;
}

std::vector<Camera> random_flight(Random& random, const TerrainInfo& terrain, int frames) {
    std::vector<Camera> flight;
    Camera from = random_camera(random, terrain);
    Camera to = random_camera(random, terrain);
    const int jump = frames / 2;
    for (int frame = 0; frame < frames; ++frame) {
        if (frame == jump) {
            from = random_camera(random, terrain);
            to = random_camera(random, terrain);
        }
        const double t = double(frame % std::max(jump, 1)) / std::max(frames, 1);
        Camera camera = from;
        camera.position = glm::mix(from.position, to.position, t);
        camera.orientation = glm::normalize(glm::slerp(from.orientation, to.orientation, t));
        flight.push_back(camera);
    }
    return flight;
}

std::vector<NamedCamera> hard_cameras(const Terrain& terrain) {
    const TerrainInfo& info = terrain.info();
    const glm::dvec2 middle = 0.5 * (info.extent_min() + info.extent_max());
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    const double above = info.max_height + low_flight(info);
    const int row = info.rows / 2;
    const int column = info.columns / 2;
    float ground = 0;
    terrain.read({row, column, 1, 1}, {&ground, 1});
    const glm::dvec3 sample(info.position(row, column), ground);
    const double degrees = std::numbers::pi / 180;
    const glm::dvec3 north(0, 1, 0), down(0, 0, -1), slanted(0.3, 1, -0.4);

    std::vector<NamedCamera> cameras;
    const auto add = [&](std::string name, const glm::dvec3& position, const glm::dvec3& direction,
                         double roll_degrees = 0) {
        Camera camera;
        camera.viewport = kViewport;
        camera.position = position;
        camera.orientation = glm::normalize(
            Camera::look(direction) * glm::angleAxis(roll_degrees * degrees, glm::dvec3(0, 0, 1)));
        cameras.push_back({std::move(name), camera});
    };
    const glm::dvec3 over(middle, above);
    add("level", over, north);
    add("straight down", over, down);
    add("straight up", over, -down);
    add("upward", over, {0, 1, 0.7});
    add("slanted", over, slanted);
    add("rolled by 37 degrees", over, slanted, 37);
    add("rolled by 90 degrees", over, slanted, 90);
    add("upside down", over, slanted, 180);
    add("level and rolled by 90 degrees", over, north, 90);
    add("at a sample", sample, north);
    add("2 m above the ground", sample + glm::dvec3(0, 0, 2), slanted);
    add("under the ground", {middle, info.min_height - 50.0}, north);
    add("under the ground looking up", {middle, info.min_height - 50.0}, {0.1, 0.1, 1});
    add("at height zero", {middle, 0.0}, north);
    add("at the corner", {info.extent_min(), above}, {1, 1, -1});
    add("beside the terrain", {info.extent_min() - size, above}, {1, 1, -0.3});
    add("beside the terrain looking away", {info.extent_min() - size, above}, {-1, -1, -0.3});
    add("1000 km outside", {middle + glm::dvec2(1e6, 0), above}, {-1, 0, -0.001});
    add("1000 km above", {middle, 1e6}, down);
    return cameras;
}

Clock clock_of(int frame) {
    return {.frame = frame, .seconds = frame / 60.0};
}

Session::Session(const Subject& subject, TerrainPointer terrain, const Settings& settings,
                 const Viewport& viewport)
    : signs_(subject.signs) {
    run::StageSetup setup{.terrain = std::move(terrain),
                          .plugin = subject.method.plugin,
                          .method = subject.method.id,
                          .settings = subject.settings,
                          .device = subject.device};
    for (const auto& [name, value] : settings) {
        std::erase_if(setup.settings, [&](const auto& given) { return given.first == name; });
        setup.settings.emplace_back(name, value);
    }
    stage_ = std::make_unique<run::Stage>(std::move(setup), *signs_);
    stage_->prepare();
    stage_->upload();
    stage_->resize(viewport);
}

void Session::select(const Camera& camera, int frame) {
    select_at_once(camera, frame);
    stage_->settle();
}

void Session::select_at_once(const Camera& camera, int frame) {
    stage_->select(camera, clock_of(frame));
}

std::vector<float> Session::picture() {
    stage_->draw_picture();
    return stage_->read_depth();
}

std::vector<float> Session::depth_through(const View& view) {
    stage_->draw(view);
    return stage_->read_depth();
}

measure::CapturedSurface Session::capture() {
    stage_->pause_background();
    measure::CapturedSurface surface = stage_->capture();
    stage_->resume_background();
    return surface;
}

std::optional<double> Session::claimed_px() const {
    const std::string& bound = stage_->method().claimed_bound;
    if (bound.empty()) return std::nullopt;
    return stage_->params().real(bound);
}

std::uint64_t Session::triangles_through(const View& view) {
    gl::Query query(stage_->device(), "conformance: primitives", GL_PRIMITIVES_GENERATED);
    query.begin();
    stage_->draw(view);
    query.end();
    return query.wait();
}

void require_same_depth(const std::vector<float>& before, const std::vector<float>& after,
                        const Viewport& viewport, const std::string& what) {
    std::size_t count = 0, first = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (std::bit_cast<std::uint32_t>(before[i]) == std::bit_cast<std::uint32_t>(after[i]))
            continue;
        if (count++ == 0) first = i;
    }
    if (count == 0) return;
    const std::size_t width = std::size_t(viewport.width);
    throw PromiseBroken(fmt::format(
        "{}: depth differs at {} of {} pixels, first at x {}, y {}: {} and {}", what, count,
        before.size(), first % width, first / width, before[first], after[first]));
}

void require_same_surface(const measure::CapturedSurface& before,
                          const measure::CapturedSurface& after, const std::string& what) {
    if (before.triangle_count() != after.triangle_count()) {
        throw PromiseBroken(fmt::format("{}: {} triangles, then {}", what, before.triangle_count(),
                                        after.triangle_count()));
    }
    using Bits = std::array<std::uint32_t, 3>;
    for (std::size_t i = 0; i < before.vertices.size(); ++i) {
        const glm::vec3& a = before.vertices[i];
        const glm::vec3& b = after.vertices[i];
        if (std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b)) continue;
        throw PromiseBroken(fmt::format(
            "{}: triangle {} of {} moved from ({}, {}, {}) to ({}, {}, {}) relative to the eye",
            what, i / 3, before.triangle_count(), a.x, a.y, a.z, b.x, b.y, b.z));
    }
}

void require_finite(const measure::CapturedSurface& surface, const std::string& what) {
    std::size_t count = 0, first = 0;
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
        const glm::vec3& v = surface.vertices[i];
        if (std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) continue;
        if (count++ == 0) first = i;
    }
    if (count == 0) return;
    const glm::vec3& v = surface.vertices[first];
    throw PromiseBroken(
        fmt::format("{}: {} of {} vertices are not finite, first in triangle {}: ({}, {}, {})",
                    what, count, surface.vertices.size(), first / 3, v.x, v.y, v.z));
}

}  // namespace lodbench::conformance
