// pgm: a grid over the screen, mapped by the vertex shader onto the terrain; no tree, no error
// metric. Yotam Livny, Neta Sokolovsky, Tal Grinshpoun, Jihad El-Sana: Persistent Grid Mapping: A
// GPU-based Framework for Interactive Terrain Rendering (2006). In core. Deviations: see README.md.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "api/method.h"
#include "gl/device.h"
#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "persistent_grid/mapping.h"
#include "persistent_grid/pyramid.h"

namespace lodbench::persistent_grid {
namespace {

namespace block {
using glm::ivec4;
using glm::vec4;
#define BLOCK(binding_, name_) struct name_
#include "persistent_grid/mapping_block.glsl"
#undef BLOCK
}  // namespace block
using block::MappingBlock;
constexpr GLuint kMappingBinding = gl::kFirstFreeBinding;  // PGM_MAPPING_BINDING of pgm.vert
constexpr std::size_t kLevelsOffset = 80;
constexpr std::size_t kMaximumLevels = 24;
static_assert(offsetof(MappingBlock, levels) == kLevelsOffset &&
              sizeof(MappingBlock) == kLevelsOffset + 16 * kMaximumLevels);

/// Two triangles a cell, in bands of eight columns from the horizon downward, so that a vertex is
/// reused while it is still in the vertex cache. Neighbours share vertices by index, hence to the
/// bit.
std::vector<std::uint32_t> grid_indices(const GridSize& grid) {
    constexpr int kBand = 8;
    std::vector<std::uint32_t> indices;
    indices.reserve(6 * std::size_t(grid.columns - 1) * std::size_t(grid.rows - 1));
    for (int band = 0; band < grid.columns - 1; band += kBand) {
        const int end = std::min(band + kBand, grid.columns - 1);
        for (int row = 0; row < grid.rows - 1; ++row) {
            for (int column = band; column < end; ++column) {
                const auto far_left = std::uint32_t(row * grid.columns + column);
                const auto near_left = far_left + std::uint32_t(grid.columns);
                indices.insert(indices.end(), {far_left, near_left, near_left + 1, far_left,
                                               near_left + 1, far_left + 1});
            }
        }
    }
    return indices;
}

GridSize grid_size(const Params& params) {
    constexpr double kMaximumVertices = 1 << 26;  // 1.6 GB of indices
    const int rows = int(params.integer("grid"));
    const double columns = std::max(2.0, std::round(rows * params.real("aspect")));
    if (columns * rows > kMaximumVertices) {
        throw InputError(
            fmt::format("grid = {} with aspect = {} makes {} vertices, more than {}; lower one",
                        rows, params.real("aspect"), columns * rows, kMaximumVertices));
    }
    return {int(columns), rows};
}

class PersistentGrid final : public Method {
public:
    explicit PersistentGrid(const Params& params)
        : grid_(grid_size(params)),
          margin_(params.real("margin")),
          base_near_ground_(params.choice("base") == "minimum-near"),
          parent_(params.boolean("parent")) {}

    void prepare(const Terrain& terrain, gl::Device& device) override {
        info_ = terrain.info();
        const int limit = device.info().max_texture_size;
        if (info_.columns > limit || info_.rows > limit) {
            throw EnvironmentError(
                fmt::format("pgm holds the whole terrain in one texture: {} x {} samples are more "
                            "than the {} x {} "
                            "that this driver allows; use a smaller terrain",
                            info_.columns, info_.rows, limit, limit));
        }
        Level finest{info_.columns, info_.rows, {}};
        finest.heights.resize(std::size_t(info_.columns) * std::size_t(info_.rows));
        terrain.read({0, 0, info_.rows, info_.columns}, finest.heights);
        if (base_near_ground_) local_minimum_ = LocalMinimum(finest);
        levels_ = make_pyramid(std::move(finest));
    }

    void upload(gl::Device& device) override {
        device_ = &device;
        program_ = gl::Program(
            device, "pgm", embedded_shaders(),
            {{GL_VERTEX_SHADER, "pgm.vert"}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
        const AtlasLayout layout = atlas_layout(levels_);
        finest_ = make_texture(device, "pgm: finest heights", {info_.columns, info_.rows});
        coarse_ = make_texture(device, "pgm: coarse heights", layout.size);
        block_ = {};
        block_.grid = {grid_.columns, grid_.rows, int(levels_.size()), 0};
        for (std::size_t i = 0; i < levels_.size(); ++i) {
            const Level& level = levels_[i];
            const glm::ivec2 origin = layout.origins[i];
            (i == 0 ? finest_ : coarse_)
                .write(0, origin.x, origin.y, level.columns, level.rows, GL_RED, GL_FLOAT,
                       level.heights.data());
            block_.levels[i] = {origin.x, origin.y, level.columns, level.rows};
        }
        levels_ = {};  // the textures hold them from here on
        mapping_buffer_ =
            gl::Buffer(device, "pgm: mapping", sizeof block_, GL_DYNAMIC_STORAGE_BIT, &block_);
        const auto indices = grid_indices(grid_);
        index_count_ = GLsizei(indices.size());
        indices_ = gl::Buffer(device, "pgm: grid", std::span<const std::uint32_t>(indices));
        vertices_ = gl::VertexArray(device, "pgm: grid");
        vertices_.elements(indices_);
    }

    void select(const Camera& camera, const Clock&) override {
        base_height_ = 0;
        if (base_near_ground_) {
            const glm::dvec2 east_north =
                (glm::dvec2(camera.position) - info_.origin) / info_.spacing;
            base_height_ = local_minimum_.at({east_north.x, info_.rows - 1 - east_north.y});
        }
        mapping_ = make_mapping(camera, info_, base_height_, margin_, grid_);
        block_.ray_first = glm::dvec4(mapping_.first, mapping_.eye_height);
        block_.ray_across = glm::dvec4(mapping_.across, mapping_.far_distance);
        block_.ray_down = glm::dvec4(mapping_.down, std::sin(mapping_.ray_angle));
        block_.sampling = glm::dvec4(std::cos(mapping_.ray_angle),
                                     1 / std::max(info_.spacing.x, info_.spacing.y), parent_, 0);
        mapping_buffer_.write(0, kLevelsOffset, &block_);  // the levels behind it never change
    }

    void draw(const View&) override {
        mapping_buffer_.bind_uniform(kMappingBinding);
        finest_.bind(0);
        coarse_.bind(1);
        device_->draw_elements(program_, vertices_, GL_TRIANGLES, index_count_, GL_UNSIGNED_INT);
    }

    [[nodiscard]] Counters counters() const override {
        return {{"auxiliary_pitch_degrees", mapping_.pitch * 57.295779513082320},
                {"auxiliary_restricted", mapping_.restricted ? 1.0 : 0.0},
                {"base_height_m", base_height_},
                {"eye_height_above_base_m", mapping_.eye_height}};
    }

    void release(gl::Device&) override {
        vertices_ = {};
        indices_ = {};
        mapping_buffer_ = {};
        coarse_ = {};
        finest_ = {};
        program_ = {};
    }

private:
    static gl::Texture make_texture(gl::Device& device, const char* label, glm::ivec2 size) {
        gl::Texture texture(device, label, GL_TEXTURE_2D, GL_R32F, size.x, size.y);
        texture.set_parameter(GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        texture.set_parameter(GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        return texture;
    }

    GridSize grid_;
    double margin_;
    bool base_near_ground_;
    bool parent_;
    TerrainInfo info_;
    std::vector<Level> levels_;  ///< between prepare and upload
    LocalMinimum local_minimum_;
    gl::Device* device_ = nullptr;
    gl::Program program_;
    gl::Texture finest_, coarse_;
    gl::Buffer mapping_buffer_, indices_;
    gl::VertexArray vertices_;
    GLsizei index_count_ = 0;
    MappingBlock block_{};
    Mapping mapping_;
    double base_height_ = 0;
};

constexpr ParamSpec kParams[] = {
    integer_param("grid", 240, 2, 2048,
                  "rows of the grid: vertices from top to bottom of the picture"),
    real_param("aspect", 4.0 / 3.0, 0.05, 20, "columns of the grid per row (150x600: 0.25)"),
    real_param("margin", 0.05, 0, 1, "part by which the grid extends beyond the picture"),
    choice_param("base", "zero", "zero|minimum-near",
                 "base plane: z = 0 as in the paper, or the lowest ground near the viewpoint"),
    boolean_param("parent", true, "blend in the coarser level's height, equation (4)")};

constexpr MethodDescriptor kMethods[] = {
    {.id = "pgm",
     .title = "Persistent grid mapping: a screen grid mapped onto the terrain by the GPU",
     .citation =
         "Yotam Livny, Neta Sokolovsky, Tal Grinshpoun, Jihad El-Sana (2006): Persistent Grid "
         "Mapping: A GPU-based Framework for Interactive Terrain Rendering",
     .version = "1",
     .capabilities = 0,
     .gl_extensions = nullptr,
     .params = kParams,
     .param_count = std::size(kParams),
     .quality_knob = "grid",
     .claimed_bound = nullptr,
     .create = create_method<PersistentGrid>,
     .destroy = destroy_method}};

}  // namespace
}  // namespace lodbench::persistent_grid

LODBENCH_PLUGIN(lodbench::persistent_grid::kMethods);
