// full-grid: every sample of the terrain, every frame, two triangles a cell. The reference that the
// level-of-detail methods are measured against; it has no paper, no quality knob and no error.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "api/method.h"
#include "full_grid/blocks.h"
#include "gl/device.h"
#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"

namespace lodbench::full_grid {
namespace {

/// A run of visible blocks of one shape in one tile: one instanced draw call.
struct Draw {
    int tile = 0;
    int shape = 0;
    GLuint first = 0;
    GLsizei count = 0;
};

class FullGrid final : public Method {
public:
    explicit FullGrid(const Params& params) : tile_samples_(int(params.integer("tile_samples"))) {}

    void prepare(const Terrain& terrain, gl::Device& device) override {
        terrain_ = &terrain;
        const TerrainInfo& info = terrain.info();
        plan_ = make_plan(info.rows, info.columns,
                          std::min(tile_samples_, device.info().max_texture_size));
    }

    /// Reads each tile once, in strips of one row of blocks: what the processor holds at a time is
    /// 65 rows.
    void upload(gl::Device& device) override {
        device_ = &device;
        program_ = gl::Program(
            device, "full-grid", embedded_shaders(),
            {{GL_VERTEX_SHADER, "full_grid.vert"}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
        std::vector<float> strip;
        for (std::size_t i = 0; i < plan_.tiles.size(); ++i) {
            const SampleRect& tile = plan_.tiles[i];
            gl::Texture& texture =
                textures_.emplace_back(device, fmt::format("full-grid: heights {}", i),
                                       GL_TEXTURE_2D, GL_R32F, tile.columns, tile.rows);
            texture.set_parameter(GL_TEXTURE_MIN_FILTER, GL_NEAREST);
            texture.set_parameter(GL_TEXTURE_MAG_FILTER, GL_NEAREST);
            for (int row = 0; row < tile.rows - 1; row += kBlockCells) {
                const int rows = std::min(kBlockCells + 1, tile.rows - row);
                strip.resize(std::size_t(rows) * std::size_t(tile.columns));
                const SampleRect rect{tile.row + row, tile.column, rows, tile.columns};
                terrain_->read(rect, strip);
                texture.write(0, 0, row, tile.columns, rows, GL_RED, GL_FLOAT, strip.data());
                find_height_ranges(int(i), rect, strip);
            }
        }
        instances_ = gl::Buffer(device, "full-grid: visible blocks",
                                plan_.blocks.size() * sizeof(glm::ivec2));
        for (const BlockShape& shape : plan_.shapes) {
            const auto indices = block_indices(shape);
            const std::string name =
                fmt::format("full-grid: block {}x{}", shape.columns, shape.rows);
            indices_.emplace_back(device, name, std::span<const std::uint16_t>(indices));
            gl::VertexArray& vertices = vertex_arrays_.emplace_back(device, name);
            vertices.integer_attribute(0, 2, GL_INT, instances_, 0, sizeof(glm::ivec2), 1);
            vertices.elements(indices_.back());
        }
        visible_.reserve(plan_.blocks.size());
    }

    void select(const Camera& camera, const Clock&) override {
        const Visibility visibility(camera, terrain_->info());
        visible_.clear();
        draws_.clear();
        for (const Block& block : plan_.blocks) {
            if (!visibility.may_see(block, plan_.shapes[std::size_t(block.shape)])) continue;
            if (draws_.empty() || draws_.back().tile != block.tile ||
                draws_.back().shape != block.shape) {
                draws_.push_back({block.tile, block.shape, GLuint(visible_.size()), 0});
            }
            ++draws_.back().count;
            visible_.emplace_back(block.column, block.row);
        }
        if (!visible_.empty()) instances_.write(std::span<const glm::ivec2>(visible_));
    }

    void draw(const View&) override {
        for (const Draw& draw : draws_) {
            const BlockShape& shape = plan_.shapes[std::size_t(draw.shape)];
            const SampleRect& tile = plan_.tiles[std::size_t(draw.tile)];
            textures_[std::size_t(draw.tile)].bind(0);
            program_.set("tile_sample", glm::ivec2(tile.column, tile.row));
            program_.set("block_vertices_x", shape.columns + 1);
            device_->draw_elements(program_, vertex_arrays_[std::size_t(draw.shape)], GL_TRIANGLES,
                                   GLsizei(3 * shape.triangle_count()), GL_UNSIGNED_SHORT, 0,
                                   draw.count, 0, draw.first);
        }
    }

    [[nodiscard]] Counters counters() const override {
        return {{"blocks_visible", double(visible_.size())},
                {"blocks_total", double(plan_.blocks.size())}};
    }

    void release(gl::Device&) override {
        vertex_arrays_.clear();
        indices_.clear();
        textures_.clear();
        instances_ = {};
        program_ = {};
    }

private:
    /// `rect` is a strip of `tile`, one row of blocks and the samples at its southern border.
    void find_height_ranges(int tile, const SampleRect& rect, const std::vector<float>& heights) {
        for (Block& block : plan_.blocks) {
            if (block.tile != tile || block.row != rect.row) continue;
            const BlockShape& shape = plan_.shapes[std::size_t(block.shape)];
            float low = heights[std::size_t(block.column - rect.column)];
            float high = low;
            for (int row = 0; row <= shape.rows; ++row) {
                const auto first = heights.begin() + std::ptrdiff_t(row) * rect.columns +
                                   (block.column - rect.column);
                const auto [min, max] = std::minmax_element(first, first + shape.columns + 1);
                low = std::min(low, *min);
                high = std::max(high, *max);
            }
            block.min_height = low;
            block.max_height = high;
        }
    }

    int tile_samples_;
    const Terrain* terrain_ = nullptr;
    gl::Device* device_ = nullptr;
    Plan plan_;
    gl::Program program_;
    std::vector<gl::Texture> textures_;  ///< one a tile
    gl::Buffer instances_;               ///< north-west samples of the visible blocks
    std::vector<gl::Buffer> indices_;    ///< one a shape
    std::vector<gl::VertexArray> vertex_arrays_;
    std::vector<glm::ivec2> visible_;
    std::vector<Draw> draws_;
};

constexpr ParamSpec kParams[] = {
    integer_param("tile_samples", 16384, kBlockCells + 1, 16384,
                  "longest edge of one height texture in samples; the driver's limit where lower")};

constexpr MethodDescriptor kMethods[] = {
    {.id = "full-grid",
     .title = "Full grid: every sample, frustum-culled in blocks",
     .citation = "",
     .version = "1",
     .capabilities = 0,
     .gl_extensions = nullptr,
     .params = kParams,
     .param_count = std::size(kParams),
     .quality_knob = nullptr,
     .claimed_bound = nullptr,
     .create = create_method<FullGrid>,
     .destroy = destroy_method}};

}  // namespace
}  // namespace lodbench::full_grid

LODBENCH_PLUGIN(lodbench::full_grid::kMethods);
