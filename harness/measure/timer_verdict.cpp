#include "measure/timer_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "gl/host/state.h"
#include "gl/objects.h"
#include "gl/program.h"

namespace lodbench::measure {

namespace {

constexpr int kSize = 256;
constexpr int kRounds = 7;
// Long enough that the bracket's own cost (two waits, tens of microseconds) does not matter.
constexpr double kLoadMs = 5;

constexpr gl::ShaderSource kShaders[] = {
    {"timer_load.vert", R"(#version 450 core
void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
    gl_Position = vec4(corner * 4.0 - 1.0, 0.5, 1.0);
}
)"},
    {"timer_load.frag", R"(#version 450 core
layout(location = 0) out vec4 color;
void main() {
    float value = gl_FragCoord.x * 0.001;
    for (int i = 0; i < 64; ++i) value = fract(value * 1.7 + sin(value));
    color = vec4(value);
}
)"},
};

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + kRounds / 2, values.end());
    return values[kRounds / 2];
}

}  // namespace

TimerVerdict judge_timer(double timer_ms, double bracket_ms) {
    TimerVerdict verdict;
    verdict.timer_ms = timer_ms;
    verdict.bracket_ms = bracket_ms;
    verdict.trustworthy =
        timer_ms >= 0.5 * bracket_ms && timer_ms <= 1.05 * bracket_ms && bracket_ms > 0;
    verdict.text = fmt::format(
        "GPU timer {}: {:.3f} ms by timestamp queries, {:.3f} ms between two glFinish{}",
        verdict.trustworthy ? "agrees with the clock" : "cannot be believed", timer_ms, bracket_ms,
        verdict.trustworthy ? "" : "; GPU times are bracketed instead");
    return verdict;
}

TimerVerdict test_timer(gl::Device& device) {
    using SteadyClock = std::chrono::steady_clock;
    const gl::PipelineState found = gl::PipelineState::capture();
    const gl::Texture color(device, "timer load", GL_TEXTURE_2D, GL_RGBA8, kSize, kSize);
    const gl::Framebuffer framebuffer(device, "timer load", &color, nullptr);
    const gl::VertexArray vertices(device, "timer load");
    const gl::Program program(
        device, "timer load", kShaders,
        {{GL_VERTEX_SHADER, "timer_load.vert"}, {GL_FRAGMENT_SHADER, "timer_load.frag"}});
    const gl::Query from(device, "timer load", GL_TIMESTAMP);
    const gl::Query to(device, "timer load", GL_TIMESTAMP);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glViewport(0, 0, kSize, kSize);
    for (const GLenum capability : {GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_CULL_FACE,
                                    GL_BLEND, GL_RASTERIZER_DISCARD}) {
        glDisable(capability);
    }
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);

    int draws = 1;
    const auto run = [&](double& timer_ms) {
        glFinish();
        const auto start = SteadyClock::now();
        from.timestamp();
        for (int i = 0; i < draws; ++i) device.draw_arrays(program, vertices, GL_TRIANGLES, 0, 3);
        to.timestamp();
        glFinish();
        const double bracket_ms =
            std::chrono::duration<double, std::milli>(SteadyClock::now() - start).count();
        // Signed: a timer that runs backwards must look like one.
        timer_ms = static_cast<double>(static_cast<std::int64_t>(to.wait() - from.wait())) * 1e-6;
        return bracket_ms;
    };
    double ignored = 0;
    run(ignored);  // compiles and allocates
    while (run(ignored) < kLoadMs && draws < 1 << 14) draws *= 2;
    std::vector<double> timer(kRounds);
    std::vector<double> bracket(kRounds);
    for (std::size_t round = 0; round < kRounds; ++round) bracket[round] = run(timer[round]);
    found.restore();
    return judge_timer(median(timer), median(bracket));
}

}  // namespace lodbench::measure
