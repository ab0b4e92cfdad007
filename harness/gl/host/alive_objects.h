#pragma once
// Objects alive in the context, those made with bare OpenGL calls included: how leaks are seen.

#include <GL/glcorearb.h>

#include <string>
#include <vector>

namespace lodbench::gl {

/// Counts by kind. Names that were generated but never bound are not objects yet and cannot be
/// seen.
struct AliveObjects {
    int buffers = 0, textures = 0, programs = 0, shaders = 0, vertex_arrays = 0, framebuffers = 0,
        renderbuffers = 0, queries = 0, samplers = 0, transform_feedbacks = 0, pipelines = 0;
    friend bool operator==(const AliveObjects&, const AliveObjects&) = default;
};

/// Asks for every name from 1 to `bound`: drivers give out the lowest free name, so a bound above
/// the number of objects ever alive at once finds all. Leaves no program in use. Tens of
/// milliseconds; never timed.
[[nodiscard]] AliveObjects count_alive_objects(GLuint bound = 1U << 14);

/// What has grown or shrunk: "textures: 3 before, 5 after".
[[nodiscard]] std::vector<std::string> differences(const AliveObjects& before,
                                                   const AliveObjects& after);

}  // namespace lodbench::gl
