#include "grid_method.h"

#include <cstdint>
#include <vector>

#include "gl/embedded_shaders.h"

namespace lodbench::broken {

namespace {

/// 0, step, 2 step, ... and the last of `count`.
std::vector<int> every(int step, int count) {
    std::vector<int> places;
    for (int place = 0; place < count - 1; place += step) places.push_back(place);
    places.push_back(count - 1);
    return places;
}

}  // namespace

void GridMethod::prepare(const Terrain& terrain, gl::Device&) {
    terrain_ = &terrain;
}

void GridMethod::upload(gl::Device& device) {
    device_ = &device;
    const int rows = terrain_->info().rows;
    const int columns = terrain_->info().columns;
    std::vector<float> heights(std::size_t(rows) * std::size_t(columns));
    terrain_->read({0, 0, rows, columns}, heights);
    const std::vector<int> drawn_rows = every(step_, rows), drawn_columns = every(step_, columns);
    std::vector<glm::vec3> vertices;
    std::vector<std::uint32_t> indices;
    for (const int row : drawn_rows) {
        for (const int column : drawn_columns) {
            const auto here = std::uint32_t(vertices.size());
            vertices.emplace_back(
                column, row,
                heights[std::size_t(row) * std::size_t(columns) + std::size_t(column)]);
            if (row == 0 || column == 0) continue;
            const auto above = here - std::uint32_t(drawn_columns.size());
            for (const std::uint32_t index : {above - 1, here - 1, here, above - 1, here, above}) {
                indices.push_back(index);
            }
        }
    }
    index_count_ = int(indices.size());
    program_ = gl::Program(
        device, "grid", embedded_shaders(),
        {{GL_VERTEX_SHADER, vertex_shader_}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
    vertices_ = gl::Buffer(device, "grid: vertices", std::span<const glm::vec3>(vertices));
    indices_ = gl::Buffer(device, "grid: indices", std::span<const std::uint32_t>(indices));
    array_ = gl::VertexArray(device, "grid");
    array_.attribute(0, 3, vertices_, 0, sizeof(glm::vec3));
    array_.elements(indices_);
}

void GridMethod::select(const Camera& camera, const Clock&) {
    camera_ = camera;
}

void GridMethod::draw(const View&) {
    draw_grid();
}

void GridMethod::draw_grid(const glm::vec3& shift, int left_out) {
    program_.set("shift", shift);
    device_->draw_elements(program_, array_, GL_TRIANGLES, index_count_ - 3 * left_out,
                           GL_UNSIGNED_INT, 3 * sizeof(std::uint32_t) * std::size_t(left_out));
}

void GridMethod::release(gl::Device&) {
    array_ = {};
    indices_ = {};
    vertices_ = {};
    program_ = {};
}

}  // namespace lodbench::broken
