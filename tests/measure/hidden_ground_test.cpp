// What is called hidden is hidden: against the line of sight to every sample.
#include "measure/hidden_ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "measure/pixel_projection.h"
#include "measure/reference_view.h"
#include "reference_oracle.h"

namespace lodbench::measure {
namespace {

using namespace test;

struct Found {
    int seen = 0, unseen = 0, hidden = 0;
};

/// Holds the camera's hidden samples against its lines of sight, as the sample errors ask them.
void hold_against_sight(const Ground& ground, const Camera& camera, Found& found) {
    const ReferenceTerrain terrain = ground.terrain();
    const HiddenGround hidden(terrain, camera);
    const PixelProjection pixels(camera);
    ReferenceView view;
    view.seen = seen_samples(terrain, camera, hidden);
    for (int row = 0; row < ground.info.rows; ++row) {
        for (int column = 0; column < ground.info.columns; ++column) {
            const glm::dvec3 local = pixels.local(terrain.sample(row, column));
            const std::size_t index =
                std::size_t(row) * std::size_t(ground.info.columns) + std::size_t(column);
            if (!pixels.in_view(local)) {
                ASSERT_FALSE(view.sees(index)) << row << ", " << column;
                continue;
            }
            const bool seen =
                terrain.sees(camera.position, camera.near_plane / local.z, row, column);
            ASSERT_EQ(view.sees(index), seen) << row << ", " << column;
            ++(seen ? found.seen : found.unseen);
            if (!hidden.sample(row, column)) continue;
            ++found.hidden;
            ASSERT_FALSE(seen) << ground.info.rows << " x " << ground.info.columns << ", sample "
                               << row << ", " << column;
        }
    }
}

TEST(HiddenGround, hides_no_sample_that_is_seen) {
    base::SplitMix64 random(5);
    Found found;
    for (const Ground& ground : grounds()) {
        const auto [low, high] = std::ranges::minmax(ground.heights);
        const double relief = double(high) - double(low);
        for (int i = 0; i < 300; ++i) {
            const double span = i % 2 == 0 ? 1 : 3;
            Camera camera;
            camera.position = ground.point(
                uniform(random, 0.5 - span / 2, 0.5 + span / 2) * (ground.info.columns - 1),
                uniform(random, 0.5 - span / 2, 0.5 + span / 2) * (ground.info.rows - 1),
                uniform(random, low - 0.2 * relief, high + relief));
            // On a line of samples, on a sample, over the border.
            if (i % 5 == 0) camera.position.x = ground.place(i % ground.info.columns, 0).x;
            if (i % 7 == 0) camera.position.y = ground.place(0, i % ground.info.rows).y;
            if (i % 11 == 0) camera.position.x = ground.info.origin.x;
            camera.orientation = Camera::look(
                {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 0.3)},
                {uniform(random, -1, 1), uniform(random, -1, 1), 1});
            camera.vertical_fov = uniform(random, 0.3, 2.5);
            camera.viewport = {64, 48};
            camera.near_plane = i % 3 == 0 ? 2 : 1e-3;
            ASSERT_NO_FATAL_FAILURE(hold_against_sight(ground, camera, found)) << i;
        }
    }
    EXPECT_GT(found.seen, 20000);
    EXPECT_GT(found.hidden, 20000);
}

TEST(HiddenGround, squares_hold_what_samples_hold) {
    for (const auto& [rows, columns] : {std::pair{150, 200}, {64, 65}, {130, 63}}) {
        const Ground ground = random_ground(rows, columns, 3, 30);
        Camera camera;
        camera.position = ground.point(columns * 0.4, rows * 0.55, 40);
        const HiddenGround hidden(ground.terrain(), camera);
        int count = 0;
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                const HiddenGround::Square square = hidden.square(row / 64, column / 64);
                const bool held =
                    (square[std::size_t(row % 64)] >> unsigned(column % 64) & 1U) != 0;
                ASSERT_EQ(held, hidden.sample(row, column)) << row << ", " << column;
                count += held ? 1 : 0;
            }
        }
        EXPECT_GT(count, rows);
        const HiddenGround::Square last = hidden.square((rows - 1) / 64, (columns - 1) / 64);
        for (int row = 0; row < 64; ++row) {
            const std::uint64_t beyond =
                columns % 64 == 0 ? 0 : ~std::uint64_t{0} << unsigned(columns % 64);
            EXPECT_EQ(last[std::size_t(row)] & beyond, 0U);
        }
    }
}

TEST(HiddenGround, hides_nearly_all_that_is_not_seen_of_hills) {
    const Ground hills = make_ground(
        257, 257,
        [](int row, int column) {
            return 20 * std::sin(row * 0.11) * std::cos(column * 0.07) + 3 * std::sin(row + column);
        },
        {10, 10});
    Found found;
    for (int i = 0; i < 8; ++i) {
        Camera camera;
        camera.position = hills.point(100 + 7.3 * i, 120.4, 60);
        camera.orientation = Camera::look({std::cos(0.8 * i), std::sin(0.8 * i), -0.1});
        ASSERT_NO_FATAL_FAILURE(hold_against_sight(hills, camera, found)) << i;
    }
    EXPECT_GT(found.unseen, found.seen);
    EXPECT_GT(found.hidden, 0.9 * found.unseen);
}

TEST(HiddenGround, a_wall_hides_the_blocks_behind_it) {
    // 100 m high across the terrain at column 100; flat before and behind.
    const Ground wall =
        make_ground(257, 257, [](int, int column) { return column == 100 ? 100 : 0; }, {10, 10});
    const ReferenceTerrain terrain = wall.terrain();
    Camera camera;
    camera.position = wall.point(20, 128, 50);
    camera.orientation = Camera::look({1, 0, 0});
    const HiddenGround hidden(terrain, camera);
    for (int row = 0; row < 64; ++row) {
        for (int column = 0; column < 24; ++column) {
            // Within 37 degrees to each side, before the wall.
            const bool ahead = column > 6 && std::abs(row - 32) < 0.75 * (column - 5);
            if (ahead) {
                EXPECT_FALSE(hidden.block(row, column)) << row << ", " << column;
            }
        }
        for (int column = 26; column < 64; ++column) {
            EXPECT_TRUE(hidden.block(row, column)) << row << ", " << column;
        }
    }
    EXPECT_TRUE(hidden.block(0, 10)) << "out of view";
    // A peak behind it that rises above the line of sight over the wall, at 162 m there.
    Ground peak = wall;
    peak.heights[std::size_t(130) * 257 + 202] = 400;
    const ReferenceTerrain peak_terrain = peak.terrain();
    const HiddenGround behind(peak_terrain, camera);
    EXPECT_FALSE(behind.block(32, 50));
    EXPECT_TRUE(behind.block(32, 48));
    camera.position.z = 0.5;  // the near plane reaches into the ground
    const HiddenGround under(terrain, camera);
    EXPECT_FALSE(under.block(32, 60));
    EXPECT_TRUE(under.sample(128, 240));
    camera.position = wall.point(-10, 128, 50);  // and looks under the border's edge
    const HiddenGround outside(terrain, camera);
    EXPECT_FALSE(outside.block(32, 60));
    EXPECT_TRUE(outside.sample(128, 240));
}

}  // namespace
}  // namespace lodbench::measure
