// Not broken: ten collapsed triangles and a fixed amount of arithmetic a frame, so that its times
// are as even as the machine is. Built a second time with one triangle more in one frame
// (LODBENCH_MORE_IN_FRAME), and slower by the share that is asked for, it is what a comparison of
// two runs must find.

#include <cstdint>
#include <iterator>

#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "quiet_method.h"

namespace {

#ifndef LODBENCH_MORE_IN_FRAME
#define LODBENCH_MORE_IN_FRAME (-1)
#endif
#ifndef LODBENCH_MORE_WORK
#define LODBENCH_MORE_WORK 0
#endif

constexpr lodbench::ParamSpec kParams[] = {
    lodbench::integer_param("work", 200, 0, 1'000'000, "thousands of steps of arithmetic a frame"),
    lodbench::integer_param("slowdown", 0, 0, 1000, "% of them more"),
};

class Steady final : public QuietMethod {
public:
    explicit Steady(const lodbench::Params& params)
        : QuietMethod(params),
          steps_(params.integer("work") * 10 *
                 (100 + LODBENCH_MORE_WORK + params.integer("slowdown"))) {}
    void upload(lodbench::gl::Device& device) override {
        device_ = &device;
        program_ = lodbench::gl::Program(device, "steady", lodbench::embedded_shaders(),
                                         {{GL_VERTEX_SHADER, "draws_by_chance.vert"},
                                          {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
        vertices_ = lodbench::gl::VertexArray(device, "steady: vertices");
    }
    void select(const lodbench::Camera&, const lodbench::Clock& clock) override {
        triangles_ = clock.frame == LODBENCH_MORE_IN_FRAME ? 11 : 10;
        // Each step waits for the one before, and the last is stored: none can be left out.
        std::uint64_t state = std::uint64_t(clock.frame);
        for (std::int64_t i = 0; i < steps_; ++i) {
            state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        }
        result_ = state;
    }
    void draw(const lodbench::View&) override {
        device_->draw_arrays(program_, vertices_, GL_TRIANGLES, 0, 3 * triangles_);
    }
    void release(lodbench::gl::Device&) override {
        vertices_ = {};
        program_ = {};
    }

private:
    std::int64_t steps_;
    volatile std::uint64_t result_ = 0;
    GLsizei triangles_ = 10;
    lodbench::gl::Device* device_ = nullptr;
    lodbench::gl::Program program_;
    lodbench::gl::VertexArray vertices_;
};

constexpr lodbench::MethodDescriptor kMethods[] = {[] {
    lodbench::MethodDescriptor descriptor = quiet_descriptor<Steady>("steady");
    descriptor.title = "Steady";
    descriptor.params = kParams;
    descriptor.param_count = std::size(kParams);
    return descriptor;
}()};

}  // namespace

LODBENCH_PLUGIN(kMethods);
