#pragma once
// The table fault x metric: meshes that are wrong in one known way, drawn by the rasteriser that is
// there, and what each metric must say of them: an exact value, that it rises, or zero.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "conformance/surface_renderer.h"
#include "gl/frame_blocks.h"
#include "measure/truth.h"
#include "support/context_for_test.h"
#include "support/method_fixture.h"
#include "support/reference_view.h"

namespace lodbench::measure {

using terrain::HeightField;
using test::camera_at;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kExact = 1e-3;  // pixels: what the table asks for
// Pixel error also sees the rasteriser; see pixel_errors.h. The half step of llvmpipe's subpixel
// grid, 1/512 px in x and in y, comes on top.
inline constexpr double kRasteriser = kSettledPx + 0.003;

inline constexpr int kSide = 65;
inline constexpr double kSpacing = 10;
inline constexpr glm::dvec2 kOrigin{1000, 2000};
inline constexpr int kMiddle = kSide / 2;

/// z of a sample (row, column).
using Heights = std::function<double(int, int)>;

inline std::shared_ptr<const HeightField> terrain_of(const Heights& height) {
    TerrainInfo info;
    info.name = "fault";
    info.rows = info.columns = kSide;
    info.spacing = glm::dvec2(kSpacing);
    info.origin = kOrigin;
    std::vector<float> samples;
    for (int row = 0; row < kSide; ++row) {
        for (int column = 0; column < kSide; ++column)
            samples.push_back(float(height(row, column)));
    }
    return std::make_shared<HeightField>(info, std::move(samples));
}

struct Mesh {
    std::vector<glm::dvec3> corners;  // three a triangle, world

    void triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        corners.insert(corners.end(), {a, b, c});
    }
    void quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
        triangle(a, b, c);
        triangle(a, c, d);
    }
};

inline glm::dvec3 point(int row, int column, double z) {
    return {kOrigin.x + kSpacing * column, kOrigin.y + kSpacing * (kSide - 1 - row), z};
}

/// A grid through every `step`-th sample of the rectangle of samples, ends included.
inline void add_grid(Mesh& mesh, const Heights& height, int step = 1, int row0 = 0, int column0 = 0,
                     int row1 = kSide - 1, int column1 = kSide - 1) {
    const auto at = [&](int row, int column) { return point(row, column, height(row, column)); };
    for (int row = row0; row < row1; row += step) {
        for (int column = column0; column < column1; column += step) {
            mesh.quad(at(row, column), at(row + step, column), at(row + step, column + step),
                      at(row, column + step));
        }
    }
}

inline Mesh grid(const Heights& height, int step = 1) {
    Mesh mesh;
    add_grid(mesh, height, step);
    return mesh;
}

/// From the west, `distance` before the terrain, looking east and level; the nearest samples are in
/// view.
inline Camera from_west(double distance, double height, double fov = 60, double pitch = 0) {
    Camera camera = camera_at({kOrigin.x - distance, kOrigin.y + kSpacing * kMiddle, height}, 90,
                              pitch, 0, fov);
    camera.viewport = {320, 240};
    return camera;
}

inline CapturedSurface captured(const Mesh& mesh, const Camera& camera) {
    CapturedSurface surface;
    surface.origin = camera.position;
    for (const glm::dvec3& corner : mesh.corners) {
        surface.vertices.emplace_back(corner - camera.position);
    }
    return surface;
}

class FaultTable : public ::testing::Test {
protected:
    std::vector<float> depth_of(const Mesh& mesh, const HeightField& terrain,
                                const Camera& camera) {
        gl::Device& device = gl_.device;
        const gl::Texture color(device, "color", GL_TEXTURE_2D, GL_RGBA8, camera.viewport.width,
                                camera.viewport.height);
        const gl::Texture depth(device, "depth", GL_TEXTURE_2D, GL_DEPTH_COMPONENT32F,
                                camera.viewport.width, camera.viewport.height);
        const gl::Framebuffer framebuffer(device, "picture", &color, &depth);
        const gl::Frame frame = gl::make_frame(picture_view(camera), camera, terrain.info(), false);
        const gl::Buffer block(device, "Frame", std::span<const gl::Frame>(&frame, 1));
        block.bind_uniform(gl::kFrameBinding);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
        glViewport(0, 0, camera.viewport.width, camera.viewport.height);
        glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_GEQUAL);
        for (GLenum i = 0; i < 4; ++i) glEnable(GL_CLIP_DISTANCE0 + i);
        conformance::SurfaceRenderer(device, captured(mesh, camera)).draw(device);
        const std::size_t width = std::size_t(camera.viewport.width);
        const std::size_t height = std::size_t(camera.viewport.height);
        std::vector<float> upward(width * height);
        glReadPixels(0, 0, GLsizei(width), GLsizei(height), GL_DEPTH_COMPONENT, GL_FLOAT,
                     upward.data());
        std::vector<float> rows;
        for (std::size_t row = height; row-- > 0;) {
            rows.insert(rows.end(), upward.begin() + std::ptrdiff_t(row * width),
                        upward.begin() + std::ptrdiff_t((row + 1) * width));
        }
        EXPECT_TRUE(device.take_errors().empty());
        return rows;
    }

    /// One frame; `rasterised`: what reaches the picture, where that is not the mesh.
    TruthSummary truth(const HeightField& terrain, const Mesh& mesh, const Camera& camera,
                       const Mesh* rasterised = nullptr, std::optional<double> claimed = {}) {
        TruthMeter meter(terrain.samples(), terrain.info(), claimed);
        const std::vector<std::uint8_t> grey(
            3 * std::size_t(camera.viewport.width) * std::size_t(camera.viewport.height), 128);
        meter.take(0, camera, captured(mesh, camera), nullptr);
        (void)meter.measure(depth_of(rasterised == nullptr ? mesh : *rasterised, terrain, camera),
                            grey, lodbench::test::view_of(meter.terrain(), camera, grey));
        return meter.summary();
    }

    test::GlTest gl_;
};

inline void expect_no_cracks(const TruthSummary& truth) {
    EXPECT_EQ(truth.crack_total, 0U);
    EXPECT_EQ(truth.skirt_total, 0U);
    EXPECT_EQ(truth.unjudged, 0U);
}

inline void expect_all_covered(const TruthSummary& truth) {
    EXPECT_EQ(truth.screen.uncovered, 0U);
    EXPECT_EQ(truth.pixel.uncovered, 0U);
}

inline void expect_exact(const TruthSummary& truth) {
    ASSERT_GT(truth.screen.count, 10U);
    EXPECT_LE(*truth.screen.max, kExact);
    EXPECT_LE(*truth.visible.max, kExact);
    EXPECT_LE(*truth.pixel.max, kRasteriser);
    EXPECT_EQ(truth.silhouette_pixels, 0U);
    EXPECT_EQ(truth.silhouette_max, 0.0);
    EXPECT_LE(*truth.height_rmse_max, 1e-4);
    expect_all_covered(truth);
    expect_no_cracks(truth);
}

/// The greatest screen error by the interface's own projection, over samples of which both points
/// are before the near plane: `truth` and `drawn` in metres.
inline double expected_max(const Heights& truth, const Heights& drawn, const Camera& camera) {
    const auto inside = [&](const glm::dvec3& p) {
        for (const glm::dvec4& plane : camera.frustum_planes()) {
            if (glm::dot(glm::dvec3(plane), p - camera.position) + plane.w < 0) return false;
        }
        return true;
    };
    double greatest = 0;
    for (int row = 0; row < kSide; ++row) {
        for (int column = 0; column < kSide; ++column) {
            const glm::dvec3 a = point(row, column, truth(row, column));
            const glm::dvec3 b = point(row, column, drawn(row, column));
            if (!inside(a) && !inside(b)) continue;
            const auto pa = camera.project(a);
            const auto pb = camera.project(b);
            if (pa && pb) greatest = std::max(greatest, glm::distance(*pa, *pb));
        }
    }
    return greatest;
}

inline const Heights kFlat = [](int, int) { return 0.0; };
// Eastward up, steeper southward down.
inline const Heights kRamp = [](int row, int column) { return 0.5 * column - 0.25 * row; };

inline const Heights kHills = [](int row, int column) {
    return double(float(20 * std::sin(0.4 * column) + 12 * std::cos(0.3 * row + 0.2 * column)));
};

// 900 m radius, top at sample (32, 32).
inline constexpr double kRadius = 900;
inline const Heights kCap = [](int row, int column) {
    const double x = kSpacing * (column - kMiddle);
    const double y = kSpacing * (row - kMiddle);
    return double(float(std::sqrt(kRadius * kRadius - x * x - y * y) - 600));
};
inline const Heights kStep = [](int, int column) { return column >= 33 ? 40.0 : 0.0; };
inline const Heights kBump = [](int row, int column) {
    return row == kMiddle && column == 17 ? 30.0 : 0.0;
};

}  // namespace lodbench::measure
