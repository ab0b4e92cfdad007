#pragma once
// Terrains in memory, cameras and mesh checks for the tests of longest-edge bisection.

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "common/leb_refiner.h"
#include "terrain/height_field.h"

namespace lodbench::test {

inline std::unique_ptr<terrain::HeightField> make_terrain(
    int rows, int columns, const std::function<float(int, int)>& height,
    glm::dvec2 spacing = {10, 10}) {
    TerrainInfo info;
    info.name = "test";
    info.rows = rows;
    info.columns = columns;
    info.spacing = spacing;
    info.origin = {1000, -500};
    std::vector<float> heights;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) heights.push_back(height(row, column));
    }
    return std::make_unique<terrain::HeightField>(info, std::move(heights));
}

inline std::unique_ptr<terrain::HeightField> random_terrain(int rows, int columns, unsigned seed,
                                                            glm::dvec2 spacing = {10, 10}) {
    std::mt19937 random(seed);
    return make_terrain(
        rows, columns,
        [&](int row, int column) {
            const double hills = 60 * std::sin(row * 0.21) * std::cos(column * 0.17);
            return float(hills + std::uniform_real_distribution(0.0, 12.0)(random));
        },
        spacing);
}

inline std::unique_ptr<terrain::HeightField> step_terrain(int rows, int columns) {
    return make_terrain(rows, columns,
                        [&](int, int column) { return column * 2 < columns ? 0.0F : 300.0F; });
}

inline std::unique_ptr<terrain::HeightField> plane_terrain(int rows, int columns) {
    return make_terrain(rows, columns,
                        [](int row, int column) { return float(row) * 0.5F - float(column) * 2; });
}

using Terrains = std::vector<std::unique_ptr<terrain::HeightField>>;

/// A camera anywhere in a box three times the terrain's size, under the ground included, looking
/// anywhere.
inline Camera random_camera(const TerrainInfo& info, std::mt19937& random) {
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    Camera camera;
    camera.position = {info.origin.x + real(-1, 2) * size.x, info.origin.y + real(-1, 2) * size.y,
                       real(info.min_height - 50, info.max_height + 0.5 * size.x)};
    const glm::dvec3 direction{real(-1, 1), real(-1, 1), real(-1, 0.3)};
    camera.orientation = Camera::look(direction, {real(-1, 1), real(-1, 1), 1});
    camera.vertical_fov = real(0.3, 1.6);
    return camera;
}

struct Triangle {
    std::uint32_t vertices[3];
};

/// Triangles of a strip in the winding that OpenGL gives them, degenerates left out.
inline std::vector<Triangle> expand(std::span<const std::uint32_t> strip) {
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
        const std::uint32_t a = strip[i + i % 2];
        const std::uint32_t b = strip[i + 1 - i % 2];
        const std::uint32_t c = strip[i + 2];
        if (a != b && b != c && a != c) triangles.push_back({{a, b, c}});
    }
    return triangles;
}

}  // namespace lodbench::test
