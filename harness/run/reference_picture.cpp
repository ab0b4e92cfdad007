#include "run/reference_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
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
constexpr int kBlockVertices = kBlockCells + 1;  // along an edge
constexpr std::size_t kBlockSamples = std::size_t{kBlockVertices} * kBlockVertices;
/// Cells along the edge of a part: as wide as a band, so that parts one below the other are one.
constexpr int kPartCells = 8;
constexpr int kParts = kBlockCells / kPartCells;  // along an edge
constexpr std::size_t kPartIndices = 6 * kPartCells * kPartCells;

/// 130 thousand triangles a draw call: hundredths of a second of a software rasteriser, far below
/// what makes a desktop's driver give up on a GPU.
constexpr int kBatchBlocks = 16;
constexpr std::size_t kMostIndices = kBatchBlocks * kParts * kParts * kPartIndices;

/// A vertex's index says its block in the batch, and its row and column in the block.
constexpr unsigned kRowShift = 7, kBlockShift = 14;

// A block that the border cuts is drawn whole: what lies beyond is put onto the border, where it
// makes triangles with two equal vertices, which cover no pixel.
constexpr std::array<gl::ShaderSource, 1> kSources = {
    {{"run/reference_picture.vert", R"GLSL(#version 450 core
#include "common/terrain.glsl"
uniform ivec2 north_wests[BATCH_BLOCKS];  // column, row
layout(binding = HEIGHTS_UNIT) uniform sampler2D heights;
void main() {
    int block = gl_VertexID >> BLOCK_SHIFT;
    int row = gl_VertexID >> ROW_SHIFT & (1 << BLOCK_SHIFT - ROW_SHIFT) - 1;
    ivec2 inside = ivec2(gl_VertexID & (1 << ROW_SHIFT) - 1, row);
    ivec2 texel = ivec2(inside.x, block * BLOCK_VERTICES + inside.y);
    ivec2 grid_sample = min(north_wests[block] + inside, eye_sample.zw - 1);
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

std::uint32_t vertex(unsigned block, unsigned row, unsigned column) {
    return block << kBlockShift | row << kRowShift | column;
}

/// Of the first part of the first block; counter-clockwise seen from above. Rows of eight columns,
/// so that a vertex is still in the vertex cache (or the software pipeline's run of a thousand
/// indices) when the row below needs it.
std::array<std::uint32_t, kPartIndices> part_indices() {
    std::array<std::uint32_t, kPartIndices> indices;
    std::size_t i = 0;
    for (unsigned row = 0; row < kPartCells; ++row) {
        for (unsigned column = 0; column < kPartCells; ++column) {
            const std::uint32_t nw = vertex(0, row, column);
            const std::uint32_t ne = vertex(0, row, column + 1);
            const std::uint32_t sw = vertex(0, row + 1, column);
            const std::uint32_t se = vertex(0, row + 1, column + 1);
            for (const std::uint32_t corner : {nw, sw, se, nw, se, ne}) indices[i++] = corner;
        }
    }
    return indices;
}

/// Covers the picture's own float arithmetic (a handful of roundings of 6e-8), so that nothing that
/// reaches a pixel is left out.
constexpr double kSlack = 1e-6;

/// Whether the part that begins at a sample of the grid is hidden.
bool is_hidden(const measure::HiddenGround& hidden, const TerrainInfo& info, int first_row,
               int first_column) {
    constexpr int kBlock = measure::HiddenGround::kBlockCells;
    static_assert(kPartCells % kBlock == 0);
    const int end_row = std::min(first_row + kPartCells, info.rows - 1);
    const int end_column = std::min(first_column + kPartCells, info.columns - 1);
    for (int row = first_row; row < end_row; row += kBlock) {
        for (int column = first_column; column < end_column; column += kBlock) {
            if (!hidden.block(row / kBlock, column / kBlock)) return false;
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
               {{"BATCH_BLOCKS", fmt::format("{}", kBatchBlocks)},
                {"BLOCK_SHIFT", fmt::format("{}", kBlockShift)},
                {"BLOCK_VERTICES", fmt::format("{}", kBlockVertices)},
                {"ROW_SHIFT", fmt::format("{}", kRowShift)},
                {"HEIGHTS_UNIT", fmt::format("{}", heights_unit_)}}),
      north_wests_(glGetUniformLocation(program_.name(), "north_wests")),
      heights_(device, "host: reference heights", GL_TEXTURE_2D, GL_R32F, kBlockVertices,
               kBatchBlocks * kBlockVertices),
      indices_(device, "host: reference parts", kMostIndices * sizeof(std::uint32_t)),
      vertices_(device, "host: reference picture") {
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

std::vector<ReferencePicture::Block> ReferencePicture::visible_blocks(
    const Camera& camera, const measure::HiddenGround* hidden) const {
    const TerrainInfo& info = terrain_->info();
    const measure::BoxInView in_view(camera, kSlack);
    std::vector<Block> visible;
    for (std::size_t i = 0; i < height_ranges_.size(); ++i) {
        const glm::ivec2 first(int(i % std::size_t(block_columns_)) * kBlockCells,
                               int(i / std::size_t(block_columns_)) * kBlockCells);
        const glm::dvec2 north_west = info.position(first.y, first.x);
        const glm::dvec2 south_east =
            info.position(std::min(first.y + kBlockCells, info.rows - 1),
                          std::min(first.x + kBlockCells, info.columns - 1));
        const HeightRange& range = height_ranges_[i];
        if (!in_view({north_west.x, south_east.y, range.low},
                     {south_east.x, north_west.y, range.high})) {
            continue;
        }
        if (const Parts parts = visible_parts(first, hidden); parts != 0) {
            visible.push_back({first, parts});
        }
    }
    return visible;
}

ReferencePicture::Parts ReferencePicture::visible_parts(const glm::ivec2& north_west,
                                                        const measure::HiddenGround* hidden) const {
    const TerrainInfo& info = terrain_->info();
    Parts parts = 0;
    Parts bit = 1;
    for (int band = 0; band < kParts; ++band) {
        for (int part = 0; part < kParts; ++part, bit <<= 1U) {
            const int row = north_west.y + part * kPartCells;
            const int column = north_west.x + band * kPartCells;
            // Beyond the border there is nothing but its line.
            if (row >= info.rows - 1 || column >= info.columns - 1) continue;
            if (hidden == nullptr || !is_hidden(*hidden, info, row, column)) parts |= bit;
        }
    }
    return parts;
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

void ReferencePicture::draw_batch(std::span<const Block> batch) {
    static const std::array<std::uint32_t, kPartIndices> kPart = part_indices();
    std::array<glm::ivec2, kBatchBlocks> north_wests{};
    batch_indices_.clear();
    for (unsigned i = 0; i < batch.size(); ++i) {
        north_wests[i] = batch[i].north_west;
        stage_heights(batch[i].north_west, &batch_heights_[i * kBlockSamples]);
        for (Parts left = batch[i].parts; left != 0; left &= left - 1) {
            const unsigned part = unsigned(std::countr_zero(left));
            const std::uint32_t first =
                vertex(i, part % kParts * kPartCells, part / kParts * kPartCells);
            for (const std::uint32_t index : kPart) batch_indices_.push_back(first + index);
        }
    }
    heights_.write(0, 0, 0, kBlockVertices, int(batch.size()) * kBlockVertices, GL_RED, GL_FLOAT,
                   batch_heights_.data());
    indices_.write(std::span<const std::uint32_t>(batch_indices_));
    glProgramUniform2iv(program_.name(), north_wests_, kBatchBlocks, &north_wests[0].x);
    device_.draw_elements(program_, vertices_, GL_TRIANGLES, GLsizei(batch_indices_.size()),
                          GL_UNSIGNED_INT);
}

void ReferencePicture::draw(const Camera& camera, const measure::HiddenGround* hidden,
                            const std::function<void()>& after_batch) {
    const std::vector<Block> blocks = visible_blocks(camera, hidden);
    heights_.bind(heights_unit_);
    for (std::size_t first = 0; first < blocks.size(); first += kBatchBlocks) {
        draw_batch(std::span(blocks).subspan(
            first, std::min<std::size_t>(kBatchBlocks, blocks.size() - first)));
        // A software rasteriser keeps every triangle until it has a reason to draw: 70 MB of them.
        glFinish();
        terrain_->forget();
        after_batch();
    }
}

}  // namespace lodbench::run
