// What truth costs: rays and lines of sight of the reference ray caster, on one thread.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <vector>

#include "api/camera.h"
#include "benchmarks.h"
#include "measure/reference_terrain.h"
#include "terrain/height_field.h"

namespace lodbench::benchmarks {
namespace {

struct NamedView {
    const char* name;
    glm::dvec2 place;  ///< share of the extent
    double above;      ///< the ground below, as a share of the relief
    glm::dvec3 direction;
};

constexpr Viewport kViewport = {640, 480};
constexpr std::size_t kSamples = 2'000'000;

Camera camera_of(const NamedView& view, const measure::ReferenceTerrain& terrain) {
    const TerrainInfo& info = terrain.info();
    const glm::dvec2 place =
        info.extent_min() + (info.extent_max() - info.extent_min()) * view.place;
    Camera camera;
    camera.viewport = kViewport;
    const double relief = double(info.max_height) - double(info.min_height);
    camera.position = {place, terrain.interval(place).high + view.above * relief};
    camera.orientation = Camera::look(view.direction);
    return camera;
}

std::vector<glm::dvec3> pixel_directions(const Camera& camera) {
    const glm::dvec2 tangents = camera.half_tangents();
    const glm::dvec3 forward = camera.forward();
    const glm::dvec3 right = camera.right() * tangents.x;
    const glm::dvec3 up = camera.up() * tangents.y;
    std::vector<glm::dvec3> directions;
    for (int y = 0; y < kViewport.height; ++y) {
        for (int x = 0; x < kViewport.width; ++x) {
            directions.push_back(forward + right * ((x + 0.5) * 2 / kViewport.width - 1) +
                                 up * (1 - (y + 0.5) * 2 / kViewport.height));
        }
    }
    return directions;
}

/// Samples in the frustum, row by row; every n-th where there are more than kSamples.
std::vector<glm::ivec2> samples_in_view(const Camera& camera,
                                        const measure::ReferenceTerrain& terrain) {
    const auto planes = camera.frustum_planes();
    std::vector<glm::ivec2> samples;
    for (int row = 0; row < terrain.info().rows; ++row) {
        for (int column = 0; column < terrain.info().columns; ++column) {
            const glm::dvec3 relative = terrain.sample(row, column) - camera.position;
            if (std::ranges::all_of(planes, [&](const glm::dvec4& plane) {
                    return glm::dot(glm::dvec3(plane), relative) + plane.w >= 0;
                })) {
                samples.emplace_back(row, column);
            }
        }
    }
    const std::size_t step = samples.size() / kSamples + 1;
    std::vector<glm::ivec2> kept;
    for (std::size_t i = 0; i < samples.size(); i += step) kept.push_back(samples[i]);
    return kept;
}

}  // namespace

void rays_benchmark(const Options& options) {
    terrain::TerrainSource source;
    source.synthetic = "ridged";
    source.rows = options.size;
    source.columns = options.size;
    const std::unique_ptr<terrain::HeightField> field = terrain::load_terrain(source);
    const double build =
        seconds_of([&] { (void)measure::ReferenceTerrain(field->samples(), field->info()); });
    const measure::ReferenceTerrain terrain(field->samples(), field->info());
    fmt::print(
        "reference ray caster, ridged terrain of {0} x {0} samples, pyramid built in {1:.3f} s\n",
        options.size, build);
    for (const NamedView& view : {NamedView{"grazing", {0.1, 0.1}, 0.2, {1, 0.8, -0.1}},
                                  NamedView{"in a valley", {0.5, 0.05}, 0.02, {0.1, 1, -0.02}},
                                  NamedView{"from above", {0.1, 0.1}, 1.2, {1, 0.8, -0.35}}}) {
        const Camera camera = camera_of(view, terrain);
        const std::vector<glm::dvec3> directions = pixel_directions(camera);
        const std::vector<glm::ivec2> samples = samples_in_view(camera, terrain);
        double cast_seconds = 1e300;
        double sees_seconds = 1e300;
        std::size_t hits = 0;
        std::size_t seen = 0;
        for (int i = 0; i < options.repetitions; ++i) {
            hits = 0;
            seen = 0;
            cast_seconds = std::min(
                cast_seconds, seconds_of([&] {
                    for (const glm::dvec3& direction : directions) {
                        hits += std::isfinite(terrain.cast(camera.position, direction, 1).certain);
                    }
                }));
            sees_seconds =
                std::min(sees_seconds, seconds_of([&] {
                             for (const glm::ivec2& sample : samples) {
                                 seen += terrain.sees(camera.position, 0, sample.x, sample.y);
                             }
                         }));
        }
        fmt::print(
            "  {:<12} {:6.2f} M rays/s ({:3.0f} % hit)   {:6.2f} M sights/s ({:4.1f} % of {} "
            "seen)\n",
            view.name, double(directions.size()) / cast_seconds / 1e6,
            100.0 * double(hits) / double(directions.size()),
            double(samples.size()) / sees_seconds / 1e6,
            100.0 * double(seen) / double(samples.size()), samples.size());
        std::fflush(stdout);
    }
}

}  // namespace lodbench::benchmarks
