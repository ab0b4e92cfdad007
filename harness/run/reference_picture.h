#pragma once
// The true terrain, drawn by the harness itself: what a method's shaded picture is compared with.

#include <cstddef>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <vector>

#include "api/camera.h"
#include "gl/device.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "measure/hidden_ground.h"
#include "terrain/whole_terrain.h"

namespace lodbench::run {

/// Every sample of the terrain, two triangles a cell (the diagonal from north-west to south-east),
/// through the shared shaders. Heights go to the GPU in batches of at most 64 blocks of 64 x 64
/// cells and are forgotten with the next batch: 1.1 MB on the GPU, as much on the CPU and 8 bytes a
/// block, however large the terrain.
///
/// The arithmetic is that of the shared shaders, so that any method that sends the same triangles
/// draws the same picture to the bit on the same driver, but for pixels where two of its triangles
/// have equal depth: there the one drawn later wins (GL_GEQUAL), and the order is a method's own.
/// Here: blocks row by row from the north-west, in a block bands of eight columns from north to
/// south.
class ReferencePicture {
public:
    /// Reads every sample once, for the blocks' height ranges. The device must outlive the object.
    /// Throws EnvironmentError when the driver has no memory.
    ReferencePicture(gl::Device& device, std::shared_ptr<const terrain::WholeTerrain> terrain);

    /// Draws the blocks that `camera` may see into the framebuffer that is bound and cleared, in
    /// the state that Stage sets; `Frame` and `Frozen` must be filled for the camera. `after_batch`
    /// is called each time that up to half a million triangles are on their way.
    ///
    /// Changes no pipeline state, and of what a method may have bound only program and vertex
    /// array, which every draw call of gl::Device binds anew.
    /// `hidden`, where it is given, is the camera's: blocks that it hides are not drawn.
    void draw(
        const Camera& camera, const measure::HiddenGround* hidden = nullptr,
        const std::function<void()>& after_batch = [] {});

private:
    struct HeightRange {
        float low = 0;
        float high = 0;
    };
    void find_height_ranges();
    [[nodiscard]] std::vector<glm::ivec2> visible_blocks(const Camera& camera,
                                                         const measure::HiddenGround* hidden) const;
    void stage_heights(const glm::ivec2& north_west, float* heights) const;

    gl::Device& device_;
    std::shared_ptr<const terrain::WholeTerrain> terrain_;
    int block_columns_ = 0;
    int block_rows_ = 0;
    std::vector<HeightRange> height_ranges_;  ///< of the blocks, row by row from the north-west
    GLuint heights_unit_ = 0;
    std::vector<float> batch_heights_;
    gl::Program program_;
    gl::Texture heights_;       ///< a batch's blocks, one below the other
    gl::Buffer north_wests_;    ///< a batch's blocks: column, row of the north-west sample
    gl::Buffer indices_;        ///< of one block
    gl::VertexArray vertices_;  ///< per instance: a block's north-west sample
};

}  // namespace lodbench::run
