#pragma once
// The GPU's part of the errors activity: Yusuf, Mostafa, Elarif 2014, section 3.2.

#include <cstddef>
#include <functional>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "api/camera.h"
#include "api/terrain.h"
#include "gl/device.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "multi_context/block_errors.h"
#include "multi_context/layout.h"

namespace lodbench::multi_context {

/// What comes back from the GPU.
enum class ReadBack {
    whole,   ///< the errors texture, as in section 3.2
    blocks,  ///< the greatest error of every block
    tree,    ///< the same from the root down, below a block only where it must be split: section 5
};

struct ErrorsSettings {
    int k = 33;
    float delta = 1;     ///< pixels; the scale of the byte codes, and what `tree` splits above
    bool bytes = false;  ///< one byte a texel instead of a float
    ReadBack read_back = ReadBack::blocks;
    int parts = 1;  ///< in which `whole` and `blocks` come back, one after another
};

/// The errors texture of a terrain and the passes that fill it. All calls with the context of
/// `device` current. A camera's errors are made by `begin`, `evaluate_level` from 1 to n and
/// `read_back`, in this order; `run` is all of them.
class ErrorsPass {
public:
    /// `heights`: R32F, a texel a sample, of a context that shares with this one; its writing is
    /// finished. Throws EnvironmentError where the driver has no memory or no such texture.
    ErrorsPass(gl::Device& device, const gl::Texture& heights, const TerrainInfo& terrain,
               const ErrorsSettings& settings);

    /// Called between the parts of a read-back; may wait.
    using BetweenParts = std::function<void()>;

    void run(
        const Camera& camera, BlockErrors& errors, const BetweenParts& between = [] {});

    void begin(const Camera& camera);
    /// The group errors of this level, 1 .. n, from the heights and those of the level below.
    void evaluate_level(int level);
    /// Gathers the blocks' maxima where those are read, and brings what is read.
    void read_back(
        BlockErrors& errors, const BetweenParts& between = [] {});

    [[nodiscard]] const Layout& layout() const { return layout_; }
    /// The errors texture in pixels, samples() a side; waits. For tests.
    [[nodiscard]] std::vector<float> read_texture() const;

private:
    void read_whole(BlockErrors& errors, const BetweenParts& between);
    void read_blocks(BlockErrors& errors, const BetweenParts& between);
    void read_tree(BlockErrors& errors);
    void gather_every_block();
    /// The greatest errors of these blocks of one LOD, into the read-back buffer; waits.
    void gather(int lod, std::span<const glm::ivec2> blocks);
    void start_gathering(int lod);
    void wait_until_arrived();

    gl::Device& device_;
    const gl::Texture& heights_;
    TerrainInfo terrain_;
    ErrorsSettings settings_;
    Layout layout_;
    gl::Program group_program_, block_program_;
    gl::Buffer camera_block_;  ///< Frozen, of the camera that the errors are for
    gl::Texture errors_;
    gl::Buffer block_errors_;
    gl::Buffer listed_blocks_;      ///< of `tree`: those of one LOD that are gathered
    gl::Buffer read_back_;          ///< none where there is a single block at full resolution
    const void* mapped_ = nullptr;  ///< read_back_, for good
};

}  // namespace lodbench::multi_context
