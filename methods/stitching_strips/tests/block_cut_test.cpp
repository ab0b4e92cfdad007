// Numbers of blocks, table 1, the metric and the factors.

#include "stitching_strips/block_cut.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/method_fixture.h"

namespace lodbench::stitching_strips {
namespace {

TEST(Neighbours, are_those_of_the_papers_examples) {
    // Section 3.2.1: B_1 has {null, null, 1, 0}, its child B_11 {11, 10, 1, 0}, and its child B_49
    // {11, 10, 49, 48}.
    const Neighbours none = {kNoStrip, kNoStrip, kNoStrip, kNoStrip};
    const Neighbours first = child_neighbours(kRoot, none, 1);
    EXPECT_EQ(first, (Neighbours{kNoStrip, kNoStrip, 1, 0}));
    ASSERT_EQ(first_child(1) + 3, 11);
    const Neighbours second = child_neighbours(1, first, 3);
    EXPECT_EQ(second, (Neighbours{11, 10, 1, 0}));
    ASSERT_EQ(first_child(11) + 1, 49);
    EXPECT_EQ(child_neighbours(11, second, 1), (Neighbours{11, 10, 49, 48}));
    for (const int child : {0, 3, 11, 48, 51}) EXPECT_EQ(first_child(parent(child)), child / 4 * 4);
}

TEST(TessellationFactor, is_where_the_threshold_lies_between_two_errors) {
    BlockErrors errors{};
    for (int i = 0; i < kErrorCount; ++i) errors[std::size_t(i)] = float(kErrorCount - 1 - i);
    // The error is 32 - F / 2.
    EXPECT_EQ(tessellation_factor(errors, 31), 2) << "none is too large";
    EXPECT_EQ(tessellation_factor(errors, 30.5), 3);
    EXPECT_EQ(tessellation_factor(errors, 10), 44);
    EXPECT_EQ(tessellation_factor(errors, 9.75), 44.5F);
    EXPECT_EQ(tessellation_factor(errors, 0), 64);
    EXPECT_EQ(tessellation_factor(errors, -1), 64) << "the finest is too coarse";
}

TEST(TessellationFactor, is_searched_from_the_finest_since_errors_do_not_always_fall) {
    BlockErrors errors{};
    errors[0] = 9;
    errors[1] = 1;  // factor 4 would do
    errors[2] = 5;  // factor 6 would not
    errors[3] = 1;
    EXPECT_EQ(tessellation_factor(errors, 3), 7);
}

Block block_at(const glm::dvec3& centre, double half) {
    Block block;
    block.centre = centre;
    block.box = {centre - half, centre + half};
    return block;
}
/// Camera of which lambda is 1000.
Camera camera_from(const glm::dvec3& position) {
    Camera camera;
    camera.position = position;
    camera.viewport = {2000, 2000};
    camera.vertical_fov = std::acos(-1) / 2;
    return camera;
}

TEST(BlockMetric, is_equation_3) {
    const Block block = block_at({0, 0, 0}, 1);
    const BlockMetric metric({.tau = 2}, camera_from({30, 0, 40}));
    // d = 50, sin(theta) = 0.6: rho = 1000 * delta / 50 * 0.6 = 12 delta.
    EXPECT_NEAR(metric.allowed_error(block), 2.0 / 12, 1e-12);
    const BlockMetric plain({.tau = 2, .view_angle = false}, camera_from({30, 0, 40}));
    EXPECT_NEAR(plain.allowed_error(block), 2.0 / 20, 1e-12);
    const BlockMetric to_box({.tau = 2, .view_angle = false, .distance = Distance::box},
                             camera_from({31, 0, 1}));
    EXPECT_NEAR(to_box.allowed_error(block), 2.0 / 1000 * 30, 1e-12);
}

TEST(BlockMetric, splits_and_keeps_the_two_blocks_of_figure_13) {
    // (d, theta) = (725.17, 73.87 degrees) is split, (625.24, 35.46 degrees) kept though nearer: at
    // an error between the two that each allows. Without the angle the nearer one would be split
    // first.
    const auto allowed = [](double distance, double degrees, bool view_angle) {
        const double angle = degrees * std::acos(-1) / 180;
        const Camera camera =
            camera_from({distance * std::sin(angle), 0, distance * std::cos(angle)});
        return BlockMetric({.view_angle = view_angle}, camera)
            .allowed_error(block_at({0, 0, 0}, 32));
    };
    const double split = allowed(725.17, 73.87, true), kept = allowed(625.24, 35.46, true);
    EXPECT_LT(split, kept);
    EXPECT_NEAR(kept / split, 1.428, 5e-4);
    EXPECT_GT(allowed(725.17, 73.87, false), allowed(625.24, 35.46, false));
}

TEST(BlockMetric, from_straight_above_allows_no_more_than_at_the_border_unless_asked) {
    const Block block = block_at({0, 0, 0}, 10);
    const BlockMetric guarded({}, camera_from({0, 0, 100}));
    EXPECT_NEAR(guarded.allowed_error(block), 100.0 / (1000 * 0.1), 1e-12);
    const BlockMetric printed({.straight_down = StraightDown::zero}, camera_from({0, 0, 100}));
    EXPECT_EQ(printed.allowed_error(block), std::numeric_limits<double>::infinity());
    const BlockMetric inside({}, camera_from({0, 0, 0}));
    EXPECT_LT(inside.allowed_error(block), 0) << "no error is small enough";
}

class Cut : public testing::Test {
protected:
    std::shared_ptr<const terrain::HeightField> terrain_ = test::hills(400, 300);
    GroundHeights ground_{*terrain_};
    BlockTree tree_{*terrain_, ground_, 1, ErrorKind::average};
    BlockCut cut_{tree_};
    Camera low_ = test::camera_at({512600, -2900, 250}, 40, -35),
           high_ = test::camera_at({512600, -2900, 2e7}, 40, -35);
};

TEST_F(Cut, has_every_block_once_and_counts_what_changes) {
    cut_.update(BlockMetric({.tau = 0.05}, low_));
    ASSERT_GE(cut_.splits().size(), 4U);
    EXPECT_EQ(cut_.leaves().size(), 3 * cut_.splits().size() + 1);
    const int splits = int(cut_.splits().size());
    EXPECT_EQ(cut_.changed(), splits);
    for (std::size_t i = 0; i < cut_.leaves().size(); ++i) {
        const int block = cut_.leaves()[i].block;
        EXPECT_FALSE(cut_.is_split(block));
        EXPECT_EQ(cut_.leaf(block), int(i));
        EXPECT_TRUE(block == kRoot || cut_.is_split(parent(block)));
        EXPECT_GE(cut_.leaves()[i].factor, 2);
        EXPECT_LE(cut_.leaves()[i].factor, 64);
    }
    cut_.update(BlockMetric({.tau = 0.05}, low_));
    EXPECT_EQ(cut_.changed(), 0);
    cut_.update(BlockMetric({.tau = 1000}, high_));
    EXPECT_EQ(cut_.leaves().size(), 1U);
    EXPECT_EQ(cut_.leaves()[0].factor, 2);
    EXPECT_EQ(cut_.changed(), splits);
}

}  // namespace
}  // namespace lodbench::stitching_strips
