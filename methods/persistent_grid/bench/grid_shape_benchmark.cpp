// What Livny et al. 2006 say of the triangles of a mapped grid: nearly pixel-size (section 3),
// neither degenerate nor slivers (abstract), none to cull (section 3.3), all of one size on the
// base plane (figure 7); and how fine they lie across distances (figure 6).
//
// From the keyframes of scenarios/trade/high.toml, whose terrain is to be named.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "benchmarks.h"
#include "measure/capture.h"
#include "run/locations.h"
#include "run/stage.h"
#include "scenario/flight_path.h"

namespace lodbench::benchmarks {
namespace {

struct Pose {
    glm::dvec3 position;
    double heading, pitch;
};
constexpr Pose kPoses[] = {{{87000, 84000, 1300}, 97, -8},
                           {{98000, 82500, 1600}, 96, -8},
                           {{108000, 80500, 2400}, 94, -9},
                           {{116500, 78000, 3200}, 85, -10}};

Camera camera_of(const Pose& pose) {
    Camera camera;
    camera.viewport = {640, 480};
    camera.vertical_fov = 45 * 0.017453292519943295;
    camera.near_plane = 10;
    camera.position = pose.position;
    camera.orientation = scenario::orientation_of(pose.heading, pose.pitch, 0);
    return camera;
}

/// Degrees; 0 for a triangle without an area.
double smallest_angle(const std::array<glm::dvec3, 3>& t) {
    double smallest = 180;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 u = t[(i + 1) % 3] - t[i], v = t[(i + 2) % 3] - t[i];
        if (glm::length(u) == 0 || glm::length(v) == 0) return 0;
        const double angle = std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
        smallest = std::min(smallest, angle * 57.29577951308232);
    }
    return smallest;
}

/// Figures of triangles, gathered over cameras.
class Shapes {
public:
    void add(const measure::CapturedSurface& surface, const Camera& camera) {
        for (std::size_t i = 0; i < surface.triangle_count(); ++i) {
            std::array<glm::dvec3, 3> corners;
            for (std::size_t k = 0; k < 3; ++k) {
                corners[k] = surface.origin + glm::dvec3(surface.vertices[3 * i + k]);
            }
            add(corners, camera);
        }
    }
    void print(const std::string& name) {
        std::ranges::sort(areas_);
        const auto area = [&](double part) {
            return areas_.empty() ? NAN : areas_[std::size_t(part * double(areas_.size() - 1))];
        };
        fmt::print(
            "  {:34} {:8} triangles, {} degenerate; {:.1f} % touch the picture; of these {:.1f} % "
            "with an angle below 1 degree; screen area px, p1 / median / p99: {:.3f} / {:.2f} / "
            "{:.2f}\n",
            name, triangles_ / std::size(kPoses), degenerate_,
            100.0 * double(touching_) / double(triangles_),
            100.0 * double(slivers_) / double(touching_), area(0.01), area(0.5), area(0.99));
        std::fflush(stdout);
    }

private:
    void add(const std::array<glm::dvec3, 3>& corners, const Camera& camera) {
        ++triangles_;
        const double angle = smallest_angle(corners);
        degenerate_ += angle == 0 ? 1 : 0;
        for (const glm::dvec4& plane : camera.frustum_planes()) {
            if (std::ranges::none_of(corners, [&](const glm::dvec3& corner) {
                    return glm::dot(glm::dvec3(plane), corner - camera.position) + plane.w >= 0;
                })) {
                return;
            }
        }
        ++touching_;
        slivers_ += angle < 1 ? 1 : 0;
        std::array<glm::dvec2, 3> pixels;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto pixel = camera.project(corners[k]);
            if (!pixel) return;
            pixels[k] = *pixel;
        }
        const glm::dvec2 u = pixels[1] - pixels[0], v = pixels[2] - pixels[0];
        areas_.push_back(std::abs(u.x * v.y - u.y * v.x) / 2);
    }

    std::size_t triangles_ = 0, degenerate_ = 0, touching_ = 0, slivers_ = 0;
    std::vector<double> areas_;  ///< of those in the picture
};

void print_shapes(const std::string& name, const std::shared_ptr<const Terrain>& terrain,
                  const run::Settings& settings) {
    run::VitalSigns signs;
    run::Stage stage(
        {terrain, run::default_plugin_folder() / "persistent_grid.so", "pgm", settings, ""}, signs);
    stage.prepare();
    stage.upload();
    Shapes shapes;
    for (const Pose& pose : kPoses) {
        const Camera camera = camera_of(pose);
        stage.resize(camera.viewport);
        stage.select(camera, {});
        stage.settle();
        shapes.add(stage.capture(), camera);
    }
    stage.release();
    shapes.print(name);
}

}  // namespace

void grid_shape_benchmark(const Options& options) {
    const std::shared_ptr<const terrain::HeightField> terrain =
        terrain::load_terrain(options.source());
    TerrainInfo info = terrain->info();
    const auto plane = std::make_shared<terrain::HeightField>(
        info, std::vector<float>(std::size_t(info.rows) * std::size_t(info.columns), 0.0F));
    fmt::print("shape of the mapped grid, {}: 4 cameras, 640 x 480\n", info.name);
    struct Grid {
        const char* name;
        const char* rows;
        const char* aspect;
    };
    for (const Grid& grid :
         {Grid{"150 x 600", "600", "0.25"}, Grid{"200 x 800", "800", "0.25"},
          Grid{"430 x 430", "430", "1"}, Grid{"50 x 50 (figure 7)", "50", "1"}}) {
        const run::Settings settings = {{"grid", grid.rows}, {"aspect", grid.aspect}};
        print_shapes(grid.name, terrain, settings);
        for (const auto& [words, setting] :
             {std::pair(", no extension", std::pair("extend", "false")),
              std::pair(", rows = horizon", std::pair("rows", "horizon"))}) {
            run::Settings more = settings;
            more.emplace_back(setting.first, setting.second);
            print_shapes(std::string(grid.name) + words, terrain, more);
        }
        print_shapes(std::string(grid.name) + ", plane at z = 0", plane, settings);
    }
}

}  // namespace lodbench::benchmarks
