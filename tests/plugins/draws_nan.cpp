#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "quiet_method.h"

namespace {

class Broken final : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void upload(lodbench::gl::Device& device) override {
        device_ = &device;
        program_ = lodbench::gl::Program(
            device, "draws_nan", lodbench::embedded_shaders(),
            {{GL_VERTEX_SHADER, "draws_nan.vert"}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
        vertices_ = lodbench::gl::VertexArray(device, "draws_nan: vertices");
    }
    void draw(const lodbench::View&) override {
        device_->draw_arrays(program_, vertices_, GL_TRIANGLES, 0, 3);
    }
    void release(lodbench::gl::Device&) override {
        vertices_ = {};
        program_ = {};
    }

private:
    lodbench::gl::Device* device_ = nullptr;
    lodbench::gl::Program program_;
    lodbench::gl::VertexArray vertices_;
};

}  // namespace

QUIET_PLUGIN(Broken, "draws-nan");
