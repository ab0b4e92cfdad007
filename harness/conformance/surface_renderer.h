#pragma once
// Draws captured triangles as the picture draws a method's, to see whether both are the same
// surface.

#include <vector>

#include "api/camera.h"
#include "gl/device.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "measure/capture.h"

namespace lodbench::conformance {

/// The captured triangles through the harness's own program: vertices relative to the frozen eye,
/// as they were fed back, and the shared clipping to the extent.
class SurfaceRenderer {
public:
    SurfaceRenderer(gl::Device& device, const measure::CapturedSurface& surface);
    /// Clears the depth of the framebuffer that is bound and draws into it; `Frame` must be filled,
    /// which a draw of the stage through the same view has done.
    void draw(gl::Device& device);

private:
    gl::Program program_;
    gl::Buffer positions_;
    gl::VertexArray vertices_;
    GLsizei count_ = 0;
};

}  // namespace lodbench::conformance
