#include "gl/host/alive_objects.h"

#include <fmt/format.h>

namespace lodbench::gl {

namespace {

struct Kind {
    const char* name;
    int AliveObjects::*count;
    GLboolean(APIENTRY* is_alive)(GLuint);
};
constexpr Kind kKinds[] = {
    {"buffers", &AliveObjects::buffers, &glIsBuffer},
    {"textures", &AliveObjects::textures, &glIsTexture},
    {"programs", &AliveObjects::programs, &glIsProgram},
    {"shaders", &AliveObjects::shaders, &glIsShader},
    {"vertex arrays", &AliveObjects::vertex_arrays, &glIsVertexArray},
    {"framebuffers", &AliveObjects::framebuffers, &glIsFramebuffer},
    {"renderbuffers", &AliveObjects::renderbuffers, &glIsRenderbuffer},
    {"queries", &AliveObjects::queries, &glIsQuery},
    {"samplers", &AliveObjects::samplers, &glIsSampler},
    {"transform feedbacks", &AliveObjects::transform_feedbacks, &glIsTransformFeedback},
    {"pipelines", &AliveObjects::pipelines, &glIsProgramPipeline},
};

}  // namespace

AliveObjects count_alive_objects(GLuint bound) {
    AliveObjects result;
    glUseProgram(0);  // a deleted program lives on while it is in use
    for (const Kind& kind : kKinds) {
        for (GLuint name = 1; name <= bound; ++name) {
            if (kind.is_alive(name) == GL_TRUE) ++(result.*kind.count);
        }
    }
    return result;
}

std::vector<std::string> differences(const AliveObjects& before, const AliveObjects& after) {
    std::vector<std::string> result;
    for (const Kind& kind : kKinds) {
        if (before.*kind.count == after.*kind.count) continue;
        result.push_back(fmt::format("{}: {} before, {} after", kind.name, before.*kind.count,
                                     after.*kind.count));
    }
    return result;
}

}  // namespace lodbench::gl
