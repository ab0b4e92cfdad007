#pragma once
// The pipeline state that a method must leave as it found it.

#include <string>
#include <vector>

namespace lodbench::gl {

/// A snapshot of the current context: framebuffers, viewport, scissor, depth, clip control,
/// blending, masks, culling, polygon mode and offset, clip distances, rasteriser discard, stencil,
/// primitive restart, multisampling, pixel store, active feedback and queries, the host's uniform
/// blocks, debug output. Bound programs, vertex arrays, textures and bindings from
/// kFirstFreeBinding up are a method's own and left out.
class PipelineState {
public:
    [[nodiscard]] static PipelineState capture();

    /// What `found` has otherwise than this: "GL_DEPTH_TEST: expected enabled, found disabled".
    [[nodiscard]] std::vector<std::string> differences(const PipelineState& found) const;

    /// Sets all of it; open feedback and queries that were not active are ended.
    void restore() const;

private:
    /// Every value as glGetDoublev gives it, exact for 32-bit integers, in the order of the tables
    /// of state.cpp.
    std::vector<bool> enabled_;
    std::vector<std::vector<double>> values_;
};

}  // namespace lodbench::gl
