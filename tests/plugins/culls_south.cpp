// Not broken: every sample, raised by a metre, and by two behind the eye, whose south is left out,
// by one of the two methods only where `culling` is on. So what the whole terrain's error is can be
// worked out on paper.

#include <algorithm>
#include <cmath>
#include <vector>

#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "quiet_method.h"

namespace {

class CullsSouth : public QuietMethod {
public:
    explicit CullsSouth(const lodbench::Params& params)
        : QuietMethod(params),
          culling_(!params.values().contains("culling") || params.boolean("culling")) {}

    void prepare(const lodbench::Terrain& terrain, lodbench::gl::Device&) override {
        info_ = terrain.info();
        heights_.resize(std::size_t(info_.rows) * std::size_t(info_.columns));
        terrain.read({0, 0, info_.rows, info_.columns}, heights_);
    }
    void upload(lodbench::gl::Device& device) override {
        device_ = &device;
        program_ = lodbench::gl::Program(
            device, "culls_south", lodbench::embedded_shaders(),
            {{GL_VERTEX_SHADER, "culls_south.vert"}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
        texture_ = lodbench::gl::Texture(device, "culls_south: heights", GL_TEXTURE_2D, GL_R32F,
                                         info_.columns, info_.rows);
        texture_.write(0, 0, 0, info_.columns, info_.rows, GL_RED, GL_FLOAT, heights_.data());
        vertices_ = lodbench::gl::VertexArray(device, "culls_south: none");
    }
    void select(const lodbench::Camera& camera, const lodbench::Clock&) override {
        const double from_south = (camera.position.y - info_.origin.y) / info_.spacing.y;
        eye_row_ = std::clamp(info_.rows - 1 - int(std::lround(from_south)), 1, info_.rows - 1);
    }
    void draw(const lodbench::View&) override {
        texture_.bind(0);
        program_.set("cells", info_.columns - 1);
        program_.set("eye_row", eye_row_);
        const int rows = culling_ ? eye_row_ : info_.rows - 1;
        device_->draw_arrays(program_, vertices_, GL_TRIANGLES, 0, 6 * rows * (info_.columns - 1));
    }
    void release(lodbench::gl::Device&) override {
        vertices_ = {};
        texture_ = {};
        program_ = {};
    }

private:
    bool culling_;
    int eye_row_ = 1;
    lodbench::TerrainInfo info_;
    std::vector<float> heights_;
    lodbench::gl::Device* device_ = nullptr;
    lodbench::gl::Program program_;
    lodbench::gl::Texture texture_;
    lodbench::gl::VertexArray vertices_;
};

constexpr lodbench::ParamSpec kParams[] = {
    lodbench::boolean_param("culling", true, "leaves out what is south of the eye")};

constexpr lodbench::MethodDescriptor kMethods[] = {
    [] {
        lodbench::MethodDescriptor descriptor = quiet_descriptor<CullsSouth>("culls-south");
        descriptor.params = kParams;
        descriptor.param_count = std::size(kParams);
        return descriptor;
    }(),
    quiet_descriptor<CullsSouth>("always-culls-south")};

}  // namespace

LODBENCH_PLUGIN(kMethods);
