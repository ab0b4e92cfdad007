#include "stitching_strips/block_scene.h"

#include <functional>
#include <utility>

#include "api/method.h"
#include "gl/embedded_shaders.h"
#include "stitching_strips/patch_draws.h"
#include "stitching_strips/tess_coordinates.h"

namespace lodbench::stitching_strips {
namespace {

// Of block.tesc and strip.vert.
constexpr GLuint kBlocksBinding = 2, kDrawnBinding = 3;

/// One more than there are for an edge of one segment, which powers of two have: at most so many.
std::size_t vertex_count(const TerrainBlock& block) {
    return quad_vertex_count({{block.outer.x, block.outer.y, block.outer.z, block.outer.w},
                              {block.inner.x, block.inner.y}});
}

}  // namespace

BlockOptions::BlockOptions(const Params& params)
    : metric{.tau = params.real("tau"),
             .view_angle = params.boolean("view_angle"),
             .straight_down = params.choice("straight_down") == "zero" ? StraightDown::zero
                                                                       : StraightDown::block,
             .distance = params.choice("distance") == "box" ? Distance::box : Distance::centre},
      error(params.choice("error") == "max" ? ErrorKind::max : ErrorKind::average),
      culling(params.boolean("culling")) {}

std::optional<common::ViewFrustum> BlockOptions::frustum(const Camera& camera) const {
    if (!culling) return std::nullopt;
    return common::ViewFrustum(camera);
}

void list_visible(const BlockTree& tree, const BlockCut& cut,
                  const std::optional<common::ViewFrustum>& frustum, std::vector<int>& visible) {
    visible.clear();
    const std::function<void(int)> visit = [&](int number) {
        const Block& block = tree.block(number);
        if (frustum && (!block.on_ground || !frustum->may_see(block.box))) return;
        if (!cut.is_split(number)) {
            visible.push_back(cut.leaf(number));
            return;
        }
        for (int child = 0; child < 4; ++child) visit(first_child(number) + child);
    };
    visit(kRoot);
}

void BlockScene::upload(gl::Device& device, const GroundHeights& ground, std::size_t most_blocks) {
    device_ = &device;
    program_ = gl::Program(device, label_, embedded_shaders(),
                           {{GL_VERTEX_SHADER, "block.vert"},
                            {GL_TESS_CONTROL_SHADER, "block.tesc"},
                            {GL_TESS_EVALUATION_SHADER, "block.tese"},
                            {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
    heights_ = gl::Texture(device, label_ + ": heights", GL_TEXTURE_2D, GL_R32F, ground.columns(),
                           ground.rows());
    heights_.write(0, 0, 0, ground.columns(), ground.rows(), GL_RED, GL_FLOAT,
                   ground.from_the_north().data());
    blocks_ = gl::Buffer(device, label_ + ": blocks", most_blocks * sizeof(TerrainBlock));
    drawn_ = gl::Buffer(device, label_ + ": drawn blocks", most_blocks * sizeof(GLint));
    none_ = gl::VertexArray(device, label_ + ": none");
}

void BlockScene::release() {
    *this = BlockScene(label_);
}

void BlockScene::freeze(std::span<const TerrainBlock> blocks, std::span<const int> drawn) {
    blocks_.write(blocks);
    vertices_.clear();
    tessellated_vertices_ = 0;
    for (const int block : drawn) {
        vertices_.push_back(vertex_count(blocks[std::size_t(block)]));
        tessellated_vertices_ += vertices_.back();
    }
    if (!drawn.empty()) drawn_.write(drawn);
}

void BlockScene::draw() {
    heights_.bind(0);
    blocks_.bind_storage(kBlocksBinding);
    drawn_.bind_storage(kDrawnBinding);
    glPatchParameteri(GL_PATCH_VERTICES, 1);
    draw_in_runs(
        int(vertices_.size()), [this](int block) { return vertices_[std::size_t(block)]; },
        [this](GLint first, GLsizei count) {
            device_->draw_arrays(program_, none_, GL_PATCHES, first, count);
        });
    glPatchParameteri(GL_PATCH_VERTICES, 3);
    // Mesa (22.3) has the next program hold the place of the tessellation stages, if it has none,
    // and never lets go of it.
    glUseProgram(0);
}

}  // namespace lodbench::stitching_strips
