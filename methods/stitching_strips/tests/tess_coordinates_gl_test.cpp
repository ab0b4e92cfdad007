// Tessellation coordinates: the CPU's, a shader's of ours and the driver's, to the bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <span>
#include <tuple>
#include <vector>

#include "gl/device.h"
#include "gl/host/draw_capture.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "stitching_strips/tess_coordinates.h"
#include "support/context_for_test.h"
#include "support/room_shaders.h"

namespace lodbench::stitching_strips {
namespace {

constexpr gl::ShaderSource kShaders[] = {{"patch.vert", R"(#version 450 core
void main() { gl_Position = vec4(0.0, 0.0, 0.0, 1.0); }
)"},
                                         {"patch.tesc", R"(#version 450 core
layout(vertices = 3) out;
uniform vec4 outer;
uniform vec2 inner;
void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    for (int i = 0; i < 4; ++i) gl_TessLevelOuter[i] = outer[i];
    for (int i = 0; i < 2; ++i) gl_TessLevelInner[i] = inner[i];
}
)"},
                                         {"patch.tese", R"(#version 450 core
layout(quads, fractional_even_spacing, ccw) in;
void main() { gl_Position = vec4(gl_TessCoord.xy, 0.0, 1.0); }
)"},
                                         {"white.frag", R"(#version 450 core
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0); }
)"}};

// Instance i has factor 2 + i / 64, vertex v the edge's vertex v.
constexpr const char* kEdge = R"(#version 450 core
#include "tess_coordinates.glsl"
uniform float first_factor;
void main() {
    float factor = first_factor + float(gl_InstanceID) / 64.0;
    int segments = tess_segments(factor);
    gl_Position = vec4(tess_coordinate(min(gl_VertexID, segments), factor), float(segments), 0.0, 1.0);
}
)";

using Points = std::vector<glm::vec2>;

Points in_order(Points points) {
    const auto key = [](const glm::vec2& point) { return std::tuple(point.x, point.y); };
    std::ranges::sort(points, {}, key);
    points.erase(std::ranges::unique(points, {}, key).begin(), points.end());
    return points;
}

class Tessellator : public testing::Test {
protected:
    /// Each once.
    Points tessellate(const QuadFactors& factors) { return in_order(triangles(factors)); }
    /// Three corners each.
    Points triangles(const QuadFactors& factors) {
        const auto& [left, bottom, right, top] = factors.outer;
        quads_.set("outer", glm::vec4(left, bottom, right, top));
        quads_.set("inner", glm::vec2(factors.inner[0], factors.inner[1]));
        Points points;
        capture([&](const glm::vec4& point) { points.emplace_back(point); },
                [&] { gl_.device.draw_arrays(quads_, none_, GL_PATCHES, 0, 3); });
        return points;
    }
    template <typename Take, typename Draw>
    void capture(const Take& take, const Draw& draw) {
        gl::begin_capture(gl_.device, [&](std::span<const glm::vec4> vertices) {
            std::ranges::for_each(vertices, take);
        });
        draw();
        gl::end_capture(gl_.device);
    }
    /// Direct3D's rule is not OpenGL's: a driver may place them otherwise.
    bool as_direct3d() {
        return tessellate({{11.25F, 23, 37.5F, 63}, {7, 2}}) ==
               in_order(quad_coordinates({{11.25F, 23, 37.5F, 63}, {7, 2}}));
    }

    test::GlTest gl_;
    gl::VertexArray none_{gl_.device, "test: none"};
    gl::Program quads_{gl_.device,
                       "test: quads",
                       kShaders,
                       {{GL_VERTEX_SHADER, "patch.vert"},
                        {GL_TESS_CONTROL_SHADER, "patch.tesc"},
                        {GL_TESS_EVALUATION_SHADER, "patch.tese"},
                        {GL_FRAGMENT_SHADER, "white.frag"}}};
};

std::vector<float> all_factors() {
    std::vector<float> factors;
    for (int i = 2 * 64; i <= 64 * 64; ++i) factors.push_back(float(i) / 64);
    return factors;
}

TEST_F(Tessellator, places_edges_and_inside_as_the_function_for_all_factors_in_steps_of_1_64) {
    if (!gl_.device.info().software && !as_direct3d()) {
        GTEST_SKIP() << "this driver places vertices otherwise, as OpenGL lets it";
    }
    for (const float factor : all_factors()) {
        // Edges and one line of inner vertices along u, then along v: few triangles, every
        // coordinate.
        for (const auto& inner : {std::array{factor, 2.0F}, std::array{2.0F, factor}}) {
            const QuadFactors factors{same_factors(factor).outer, inner};
            ASSERT_EQ(tessellate(factors), in_order(quad_coordinates(factors))) << factor;
        }
    }
}

TEST_F(Tessellator, places_vertices_as_the_function_where_all_six_factors_differ) {
    if (!gl_.device.info().software && !as_direct3d()) {
        GTEST_SKIP() << "this driver places vertices otherwise, as OpenGL lets it";
    }
    std::mt19937 random(19);
    std::uniform_real_distribution<float> any(1, 66);  // beyond both limits too
    for (int i = 0; i < 200; ++i) {
        const QuadFactors factors{{any(random), any(random), any(random), any(random)},
                                  {any(random), any(random)}};
        const Points expected = in_order(quad_coordinates(factors));
        ASSERT_EQ(tessellate(factors), expected) << i;
        EXPECT_EQ(quad_vertex_count(factors), quad_coordinates(factors).size());
    }
}

TEST_F(Tessellator, cuts_cells_along_the_diagonals_to_the_middle) {
    if (!gl_.device.info().software && !as_direct3d()) {
        GTEST_SKIP() << "this driver cuts cells as it likes, as OpenGL lets it";
    }
    for (const float factor : {2.0F, 4.0F, 5.3F, 6.0F, 17.25F, 62.0F, 64.0F}) {
        const std::vector<float> places = tess_coordinates(factor);
        const auto index = [&](float place) {
            return int(std::ranges::find(places, place) - places.begin());
        };
        const Points points = triangles(same_factors(factor));
        const int segments = tess_segments(factor);
        ASSERT_EQ(points.size(), std::size_t(6 * segments * segments));
        for (std::size_t i = 0; i < points.size(); i += 3) {
            std::array<glm::ivec2, 3> corners{};
            for (std::size_t corner = 0; corner < 3; ++corner) {
                corners[corner] = {index(points[i + corner].x), index(points[i + corner].y)};
            }
            const glm::ivec2 low = glm::min(glm::min(corners[0], corners[1]), corners[2]);
            const glm::ivec2 high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
            ASSERT_EQ(high - low, glm::ivec2(1, 1)) << factor;
            // A triangle has both ends of its cell's diagonal.
            const bool ascends =
                std::ranges::count(corners, low) + std::ranges::count(corners, high) == 2;
            EXPECT_EQ(ascends, diagonal_ascends(low.x, low.y, segments)) << factor;
        }
    }
}

TEST_F(Tessellator, has_its_function_in_shaders_to_the_bit) {
    std::vector<gl::ShaderSource> sources(std::begin(kShaders), std::end(kShaders));
    const test::RoomShaders room("stitching_strips");
    sources.insert(sources.end(), room.get().begin(), room.get().end());
    sources.push_back({"edge.vert", kEdge});
    gl::Program edges(gl_.device, "test: edges", sources,
                      {{GL_VERTEX_SHADER, "edge.vert"}, {GL_FRAGMENT_SHADER, "white.frag"}});
    constexpr int kVertices = 66;  // whole triangles of the 65 that an edge has at most
    // On the steps of 1/64, and between them.
    for (const float first : {2.0F, 2 + 0.3F / 64, 2 + 1e-5F}) {
        Points drawn;
        edges.set("first_factor", first);
        capture([&](const glm::vec4& point) { drawn.emplace_back(point); },
                [&] {
                    gl_.device.draw_arrays(edges, none_, GL_TRIANGLES, 0, kVertices,
                                           GLsizei(all_factors().size()));
                });
        ASSERT_EQ(drawn.size(), kVertices * all_factors().size());
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            const float factor = first + float(i / kVertices) / 64;
            const int segments = tess_segments(factor);
            const int index = std::min(int(i % kVertices), segments);
            ASSERT_EQ(drawn[i], glm::vec2(tess_coordinate(index, factor), segments))
                << factor << ' ' << index;
        }
    }
}

}  // namespace
}  // namespace lodbench::stitching_strips
