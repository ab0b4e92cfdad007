// The table fault x metric: meshes that are wrong in one known way, drawn by the rasteriser that is
// there, and what each metric must say of them: an exact value, that it rises, or zero.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "conformance/surface_renderer.h"
#include "context_for_test.h"
#include "gl/frame_blocks.h"
#include "measure/truth.h"
#include "method_fixture.h"

namespace lodbench::measure {
namespace {

using terrain::HeightField;
using test::camera_at;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kExact = 1e-3;  // pixels: what the table asks for
// Pixel error also sees the rasteriser; see pixel_errors.h. The half step of llvmpipe's subpixel
// grid, 1/512 px in x and in y, comes on top.
constexpr double kRasteriser = kSettledPx + 0.003;

constexpr int kSide = 65;
constexpr double kSpacing = 10;
constexpr glm::dvec2 kOrigin{1000, 2000};
constexpr int kMiddle = kSide / 2;

/// z of a sample (row, column).
using Heights = std::function<double(int, int)>;

std::shared_ptr<const HeightField> terrain_of(const Heights& height) {
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

glm::dvec3 point(int row, int column, double z) {
    return {kOrigin.x + kSpacing * column, kOrigin.y + kSpacing * (kSide - 1 - row), z};
}

/// A grid through every `step`-th sample of the rectangle of samples, ends included.
void add_grid(Mesh& mesh, const Heights& height, int step = 1, int row0 = 0, int column0 = 0,
              int row1 = kSide - 1, int column1 = kSide - 1) {
    const auto at = [&](int row, int column) { return point(row, column, height(row, column)); };
    for (int row = row0; row < row1; row += step) {
        for (int column = column0; column < column1; column += step) {
            mesh.quad(at(row, column), at(row + step, column), at(row + step, column + step),
                      at(row, column + step));
        }
    }
}

Mesh grid(const Heights& height, int step = 1) {
    Mesh mesh;
    add_grid(mesh, height, step);
    return mesh;
}

/// From the west, `distance` before the terrain, looking east and level; the nearest samples are in
/// view.
Camera from_west(double distance, double height, double fov = 60, double pitch = 0) {
    Camera camera = camera_at({kOrigin.x - distance, kOrigin.y + kSpacing * kMiddle, height}, 90,
                              pitch, 0, fov);
    camera.viewport = {320, 240};
    return camera;
}

CapturedSurface captured(const Mesh& mesh, const Camera& camera) {
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
                            grey, grey);
        return meter.summary();
    }

    test::GlTest gl_;
};

void expect_no_cracks(const TruthSummary& truth) {
    EXPECT_EQ(truth.crack_total, 0U);
    EXPECT_EQ(truth.skirt_total, 0U);
    EXPECT_EQ(truth.unjudged, 0U);
}

void expect_all_covered(const TruthSummary& truth) {
    EXPECT_EQ(truth.screen.uncovered, 0U);
    EXPECT_EQ(truth.pixel.uncovered, 0U);
}

void expect_exact(const TruthSummary& truth) {
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
double expected_max(const Heights& truth, const Heights& drawn, const Camera& camera) {
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

const Heights kFlat = [](int, int) { return 0.0; };
// Eastward up, steeper southward down.
const Heights kRamp = [](int row, int column) { return 0.5 * column - 0.25 * row; };
const Heights kHills = [](int row, int column) {
    return double(float(20 * std::sin(0.4 * column) + 12 * std::cos(0.3 * row + 0.2 * column)));
};
// 900 m radius, top at sample (32, 32).
constexpr double kRadius = 900;
const Heights kCap = [](int row, int column) {
    const double x = kSpacing * (column - kMiddle);
    const double y = kSpacing * (row - kMiddle);
    return double(float(std::sqrt(kRadius * kRadius - x * x - y * y) - 600));
};
const Heights kStep = [](int, int column) { return column >= 33 ? 40.0 : 0.0; };
const Heights kBump = [](int row, int column) {
    return row == kMiddle && column == 17 ? 30.0 : 0.0;
};

TEST_F(FaultTable, every_sample_drawn_is_zero_in_every_column) {
    for (const Heights& heights : {kFlat, kRamp, kHills, kCap, kStep, kBump}) {
        const auto terrain = terrain_of(heights);
        for (const Camera& camera :
             {from_west(100, 60), from_west(20, 200, 90, -30), from_west(-100, 300, 60, -80),
              from_west(3000, 100, 5), from_west(50, 40, 120)}) {
            expect_exact(truth(*terrain, grid(heights), camera));
        }
    }
}

TEST_F(FaultTable, one_metre_too_high_is_lambda_over_depth) {
    const auto terrain = terrain_of(kFlat);
    const Heights raised = [](int, int) { return 1.0; };
    for (const double distance : {100.0, 1000.0, 10000.0}) {
        for (const double fov : {5.0, 60.0, 120.0}) {
            const Camera camera = from_west(distance, 0.02 * distance, fov);
            const TruthSummary found = truth(*terrain, grid(raised), camera);
            // The nearest samples stand at this depth, and a level camera does not foreshorten.
            EXPECT_NEAR(*found.screen.max, camera.lambda() / distance, kExact)
                << distance << " " << fov;
            EXPECT_NEAR(*found.height_rmse_max, 1, 1e-6);
            // Seen from far away no pixel's centre may fall on the terrain.
            if (found.pixel.count > 0) {
                EXPECT_GT(*found.pixel.max, 0.5 * camera.lambda() / (distance + 640));
            }
            expect_all_covered(found);
            expect_no_cracks(found);
        }
    }
}

TEST_F(FaultTable, one_metre_at_a_hundred_is_two_pixels_of_240_over_60_degrees) {
    const Mesh raised = grid([](int, int) { return 1.0; });
    const TruthSummary found = truth(*terrain_of(kFlat), raised, from_west(100, 20));
    EXPECT_NEAR(*found.screen.max, 2.0785, kExact);  // 120 / tan(30 degrees) / 100
}

TEST_F(FaultTable, one_metre_too_high_off_axis_is_what_the_camera_projects) {
    const auto terrain = terrain_of(kFlat);
    const Heights raised = [](int, int) { return 1.0; };
    for (const double fov : {5.0, 60.0, 120.0}) {
        for (const double pitch : {-0.4 * fov, -0.2 * fov, -20.0, -60.0}) {
            Camera camera = from_west(-200, 150, fov, pitch);
            camera.near_plane = 0.5;
            const TruthSummary found = truth(*terrain, grid(raised), camera);
            if (found.screen.count == 0) continue;
            EXPECT_NEAR(*found.screen.max, expected_max(kFlat, raised, camera), kExact)
                << fov << " " << pitch;
            expect_no_cracks(found);
        }
    }
}

TEST_F(FaultTable, each_second_sample_has_the_closed_form_chord_error_and_is_exact_on_a_ramp) {
    const Camera camera = from_west(150, 350, 60, -10);
    expect_exact(truth(*terrain_of(kRamp), grid(kRamp, 2), camera));

    const auto terrain = terrain_of(kCap);
    const Heights half = [](int row, int column) {
        // The diagonal runs from the north-west: on it and on the edges the chord's middle is
        // drawn.
        const int r = row - row % 2, c = column - column % 2;
        if (row % 2 == 0 && column % 2 == 0) return kCap(row, column);
        if (row % 2 == 0) return (kCap(r, c) + kCap(r, c + 2)) / 2;
        if (column % 2 == 0) return (kCap(r, c) + kCap(r + 2, c)) / 2;
        return (kCap(r, c) + kCap(r + 2, c + 2)) / 2;
    };
    const TruthSummary found = truth(*terrain, grid(kCap, 2), camera);
    EXPECT_NEAR(*found.screen.max, expected_max(kCap, half, camera), kExact);
    // Near the top a chord of two samples sags by s^2 / 2R, a diagonal one by twice that, and on
    // the flank by more: the height error is between.
    EXPECT_GT(*found.height_rmse_max, 0.5 * kSpacing * kSpacing / (2 * kRadius));
    EXPECT_GT(*found.pixel.max, 0.05);
    expect_all_covered(found);
    expect_no_cracks(found);
}

TEST_F(FaultTable, a_missed_bump_is_its_own_height_at_its_own_depth) {
    const auto terrain = terrain_of(kBump);
    for (const double fov : {5.0, 60.0, 120.0}) {
        const Camera camera = from_west(830, 16, fov);
        const TruthSummary found = truth(*terrain, grid(kFlat), camera);
        EXPECT_NEAR(*found.screen.max, 30 * camera.lambda() / 1000, kExact);
        EXPECT_EQ(found.screen_worst->row, kMiddle);
        EXPECT_EQ(found.screen_worst->column, 17);
        // Of all samples one is wrong: where there are enough of them P99.9 does not see it.
        if (found.screen.count > 1000) {
            EXPECT_LE(*found.screen.p999, kExact);
        }
        // At 120 degrees it is narrower than a pixel.
        if (fov < 100) {
            EXPECT_GT(*found.pixel.max, 1);
        }
        expect_all_covered(found);
        expect_no_cracks(found);
    }
}

TEST_F(FaultTable, a_step_is_missed_by_half_of_it) {
    const auto terrain = terrain_of(kStep);
    const Camera camera = from_west(100, 80);
    // Column 33 is the first high one and odd: drawn halfway.
    const TruthSummary found = truth(*terrain, grid(kStep, 2), camera);
    EXPECT_NEAR(*found.screen.max, 20 * camera.lambda() / (100 + 330), kExact);
    EXPECT_EQ(found.screen_worst->column, 33);
    expect_all_covered(found);
    expect_no_cracks(found);
}

TEST_F(FaultTable, a_missed_peak_before_the_sky_moves_the_silhouette) {
    const Heights peak = [](int row, int column) {
        return std::abs(row - kMiddle) <= 3 && column == 60 ? 60.0 : 0.0;
    };
    const auto terrain = terrain_of(peak);
    const Camera camera = from_west(100, 20);
    const TruthSummary found = truth(*terrain, grid(kFlat), camera);
    // The peak's top stands 40 m over the eye, the plane's last samples 20 m under it at depth 740.
    const double rows = camera.lambda() * (40.0 / 700 + 20.0 / 740);
    EXPECT_NEAR(found.silhouette_max, rows, 1.001);  // both rows are whole
    EXPECT_GT(found.silhouette_pixels, 100U);
    EXPECT_NEAR(*found.screen.max, 60 * camera.lambda() / 700, kExact);
    EXPECT_GT(*found.pixel.max, 10);
    expect_all_covered(found);
    expect_no_cracks(found);
    // Above the plane's horizon the peak is all that differs.
    expect_exact(truth(*terrain, grid(peak), camera));
}

TEST_F(FaultTable, a_hole_of_one_sample_is_uncovered_and_no_crack) {
    const auto terrain = terrain_of(kHills);
    Mesh mesh;
    for (int row = 0; row < kSide - 1; ++row) {
        for (int column = 0; column < kSide - 1; ++column) {
            const bool hole = row >= 31 && row < 33 && column >= 9 && column < 11;
            if (!hole) add_grid(mesh, kHills, 1, row, column, row + 1, column + 1);
        }
    }
    const TruthSummary found = truth(*terrain, mesh, from_west(0, 120, 60, -30));
    EXPECT_EQ(found.screen.uncovered, 1U);
    EXPECT_EQ(*found.screen.max, kInfinity);
    EXPECT_EQ(found.screen_worst->row, 32);
    EXPECT_EQ(found.screen_worst->column, 10);
    EXPECT_LE(*found.screen.max_covered, kExact);
    EXPECT_GT(found.pixel.uncovered, 10U);
    expect_no_cracks(found);
}

TEST_F(FaultTable, a_missing_block_is_uncovered_and_no_crack) {
    const auto terrain = terrain_of(kHills);
    Mesh mesh;
    for (int row = 0; row < 64; row += 16) {
        for (int column = 0; column < 64; column += 16) {
            if (row != 16 || column != 16) {
                add_grid(mesh, kHills, 1, row, column, row + 16, column + 16);
            }
        }
    }
    // From above all of the block is in view; its border is covered by its neighbours.
    const TruthSummary found = truth(*terrain, mesh, from_west(-320, 900, 60, -89));
    EXPECT_EQ(found.screen.uncovered, 15U * 15U);
    EXPECT_EQ(*found.screen.p99, kInfinity);
    EXPECT_GT(found.pixel.uncovered, 100U);
    expect_no_cracks(found);
    expect_no_cracks(truth(*terrain, mesh, from_west(60, 60)));
}

TEST_F(FaultTable, a_vertex_that_is_no_number_leaves_its_triangles_out) {
    const auto terrain = terrain_of(kHills);
    const Heights broken = [](int row, int column) {
        return row == 32 && column == 10 ? std::nan("") : kHills(row, column);
    };
    const TruthSummary found = truth(*terrain, grid(broken), from_west(0, 120, 60, -30));
    EXPECT_EQ(found.screen.uncovered, 1U);
    EXPECT_LE(*found.screen.max_covered, kExact);
    expect_no_cracks(found);
}

TEST_F(FaultTable, a_gap_at_a_t_junction_is_a_crack_of_known_size_and_no_screen_error) {
    // The coarse side spans the whole seam: its triangles pass below the raised vertex.
    Mesh mesh;
    constexpr double kGap = 12;
    const Heights raised = [](int row, int column) {
        return row == kMiddle && column == kMiddle ? kGap : 0.0;
    };
    mesh.quad(point(0, 0, 0), point(64, 0, 0), point(64, kMiddle, 0), point(0, kMiddle, 0));
    for (int row = 0; row < 64; row += 32) {
        mesh.quad(point(row, kMiddle, raised(row, kMiddle)),
                  point(row + 32, kMiddle, raised(row + 32, kMiddle)), point(row + 32, 64, 0),
                  point(row, 64, 0));
    }
    // The truth is what is drawn, seen from above: at every sample the higher side.
    const Heights truth_heights = [](int row, int column) {
        if (column < kMiddle) return 0.0;
        // The two quads are cut from their first to their third corner.
        const double u = double(column - kMiddle) / 32;       // 0 at the seam, 1 at the east
        const double v = 1 - std::abs(row - kMiddle) / 32.0;  // 1 at the raised vertex
        if (row >= kMiddle) {
            // (row 32, seam) is the first corner, (row 64, east) the third: height falls along both
            // sides.
            return kGap * std::max(0.0, std::min(v, 1 - u));
        }
        // (row 0, seam), (row 32, seam) raised, (row 32, east), (row 0, east).
        return kGap * std::max(0.0, v - u);
    };
    const auto terrain = terrain_of(truth_heights);
    const Camera camera = from_west(-120, 30, 60, -5);
    const TruthSummary found = truth(*terrain, mesh, camera);
    EXPECT_LE(*found.screen.max, kExact);
    expect_all_covered(found);
    EXPECT_EQ(found.skirt_total, 0U);
    // Pixels whose centre lies in the gap's triangle, without and with the slack around it.
    const glm::dvec2 a = *camera.project(point(0, kMiddle, 0));
    const glm::dvec2 b = *camera.project(point(64, kMiddle, 0));
    const glm::dvec2 top = *camera.project(point(kMiddle, kMiddle, kGap));
    const auto pixels_within = [&](double slack) {
        const auto side = [&](glm::dvec2 from, glm::dvec2 to, glm::dvec2 p) {
            const glm::dvec2 along = glm::normalize(to - from);
            return along.x * (p.y - from.y) - along.y * (p.x - from.x);
        };
        const double turn = side(a, b, top) > 0 ? 1 : -1;
        std::uint64_t count = 0;
        for (int y = 0; y < camera.viewport.height; ++y) {
            for (int x = 0; x < camera.viewport.width; ++x) {
                const glm::dvec2 p(x + 0.5, y + 0.5);
                if (turn * side(a, b, p) > -slack && turn * side(b, top, p) > -slack &&
                    turn * side(top, a, p) > -slack) {
                    ++count;
                }
            }
        }
        return count;
    };
    EXPECT_GE(found.crack_total, pixels_within(-2 * kSlackPx));
    EXPECT_LE(found.crack_total, pixels_within(0));
    EXPECT_GT(found.crack_total, 500U);

    // A skirt under the raised edge closes the gap: it is in the picture, and in no error.
    Mesh closed = mesh;
    for (int row = 0; row < 64; row += 32) {
        closed.quad(point(row, kMiddle, raised(row, kMiddle)),
                    point(row + 32, kMiddle, raised(row + 32, kMiddle)),
                    point(row + 32, kMiddle, -20), point(row, kMiddle, -20));
    }
    const TruthSummary with_skirt = truth(*terrain, closed, camera);
    EXPECT_EQ(with_skirt.crack_total, 0U);
    EXPECT_NEAR(double(with_skirt.skirt_total), double(found.crack_total),
                0.05 * double(found.crack_total) + 20);
    EXPECT_LE(*with_skirt.screen.max, kExact);
    EXPECT_EQ(with_skirt.screen.count, found.screen.count);
    expect_all_covered(with_skirt);
}

TEST_F(FaultTable, lod_error_makes_no_crack) {
    const auto terrain = terrain_of(kHills);
    for (const int step : {2, 4, 8, 16, 64}) {
        for (const Camera& camera : {from_west(100, 60), from_west(-100, 45, 90, -20)}) {
            const TruthSummary found = truth(*terrain, grid(kHills, step), camera);
            EXPECT_GT(*found.screen.max, 1) << step;
            expect_all_covered(found);
            SCOPED_TRACE(step);
            expect_no_cracks(found);
        }
    }
}

TEST_F(FaultTable, skirts_below_the_surface_change_nothing) {
    const auto terrain = terrain_of(kHills);
    Mesh mesh = grid(kHills);
    const auto hang = [&](int r0, int c0, int r1, int c1) {
        mesh.quad(point(r0, c0, kHills(r0, c0)), point(r1, c1, kHills(r1, c1)),
                  point(r1, c1, kHills(r1, c1) - 50), point(r0, c0, kHills(r0, c0) - 50));
    };
    for (int i = 0; i < kSide - 1; ++i) {
        for (const int line : {0, 16, 32, 64}) {
            hang(line, i, line, i + 1);
            hang(i, line, i + 1, line);
        }
    }
    const TruthSummary inside = truth(*terrain, mesh, from_west(-100, 120, 60, -30));
    expect_exact(inside);
    // From outside the skirt at the border is seen, below what is true.
    const TruthSummary outside = truth(*terrain, mesh, from_west(300, 60));
    EXPECT_GT(outside.skirt_total, 100U);
    EXPECT_EQ(outside.crack_total, 0U);
    EXPECT_LE(*outside.screen.max, kExact);
    // Within the slack of its upper edge a skirt is not told from the surface.
    EXPECT_LE(*outside.pixel.max, kSlackPx);
}

TEST_F(FaultTable, a_fence_above_the_surface_shows_in_the_pixels_and_in_no_sample) {
    const auto terrain = terrain_of(kFlat);
    constexpr int kColumn = 20;
    constexpr double kTall = 30;
    Mesh mesh = grid(kFlat);
    mesh.quad(point(24, kColumn, 0), point(40, kColumn, 0), point(40, kColumn, kTall),
              point(24, kColumn, kTall));
    for (const Camera& camera : {from_west(100, 20), from_west(100, 200, 60, -30)}) {
        const TruthSummary found = truth(*terrain, mesh, camera);
        EXPECT_EQ(found.walls, 2U);
        // Its top, drawn where the truth is flat ground.
        const double tall = glm::distance(*camera.project(point(kMiddle, kColumn, kTall)),
                                          *camera.project(point(kMiddle, kColumn, 0)));
        EXPECT_NEAR(*found.pixel.max, tall, 1.001);
        EXPECT_LE(*found.screen.max, kExact);
        // From below its top it stands before the sky.
        const bool before_sky = camera.position.z < kTall;
        EXPECT_EQ(found.silhouette_pixels > 100, before_sky);
        expect_all_covered(found);
        expect_no_cracks(found);
    }
}

TEST_F(FaultTable, a_rasteriser_that_drops_triangles_shows_in_the_picture_alone) {
    const auto terrain = terrain_of(kHills);
    const Mesh mesh = grid(kHills);
    Mesh dropped = mesh;
    const std::size_t kept = mesh.corners.size() / 2 / 3 * 3;
    dropped.corners.resize(kept);  // the southern half is not drawn
    const TruthSummary found = truth(*terrain, mesh, from_west(0, 100, 60, -20), &dropped);
    EXPECT_LE(*found.screen.max, kExact);
    EXPECT_GT(found.crack_total, 1000U);
    EXPECT_GT(found.silhouette_pixels, 100U);
    expect_all_covered(found);
}

TEST_F(FaultTable, popping_is_what_moved_between_two_frames_and_never_the_camera) {
    const auto terrain = terrain_of(kFlat);
    const Mesh low = grid(kFlat);
    const Mesh high = grid([](int, int) { return 1.0; });
    const Camera first = from_west(100, 20);
    const Camera second = from_west(90, 21, 60, -1);
    const std::vector<std::uint8_t> grey(std::size_t{3} * 320 * 240, 128);
    const auto popping = [&](const Mesh& before, const Mesh& after) {
        TruthMeter meter(terrain->samples(), terrain->info(), std::nullopt);
        FrameTruth row;
        meter.take(7, first, captured(before, first), nullptr);
        row = meter.measure(depth_of(before, *terrain, first), grey, grey);
        meter.take(8, second, captured(after, second), &row);
        const TruthSummary summary = meter.summary();
        EXPECT_EQ(row.popping_max_px, summary.popping->max);
        return summary;
    };
    const TruthSummary still = popping(high, high);
    EXPECT_LE(*still.popping->max, kExact);
    EXPECT_EQ(still.popping_over_1px, 0U);
    EXPECT_LE(*still.height_rmse_change, 1e-4);

    const TruthSummary moved = popping(low, high);
    EXPECT_NEAR(*moved.popping->max,
                expected_max(
                    kFlat, [](int, int) { return 1.0; }, second),
                kExact);
    EXPECT_GT(moved.popping_over_1px, 100U);
    EXPECT_EQ(moved.popping_covered_once, 0U);
    EXPECT_NEAR(*moved.height_rmse_change, 1, 1e-4);
}

TEST_F(FaultTable, a_rasteriser_that_draws_another_surface_shows_in_the_pixel_error) {
    // What was sent is exact; what reaches the picture goes through each second sample.
    const auto terrain = terrain_of(kHills);
    const Mesh mesh = grid(kHills);
    const Mesh coarse = grid(kHills, 2);
    const Camera camera = from_west(0, 100, 60, -20);
    const TruthSummary found = truth(*terrain, mesh, camera, &coarse);
    EXPECT_LE(*found.screen.max, kExact);
    const double coarse_error = *truth(*terrain, coarse, camera).pixel.p99;
    EXPECT_GT(coarse_error, 1);
    EXPECT_GT(*found.pixel.p99, 0.5 * coarse_error);
}

TEST_F(FaultTable, honesty_is_the_greatest_error_over_the_claim_and_tau_counts_what_is_over_it) {
    const auto terrain = terrain_of(kFlat);
    const Camera camera = from_west(100, 20);
    const Mesh raised = grid([](int, int) { return 1.0; });
    const double greatest = camera.lambda() / 100;
    const TruthSummary kept = truth(*terrain, raised, camera, nullptr, 2 * greatest);
    EXPECT_NEAR(*kept.bound_honesty, 0.5, kExact);
    EXPECT_EQ(*kept.screen.over_tau, 0.0);
    const TruthSummary broken = truth(*terrain, raised, camera, nullptr, 0.25 * greatest);
    EXPECT_NEAR(*broken.bound_honesty, 4, 4 * kExact);
    EXPECT_GT(*broken.screen.over_tau, 0.1);
    EXPECT_LT(*broken.screen.over_tau, 1.0);
    EXPECT_FALSE(truth(*terrain, raised, camera).bound_honesty.has_value());
}

}  // namespace
}  // namespace lodbench::measure
