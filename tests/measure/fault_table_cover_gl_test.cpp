// Fault x metric, of surfaces with something missing or too much: holes, cracks, skirts, walls.

#include <gtest/gtest.h>

#include "fault_table.h"

namespace lodbench::measure {
namespace {

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

}  // namespace
}  // namespace lodbench::measure
