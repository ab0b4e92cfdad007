#pragma once
// A method that keeps every promise: all samples, all triangles, each frame. The broken ones derive
// from it and break one promise each.

#include <glm/vec3.hpp>

#include "api/method.h"
#include "gl/device.h"
#include "gl/objects.h"
#include "gl/program.h"

namespace lodbench::broken {

class GridMethod : public Method {
public:
    explicit GridMethod(const Params&) {}
    void prepare(const Terrain& terrain, gl::Device& device) override;
    void upload(gl::Device& device) override;
    void select(const Camera& camera, const Clock& clock) override;
    void draw(const View& view) override;
    void release(gl::Device& device) override;

protected:
    /// Draws all triangles but the first `left_out`, moved by `shift` metres.
    void draw_grid(const glm::vec3& shift = glm::vec3(0), int left_out = 0);

    int step_ = 1;  ///< samples between two vertices
    const char* vertex_shader_ = "grid.vert";
    const Terrain* terrain_ = nullptr;
    gl::Device* device_ = nullptr;
    Camera camera_;
    gl::Program program_;
    gl::Buffer vertices_, indices_;
    gl::VertexArray array_;
    int index_count_ = 0;
};

}  // namespace lodbench::broken
