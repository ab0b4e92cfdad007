#pragma once
// The GPU's part of the errors activity: Yusuf, Mostafa, Elarif 2014, section 3.2.

#include <cstddef>
#include <vector>

#include "api/camera.h"
#include "api/terrain.h"
#include "gl/device.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "multi_context/block_errors.h"
#include "multi_context/layout.h"

namespace lodbench::multi_context {

struct ErrorsSettings {
    int k = 33;
    float delta = 1;     ///< pixels; the scale of the byte codes
    bool bytes = false;  ///< one byte a texel instead of a float
    bool whole = false;  ///< reads the whole texture back instead of the blocks' maxima
};

/// The errors texture of a terrain and the passes that fill it. All calls with the context of
/// `device` current. A camera's errors are made by `begin`, `evaluate_level` from 1 to n,
/// `start_read_back` and `finish_read_back`, in this order; `run` is all of them.
class ErrorsPass {
public:
    /// `heights`: R32F, a texel a sample, of a context that shares with this one; its writing is
    /// finished. Throws EnvironmentError where the driver has no memory or no such texture.
    ErrorsPass(gl::Device& device, const gl::Texture& heights, const TerrainInfo& terrain,
               const ErrorsSettings& settings);

    void run(const Camera& camera, BlockErrors& errors);

    void begin(const Camera& camera);
    /// The group errors of this level, 1 .. n, from the heights and those of the level below.
    void evaluate_level(int level);
    /// Gathers the blocks' maxima where those are read, and starts the transfer.
    void start_read_back();
    /// Waits for it.
    void finish_read_back(BlockErrors& errors);

    [[nodiscard]] const Layout& layout() const { return layout_; }
    /// What a read-back brings.
    [[nodiscard]] std::size_t read_back_bytes() const { return read_back_bytes_; }
    /// The errors texture in pixels, samples() a side; waits. For tests.
    [[nodiscard]] std::vector<float> read_texture() const;

private:
    void gather_blocks();

    gl::Device& device_;
    const gl::Texture& heights_;
    TerrainInfo terrain_;
    ErrorsSettings settings_;
    Layout layout_;
    gl::Program group_program_, block_program_;
    gl::Buffer camera_block_;  ///< Frozen, of the camera that the errors are for
    gl::Texture errors_;
    gl::Buffer block_errors_;
    std::size_t read_back_bytes_ = 0;
    gl::Buffer read_back_;
    const void* mapped_ = nullptr;  ///< read_back_, for good
    gl::Fence arrived_;
};

}  // namespace lodbench::multi_context
