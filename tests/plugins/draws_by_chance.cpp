// In each process another number of triangles, all of which collapse: no two repetitions draw the
// same.

#include <random>

#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "quiet_method.h"

namespace {

class DrawsByChance final : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void upload(lodbench::gl::Device& device) override {
        device_ = &device;
        program_ = lodbench::gl::Program(
            device, "draws_by_chance", lodbench::embedded_shaders(),
            {{GL_VERTEX_SHADER, "draws_by_chance.vert"}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
        vertices_ = lodbench::gl::VertexArray(device, "draws_by_chance: vertices");
    }
    void draw(const lodbench::View&) override {
        device_->draw_arrays(program_, vertices_, GL_TRIANGLES, 0, 3 * triangles_);
    }
    void release(lodbench::gl::Device&) override {
        vertices_ = {};
        program_ = {};
    }

private:
    GLsizei triangles_ = 1 + GLsizei(std::random_device{}() % 20000);
    lodbench::gl::Device* device_ = nullptr;
    lodbench::gl::Program program_;
    lodbench::gl::VertexArray vertices_;
};

}  // namespace

QUIET_PLUGIN(DrawsByChance, "draws-by-chance");
