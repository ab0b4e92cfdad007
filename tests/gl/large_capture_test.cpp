// Captures of one large draw call, every triangle checked; and the refusal of vertices that are not
// at w = 1.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/vec2.hpp>

#include "api/error.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "measure/capture.h"
#include "support/context_for_test.h"

namespace lodbench::gl {
namespace {

using test::GlTest;

constexpr ShaderSource kShaders[] = {
    // Triangle t, corner c at (t mod 4096, t div 4096, c), without any buffer.
    {"numbered.vert", R"(#version 450 core
uniform float w;
void main() {
    int triangle = gl_VertexID / 3;
    gl_Position = vec4(float(triangle % 4096), float(triangle / 4096), float(gl_VertexID % 3), w);
}
)"},
    {"white.frag", R"(#version 450 core
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0); }
)"},
};

struct Numbered {
    GlTest gl;
    VertexArray empty{gl.device, "empty"};
    Program program{gl.device,
                    "numbered",
                    kShaders,
                    {{GL_VERTEX_SHADER, "numbered.vert"}, {GL_FRAGMENT_SHADER, "white.frag"}}};

    explicit Numbered(float w = 1) { program.set("w", w); }
    measure::CapturedSurface capture(int triangles) {
        measure::CaptureView view;
        view.scale = 2;
        return measure::capture(gl.device, view, [&] {
            gl.device.draw_arrays(program, empty, GL_TRIANGLES, 0, 3 * triangles);
        });
    }
};

class LargeCapture : public testing::TestWithParam<int> {};

TEST_P(LargeCapture, holds_every_triangle_of_one_draw_call_once_and_in_order) {
    Numbered numbered;
    const measure::CapturedSurface surface = numbered.capture(GetParam());
    ASSERT_EQ(surface.triangle_count(), std::size_t(GetParam()));
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
        const std::size_t triangle = i / 3;
        const glm::vec3 expected(triangle % 4096, triangle / 4096, i % 3);
        wrong += surface.vertices[i] != 2.0F * expected ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0U);
    EXPECT_EQ(numbered.gl.device.take_errors(), std::vector<std::string>());
}

// Around the first buffer of 2^20 bytes = 21,845.33 triangles, odd above it, and above a million.
INSTANTIATE_TEST_SUITE_P(triangles, LargeCapture,
                         testing::Values(21'845, 21'846, 32'767, 1'200'001),
                         testing::PrintToStringParamName());

TEST(Capture, refuses_vertices_whose_w_is_not_one_and_is_closed_afterwards) {
    for (const float w : {2.0F, 0.0F, -1.0F, std::nextafter(1.0F, 2.0F)}) {
        Numbered numbered(w);
        try {
            static_cast<void>(numbered.capture(5));
            ADD_FAILURE() << w << " was accepted";
        } catch (const ContractError& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr("a vertex has w = "));
            EXPECT_THAT(error.what(), testing::HasSubstr("emit_terrain_vertex"));
        }
        EXPECT_FALSE(numbered.gl.device.capturing());
        EXPECT_FALSE(glIsEnabled(GL_RASTERIZER_DISCARD));
        numbered.program.set("w", 1.0F);
        EXPECT_EQ(numbered.capture(5).triangle_count(), 5U);
    }
}

}  // namespace
}  // namespace lodbench::gl
