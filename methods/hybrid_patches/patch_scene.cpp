#include "hybrid_patches/patch_scene.h"

#include <utility>

#include "gl/device.h"
#include "gl/embedded_shaders.h"
#include "hybrid_patches/patch_strip.h"

namespace lodbench::hybrid_patches {

// What the shader says.
static_assert(common::LebHeights::kBinding == 2 && common::LebHeights::kTextureUnit == 0);

PatchScene::PatchScene(const Params& params, std::string label)
    : options_{.tau = params.real("tau"),
               .error = params.choice("error") == "accumulated" ? common::ErrorKind::accumulated
                                                                : common::ErrorKind::midpoint,
               .metric = params.choice("metric") == "planar" ? Metric::planar : Metric::euclidean,
               .culling = params.boolean("culling")},
      segments_(std::stoi(params.choice("patch_samples")) - 1),
      label_(std::move(label)) {}

void PatchScene::prepare(const Terrain& terrain) {
    rows_ = terrain.info().rows;
    columns_ = terrain.info().columns;
    PatchHierarchy::require_few(terrain.info(), segments_);
    grid_.emplace(terrain);
    common::compute_errors_by_level(*grid_, options_.error);
    hierarchy_.emplace(*grid_, segments_, rows_, columns_);
}

void PatchScene::upload(gl::Device& device) {
    heights_ = common::LebHeights(device, label_ + ": heights", *grid_, rows_, columns_);
    program_ = gl::Program(
        device, label_, embedded_shaders(),
        {{GL_VERTEX_SHADER, "patches.vert"}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}},
        heights_.defines());
    program_.set("segments", segments_);
    program_.set("terrain_size", glm::ivec2(columns_, rows_));
}

void PatchScene::release() {
    heights_ = {};
    program_ = {};
}

PatchPlace PatchScene::place(std::uint32_t patch) const {
    const Triangle& t = hierarchy_->patch(patch).triangle;
    return {{t.apex.column, t.apex.row},
            {t.left.column - t.apex.column, t.left.row - t.apex.row, t.right.column - t.apex.column,
             t.right.row - t.apex.row}};
}

gl::VertexArray PatchScene::vertex_array(gl::Device& device, const gl::Buffer& places,
                                         const gl::Buffer& elements) const {
    gl::VertexArray vertices(device, label_);
    vertices.integer_attribute(0, 2, GL_INT, places, 0, sizeof(PatchPlace), 1);
    vertices.integer_attribute(1, 4, GL_INT, places, sizeof(glm::ivec2), sizeof(PatchPlace), 1);
    vertices.elements(elements);
    return vertices;
}

const gl::Program& PatchScene::program() const {
    heights_.bind();
    return program_;
}

}  // namespace lodbench::hybrid_patches
