#pragma once
// The true terrain, drawn by the harness itself: what a method's shaded picture is compared with.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <vector>

#include "api/camera.h"
#include "gl/device.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "measure/hidden_ground.h"
#include "terrain/whole_terrain.h"

namespace lodbench::run {

/// Every sample of the terrain, two triangles a cell (the diagonal from north-west to south-east),
/// through the shared shaders. Heights go to the GPU in batches of at most 16 blocks of 64 x 64
/// cells, with the indices of their parts of 8 x 8 cells that are not hidden, and are forgotten
/// with the next batch: 1.9 MB on the GPU, as much on the CPU and 8 bytes a block, however large
/// the terrain.
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
    /// is called each time that up to 130 thousand triangles are on their way.
    ///
    /// Changes no pipeline state, and of what a method may have bound only program and vertex
    /// array, which every draw call of gl::Device binds anew.
    /// `hidden`, where it is given, is the camera's: parts of blocks that it hides are not drawn.
    void draw(
        const Camera& camera, const measure::HiddenGround* hidden = nullptr,
        const std::function<void()>& after_batch = [] {});

private:
    struct HeightRange {
        float low = 0;
        float high = 0;
    };
    void find_height_ranges();
    /// A bit a part, in the order in which they are drawn: from north to south, eight a band.
    using Parts = std::uint64_t;
    struct Block {
        glm::ivec2 north_west;  ///< column, row
        Parts parts;            ///< that may be seen, one at least
    };
    [[nodiscard]] std::vector<Block> visible_blocks(const Camera& camera,
                                                    const measure::HiddenGround* hidden) const;
    [[nodiscard]] Parts visible_parts(const glm::ivec2& north_west,
                                      const measure::HiddenGround* hidden) const;
    void stage_heights(const glm::ivec2& north_west, float* heights) const;
    void draw_batch(std::span<const Block> batch);

    gl::Device& device_;
    std::shared_ptr<const terrain::WholeTerrain> terrain_;
    int block_columns_ = 0;
    int block_rows_ = 0;
    std::vector<HeightRange> height_ranges_;  ///< of the blocks, row by row from the north-west
    GLuint heights_unit_ = 0;
    std::vector<float> batch_heights_;
    std::vector<std::uint32_t> batch_indices_;
    gl::Program program_;
    GLint north_wests_ = 0;     ///< uniform: column, row of a batch's blocks
    gl::Texture heights_;       ///< a batch's blocks, one below the other
    gl::Buffer indices_;        ///< of a batch's parts
    gl::VertexArray vertices_;  ///< no attributes: the index says which sample
};

}  // namespace lodbench::run
