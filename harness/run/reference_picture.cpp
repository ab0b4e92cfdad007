#include "run/reference_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>

#include "measure/box_in_view.h"

namespace lodbench::run {

namespace {

constexpr int kBlockCells = 64;
constexpr int kBlockVertices = kBlockCells + 1;  // along an edge; all of them fit 16-bit indices
constexpr std::size_t kBlockSamples = std::size_t{kBlockVertices} * kBlockVertices;
constexpr GLsizei kBlockIndices = 6 * kBlockCells * kBlockCells;

/// Half a million triangles a draw call: a tenth of a second of a software rasteriser, far below
/// what makes a desktop's driver give up on a GPU.
constexpr int kBatchBlocks = 64;

// A block that the border cuts is drawn whole: what lies beyond is put onto the border, where it
// makes triangles with two equal vertices, which cover no pixel.
constexpr std::array<gl::ShaderSource, 1> kSources = {
    {{"run/reference_picture.vert", R"GLSL(#version 450 core
#include "common/terrain.glsl"
layout(location = 0) in ivec2 north_west;  // column, row
layout(binding = HEIGHTS_UNIT) uniform sampler2D heights;
void main() {
    ivec2 inside = ivec2(gl_VertexID % BLOCK_VERTICES, gl_VertexID / BLOCK_VERTICES);
    ivec2 texel = ivec2(inside.x, gl_InstanceID * BLOCK_VERTICES + inside.y);
    ivec2 grid_sample = min(north_west + inside, eye_sample.zw - 1);
    emit_terrain_vertex(sample_position(grid_sample, texelFetch(heights, texel, 0).r));
}
)GLSL"}}};

/// The driver's last texture unit: methods count theirs from 0, and one that binds a texture once
/// and for all must find it bound after a reference picture too.
GLuint last_texture_unit() {
    GLint units = 0;
    glGetIntegerv(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS, &units);
    return GLuint(units) - 1;
}

/// Counter-clockwise seen from above. In bands of eight columns, so that a vertex is still in the
/// vertex cache (or the software pipeline's run of a thousand indices) when the row below needs it.
std::vector<std::uint16_t> block_indices() {
    constexpr int kBand = 8;
    std::vector<std::uint16_t> indices;
    indices.reserve(kBlockIndices);
    for (int band = 0; band < kBlockCells; band += kBand) {
        for (int row = 0; row < kBlockCells; ++row) {
            for (int column = band; column < band + kBand; ++column) {
                const auto nw = std::uint16_t(row * kBlockVertices + column);
                const auto ne = std::uint16_t(nw + 1);
                const auto sw = std::uint16_t(nw + kBlockVertices);
                const auto se = std::uint16_t(sw + 1);
                indices.insert(indices.end(), {nw, sw, se, nw, se, ne});
            }
        }
    }
    return indices;
}

/// Covers the picture's own float arithmetic (a handful of roundings of 6e-8), so that nothing that
/// reaches a pixel is left out.
constexpr double kSlack = 1e-6;

/// Whether the block that begins at a sample is hidden in all its parts.
bool is_hidden(const measure::HiddenGround& hidden, const TerrainInfo& info, int first_row,
               int first_column) {
    constexpr int kPart = measure::HiddenGround::kBlockCells;
    static_assert(kBlockCells % kPart == 0);
    const int end_row = std::min(first_row + kBlockCells, info.rows - 1);
    const int end_column = std::min(first_column + kBlockCells, info.columns - 1);
    for (int row = first_row; row < end_row; row += kPart) {
        for (int column = first_column; column < end_column; column += kPart) {
            if (!hidden.block(row / kPart, column / kPart)) return false;
        }
    }
    return true;
}

}  // namespace

ReferencePicture::ReferencePicture(gl::Device& device,
                                   std::shared_ptr<const terrain::WholeTerrain> terrain)
    : device_(device),
      terrain_(std::move(terrain)),
      block_columns_((terrain_->info().columns - 2) / kBlockCells + 1),
      block_rows_((terrain_->info().rows - 2) / kBlockCells + 1),
      heights_unit_(last_texture_unit()),
      batch_heights_(kBatchBlocks * kBlockSamples),
      program_(device, "host: reference picture", kSources,
               {{GL_VERTEX_SHADER, "run/reference_picture.vert"},
                {GL_FRAGMENT_SHADER, "common/terrain.frag"}},
               {{"BLOCK_VERTICES", fmt::format("{}", kBlockVertices)},
                {"HEIGHTS_UNIT", fmt::format("{}", heights_unit_)}}),
      heights_(device, "host: reference heights", GL_TEXTURE_2D, GL_R32F, kBlockVertices,
               kBatchBlocks * kBlockVertices),
      north_wests_(device, "host: reference blocks", kBatchBlocks * sizeof(glm::ivec2)),
      vertices_(device, "host: reference picture") {
    const std::vector<std::uint16_t> indices = block_indices();
    indices_ = gl::Buffer(device, "host: reference block", std::span<const std::uint16_t>(indices));
    vertices_.integer_attribute(0, 2, GL_INT, north_wests_, 0, sizeof(glm::ivec2), 1);
    vertices_.elements(indices_);
    find_height_ranges();
}

void ReferencePicture::find_height_ranges() {
    const TerrainInfo& info = terrain_->info();
    height_ranges_.reserve(std::size_t(block_rows_) * std::size_t(block_columns_));
    for (int north = 0; north < info.rows - 1; north += kBlockCells) {
        const int south = std::min(north + kBlockCells, info.rows - 1);
        for (int west = 0; west < info.columns - 1; west += kBlockCells) {
            const int width = std::min(kBlockVertices, info.columns - west);
            HeightRange range{info.max_height, info.min_height};
            for (int row = north; row <= south; ++row) {
                const std::size_t first =
                    std::size_t(row) * std::size_t(info.columns) + std::size_t(west);
                const auto [low, high] = std::ranges::minmax_element(
                    terrain_->samples().subspan(first, std::size_t(width)));
                range.low = std::min(range.low, *low);
                range.high = std::max(range.high, *high);
            }
            height_ranges_.push_back(range);
        }
        terrain_->forget();
    }
}

std::vector<glm::ivec2> ReferencePicture::visible_blocks(
    const Camera& camera, const measure::HiddenGround* hidden) const {
    const TerrainInfo& info = terrain_->info();
    const measure::BoxInView in_view(camera, kSlack);
    std::vector<glm::ivec2> visible;
    for (std::size_t i = 0; i < height_ranges_.size(); ++i) {
        const int column = int(i % std::size_t(block_columns_)) * kBlockCells;
        const int row = int(i / std::size_t(block_columns_)) * kBlockCells;
        const glm::dvec2 north_west = info.position(row, column);
        const glm::dvec2 south_east =
            info.position(std::min(row + kBlockCells, info.rows - 1),
                          std::min(column + kBlockCells, info.columns - 1));
        const HeightRange& range = height_ranges_[i];
        if (in_view({north_west.x, south_east.y, range.low},
                    {south_east.x, north_west.y, range.high}) &&
            !(hidden != nullptr && is_hidden(*hidden, info, row, column))) {
            visible.emplace_back(column, row);
        }
    }
    return visible;
}

/// A whole block's heights, row by row; what lies beyond the border has the border's height.
void ReferencePicture::stage_heights(const glm::ivec2& north_west, float* heights) const {
    const TerrainInfo& info = terrain_->info();
    const int width = std::min(kBlockVertices, info.columns - north_west.x);
    for (int i = 0; i < kBlockVertices; ++i, heights += kBlockVertices) {
        const int row = std::min(north_west.y + i, info.rows - 1);
        const std::size_t first =
            std::size_t(row) * std::size_t(info.columns) + std::size_t(north_west.x);
        const auto samples = terrain_->samples().subspan(first, std::size_t(width));
        std::fill_n(std::ranges::copy(samples, heights).out, kBlockVertices - width,
                    samples.back());
    }
}

void ReferencePicture::draw(const Camera& camera, const measure::HiddenGround* hidden,
                            const std::function<void()>& after_batch) {
    const std::vector<glm::ivec2> blocks = visible_blocks(camera, hidden);
    heights_.bind(heights_unit_);
    for (std::size_t first = 0; first < blocks.size(); first += kBatchBlocks) {
        const auto batch = std::span(blocks).subspan(
            first, std::min<std::size_t>(kBatchBlocks, blocks.size() - first));
        for (std::size_t i = 0; i < batch.size(); ++i) {
            stage_heights(batch[i], &batch_heights_[i * kBlockSamples]);
        }
        heights_.write(0, 0, 0, kBlockVertices, int(batch.size()) * kBlockVertices, GL_RED,
                       GL_FLOAT, batch_heights_.data());
        north_wests_.write(batch);
        device_.draw_elements(program_, vertices_, GL_TRIANGLES, kBlockIndices, GL_UNSIGNED_SHORT,
                              0, GLsizei(batch.size()));
        terrain_->forget();
        after_batch();
    }
}

}  // namespace lodbench::run
