// tess-uniform: Method II of Zhang 2019, section 4.1, after its [60] (A. R. Fernandes, B. Oliveira,
// GPU Tessellation: We Still Have a LOD of Terrain to Cover, 2012). Blocks of equal size; factors
// in the control shader. Absent from the paper: blocks out of view are left out.

#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "gl/device.h"
#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "stitching_strips/methods.h"
#include "stitching_strips/patch_draws.h"
#include "stitching_strips/tess_coordinates.h"
#include "stitching_strips/uniform_blocks.h"

namespace lodbench::stitching_strips {
namespace {

struct Options {
    double tau;
    int block_cells;
    bool edge_length;
    ErrorKind error;
    bool view_angle, culling;
    explicit Options(const Params& params)
        : tau(params.real("tau")),
          block_cells(int(params.integer("block_cells"))),
          edge_length(params.choice("metric") == "edge_length"),
          error(params.choice("error") == "max" ? ErrorKind::max : ErrorKind::average),
          view_angle(params.boolean("view_angle")),
          culling(params.boolean("culling")) {}
};

class TessUniform final : public Method {
public:
    explicit TessUniform(const Params& params) : options_(params) {}

    void prepare(const Terrain& terrain, gl::Device&) override {
        const TerrainInfo& info = terrain.info();
        ground_.emplace(terrain);
        blocks_.emplace(info.rows, info.columns, options_.block_cells);
        boxes_ = uniform_boxes(terrain, *blocks_);
        // Their buffer is there in any case: a shader's block of storage must not be without one.
        errors_.assign(1, {});
        if (!options_.edge_length) errors_ = uniform_errors(*ground_, *blocks_, options_.error);
    }

    void upload(gl::Device& device) override {
        device_ = &device;
        program_ = gl::Program(device, "tess-uniform", embedded_shaders(),
                               {{GL_VERTEX_SHADER, "block.vert"},
                                {GL_TESS_CONTROL_SHADER, "uniform.tesc"},
                                {GL_TESS_EVALUATION_SHADER, "block.tese"},
                                {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
        const int columns = ground_->columns(), rows = ground_->rows();
        heights_ =
            gl::Texture(device, "tess-uniform: heights", GL_TEXTURE_2D, GL_R32F, columns, rows);
        heights_.write(0, 0, 0, columns, rows, GL_RED, GL_FLOAT, ground_->from_the_north().data());
        ground_.reset();
        error_buffer_ =
            gl::Buffer(device, "tess-uniform: errors", std::span<const BlockErrors>(errors_));
        errors_ = {};
        visible_buffer_ = gl::Buffer(device, "tess-uniform: visible blocks",
                                     std::size_t(blocks_->size()) * sizeof(GLint));
        none_ = gl::VertexArray(device, "tess-uniform: none");
    }

    void select(const Camera& camera, const Clock&) override {
        const common::ViewFrustum frustum(camera);
        visible_.clear();
        for (int block = 0; block < blocks_->size(); ++block) {
            if (options_.culling && !frustum.may_see(boxes_[std::size_t(block)])) continue;
            visible_.push_back(block);
        }
        if (!visible_.empty()) visible_buffer_.write(std::span<const GLint>(visible_));
    }

    void draw(const View&) override {
        heights_.bind(0);
        visible_buffer_.bind_storage(2);
        error_buffer_.bind_storage(3);
        program_.set("block_count", blocks_->count);
        program_.set("block_cells", blocks_->cells);
        program_.set("tau", float(options_.tau));
        program_.set("edge_length", int(options_.edge_length));
        program_.set("view_angle", int(options_.view_angle));
        glPatchParameteri(GL_PATCH_VERTICES, 1);
        // Of the factors only the GPU knows.
        const std::size_t most = quad_vertex_count(same_factors(kMaxFactor));
        draw_in_runs(
            int(visible_.size()), [&](int) { return most; },
            [&](GLint first, GLsizei count) {
                device_->draw_arrays(program_, none_, GL_PATCHES, first, count);
            });
        glPatchParameteri(GL_PATCH_VERTICES, 3);
    }

    [[nodiscard]] Counters counters() const override {
        return {{"blocks_visible", double(visible_.size())},
                {"blocks_total", double(blocks_->size())}};
    }

    void release(gl::Device&) override {
        none_ = {};
        visible_buffer_ = {};
        error_buffer_ = {};
        heights_ = {};
        program_ = {};
    }

private:
    Options options_;
    std::optional<GroundHeights> ground_;  ///< until it is uploaded
    std::optional<UniformBlocks> blocks_;
    std::vector<common::Box> boxes_;
    std::vector<BlockErrors> errors_;  ///< until they are uploaded
    gl::Device* device_ = nullptr;
    gl::Program program_;
    gl::Texture heights_;
    gl::Buffer error_buffer_, visible_buffer_;
    gl::VertexArray none_;
    std::vector<GLint> visible_;  ///< numbers of blocks
};

}  // namespace

Method* create_tess_uniform(const Params& params, CreateError* error) noexcept {
    return create_method<TessUniform>(params, error);
}

}  // namespace lodbench::stitching_strips
