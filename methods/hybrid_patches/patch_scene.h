#pragma once
// What static-patches and hybrid-patches have in common: parameters, the grid with its criteria,
// the patches, the program, and the patches' places on the GPU.

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <string>

#include "api/method.h"
#include "common/leb_heights.h"
#include "common/leb_refiner.h"
#include "gl/program.h"
#include "hybrid_patches/patch_hierarchy.h"

namespace lodbench::hybrid_patches {

/// A patch as the vertex shader takes it: instance attributes 0 and 1.
struct PatchPlace {
    glm::ivec2 apex;  ///< column, row
    glm::ivec4 legs;  ///< from the apex to the left and the right end: column, row each
};
static_assert(sizeof(PatchPlace) == 24);

/// One command of an indirect draw of elements.
struct DrawCommand {
    GLuint index_count = 0;
    GLuint instance_count = 1;
    GLuint first_index = 0;
    GLint base_vertex = 0;
    GLuint first_instance = 0;
};
static_assert(sizeof(DrawCommand) == 20);

class PatchScene {
public:
    PatchScene(const Params& params, std::string label);

    void prepare(const Terrain& terrain);
    void upload(gl::Device& device);
    void release();

    [[nodiscard]] const common::RefinerOptions& options() const { return options_; }
    [[nodiscard]] const LebGrid& grid() const { return *grid_; }
    [[nodiscard]] const PatchHierarchy& hierarchy() const { return *hierarchy_; }
    [[nodiscard]] PatchPlace place(std::uint32_t patch) const;

    /// A vertex array with the instance attributes from `places` and these elements.
    [[nodiscard]] gl::VertexArray vertex_array(gl::Device& device, const gl::Buffer& places,
                                               const gl::Buffer& elements) const;
    /// The program, with the heights bound.
    [[nodiscard]] const gl::Program& program() const;
    [[nodiscard]] const std::string& label() const { return label_; }

private:
    common::RefinerOptions options_;
    int segments_;
    std::string label_;
    int rows_ = 0, columns_ = 0;
    std::optional<LebGrid> grid_;
    std::optional<PatchHierarchy> hierarchy_;
    common::LebHeights heights_;
    gl::Program program_;
};

}  // namespace lodbench::hybrid_patches
