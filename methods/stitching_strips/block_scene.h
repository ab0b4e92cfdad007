#pragma once
// The heights and blocks of dss and tess-pow2 on the GPU, and their draw calls.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "api/params.h"
#include "gl/device.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "stitching_strips/block_cut.h"
#include "stitching_strips/terrain_block.h"

namespace lodbench::stitching_strips {

/// Parameters that both have.
struct BlockOptions {
    MetricOptions metric;
    ErrorKind error;
    bool culling;

    explicit BlockOptions(const Params& params);
    /// Of a camera where blocks out of view are left out.
    [[nodiscard]] std::optional<common::ViewFrustum> frustum(const Camera& camera) const;
};

/// Places in `cut.leaves` of those that may be seen, hierarchically: what is in a block that is not
/// in view is not looked at (3.3.2).
void list_visible(const BlockTree& tree, const BlockCut& cut,
                  const std::optional<common::ViewFrustum>& frustum, std::vector<int>& visible);

class BlockScene {
public:
    explicit BlockScene(std::string label) : label_(std::move(label)) {}

    void upload(gl::Device& device, const GroundHeights& ground, std::size_t most_blocks);
    void release();

    /// Freezes what is drawn: `blocks` by number, and the numbers of those that are drawn.
    void freeze(std::span<const TerrainBlock> blocks, std::span<const int> drawn);
    /// With the heights at texture unit 0 and the blocks at storage binding 2.
    void draw();

    [[nodiscard]] std::size_t tessellated_vertices() const { return tessellated_vertices_; }

private:
    std::string label_;
    gl::Device* device_ = nullptr;
    gl::Program program_;
    gl::Texture heights_;
    gl::Buffer blocks_, drawn_;
    gl::VertexArray none_;
    std::vector<std::size_t> vertices_;  ///< by drawn block: what it is tessellated into
    std::size_t tessellated_vertices_ = 0;
};

}  // namespace lodbench::stitching_strips
