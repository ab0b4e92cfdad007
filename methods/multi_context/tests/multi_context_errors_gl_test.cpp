// The errors texture and the blocks' maxima, as the GPU makes them, against equations (1) to (4) in
// double.

#include <gtest/gtest.h>

#include <random>

#include "multi_context/errors_pass.h"
#include "multi_context_reference.h"
#include "support/context_for_test.h"
#include "support/method_fixture.h"

namespace lodbench::test {
namespace {

using multi_context::BlockErrors;
using multi_context::ErrorsPass;
using multi_context::ErrorsSettings;
using multi_context::kUnbounded;
using multi_context::Layout;
using multi_context::ReadBack;

std::shared_ptr<const terrain::HeightField> rough(int rows, int columns, unsigned seed) {
    TerrainInfo info;
    info.name = "rough";
    info.rows = rows;
    info.columns = columns;
    info.spacing = {30, 22.5};
    info.origin = {-512345.5, 4000321.25};
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> height(-150, 900);
    std::vector<float> heights(std::size_t(rows) * std::size_t(columns));
    for (float& h : heights) h = height(random);
    return std::make_shared<terrain::HeightField>(info, std::move(heights));
}

class Errors {
public:
    Errors(GlTest& gl, const Terrain& terrain, const ErrorsSettings& settings)
        : gl_(gl),
          heights_(make_heights(terrain)),
          pass_(gl_.device, heights_, terrain.info(), settings) {}
    BlockErrors run(const Camera& camera) {
        BlockErrors errors;
        pass_.run(camera, errors);
        EXPECT_TRUE(gl_.device.take_errors().empty());
        return errors;
    }
    [[nodiscard]] std::vector<float> texture() const { return pass_.read_texture(); }
    [[nodiscard]] ErrorsPass& pass() { return pass_; }

private:
    gl::Texture make_heights(const Terrain& terrain) {
        const TerrainInfo& info = terrain.info();
        std::vector<float> heights(std::size_t(info.rows) * std::size_t(info.columns));
        terrain.read({0, 0, info.rows, info.columns}, heights);
        gl::Texture texture(gl_.device, "heights", GL_TEXTURE_2D, GL_R32F, info.columns, info.rows);
        texture.write(0, 0, 0, info.columns, info.rows, GL_RED, GL_FLOAT, heights.data());
        return texture;
    }
    GlTest& gl_;
    gl::Texture heights_;
    ErrorsPass pass_;
};

Camera random_camera(const TerrainInfo& info, std::mt19937& random) {
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    const glm::dvec2 at = info.origin + size * glm::dvec2(between(-0.3, 1.3), between(-0.3, 1.3));
    const double height =
        info.min_height + (info.max_height - info.min_height) * std::exp(between(-2.0, 2.5));
    Camera camera = camera_at({at, height}, between(0, 360), between(-90, 40), between(-180, 180),
                              between(20, 110));
    camera.viewport = {int(between(100, 2000)), int(between(100, 1200))};
    camera.near_plane = std::exp(between(-1.0, 4.0));
    return camera;
}

struct Tally {
    std::size_t groups = 0, positive = 0, unbounded = 0, tight = 0;
};

/// Every group of every level between its bounds, every other texel zero.
void compare(const Terrain& terrain, const ErrorsPass& pass, const std::vector<float>& texture,
             const Camera& camera, Tally& tally) {
    const Layout& layout = pass.layout();
    const ReferenceErrors reference(terrain, layout, camera);
    std::vector<float> rest = texture;
    for (int level = 1; level <= layout.n(); ++level) {
        for (int row = 0; row < layout.groups_along(level); ++row) {
            for (int column = 0; column < layout.groups_along(level); ++column) {
                const std::size_t texel =
                    std::size_t(Layout::group_centre(level, row)) * std::size_t(layout.samples()) +
                    std::size_t(Layout::group_centre(level, column));
                const double found = double(texture[texel]);
                rest[texel] = 0;
                const Bounds bounds = reference.group(level, row, column);
                ASSERT_GE(found, bounds.low) << "level " << level << ", " << row << ", " << column;
                // Once more rounded when it is stored.
                ASSERT_LE(found, bounds.high * (1 + 1e-7))
                    << "level " << level << ", " << row << ", " << column;
                ++tally.groups;
                tally.positive += found > 0;
                tally.unbounded += found >= double(kUnbounded);
                tally.tight += bounds.high - bounds.low <= 1e-4 * bounds.high + 1e-9;
            }
        }
    }
    ASSERT_EQ(std::count(rest.begin(), rest.end(), 0.0F), std::ptrdiff_t(rest.size()))
        << "a texel that is no group's centre";
}

// w = 0 at the sample on which the eye stands, and at all in the plane through it; the near plane
// as near as a scenario may have it, so that hardly anything else hides behind it.
TEST(MultiContextErrors, have_a_value_where_w_is_zero) {
    const auto terrain = rough(65, 65, 3);
    const TerrainInfo& info = terrain->info();
    GlTest gl;
    Errors errors(gl, *terrain, {.k = 17});
    Tally tally;
    for (const glm::dvec3& direction : {glm::dvec3(0, 1, 0), {0, 0, -1}, {0, 0, 1}, {1, 1, -0.5}}) {
        float height = 0;
        terrain->read({32, 31, 1, 1}, {&height, 1});
        Camera camera;
        camera.position = {info.position(32, 31), height};
        camera.orientation = Camera::look(direction);
        camera.near_plane = 1e-3;
        (void)errors.run(camera);
        compare(*terrain, errors.pass(), errors.texture(), camera, tally);
        if (HasFatalFailure()) FAIL() << "looking along " << direction.x << ", " << direction.y;
    }
    EXPECT_GT(tally.unbounded, 0U);
    EXPECT_GT(tally.positive, tally.unbounded);
}

TEST(MultiContextErrors, equal_double_precision_at_every_level_on_random_terrain) {
    std::mt19937 random(1);
    Tally tally;
    for (const auto& [rows, columns] :
         {std::pair(65, 65), std::pair(129, 129), std::pair(70, 111)}) {
        const auto terrain = rough(rows, columns, unsigned(rows));
        GlTest gl;
        Errors errors(gl, *terrain, {.k = 17});
        for (int i = 0; i < 40; ++i) {
            const Camera camera = random_camera(terrain->info(), random);
            (void)errors.run(camera);
            compare(*terrain, errors.pass(), errors.texture(), camera, tally);
            if (HasFatalFailure()) FAIL() << rows << " x " << columns << ", camera " << i;
        }
    }
    // Not for want of anything to compare.
    EXPECT_GT(tally.tight, tally.groups * 8 / 10);
    EXPECT_GT(tally.unbounded, tally.groups / 10);
    EXPECT_GT(tally.positive - tally.unbounded, tally.groups / 10);
}

#ifdef LODBENCH_WITH_OIIO
TEST(MultiContextErrors, equal_double_precision_at_every_level_on_puget_sound) {
    const auto terrain = puget_sound();
    GlTest gl;
    Errors errors(gl, *terrain, {.k = 33});
    std::mt19937 random(2);
    Tally tally;
    for (int i = 0; i < 8; ++i) {
        const Camera camera = random_camera(terrain->info(), random);
        (void)errors.run(camera);
        compare(*terrain, errors.pass(), errors.texture(), camera, tally);
        if (HasFatalFailure()) FAIL() << "camera " << i;
    }
    EXPECT_GT(tally.tight, tally.groups * 8 / 10);
    EXPECT_GT(tally.positive - tally.unbounded, tally.groups / 10);
}
#endif

TEST(MultiContextErrors, are_zero_on_flat_ground_wherever_it_lies) {
    const auto terrain = flat(65, 65, 123);
    GlTest gl;
    Errors errors(gl, *terrain, {.k = 17});
    (void)errors.run(camera_at({300, 300, 200}, 30, -10));
    for (const float error : errors.texture()) ASSERT_EQ(error, 0);
}

// Closed form: one sample of 1 m seen from the side, at right angles, d metres away.
TEST(MultiContextErrors, of_a_single_bump_is_lambda_over_distance) {
    TerrainInfo info;
    info.name = "bump";
    info.rows = 17;
    info.columns = 17;
    info.spacing = {10, 10};
    std::vector<float> heights(17 * 17, 0.0F);
    heights[8 * 17 + 3] = 1;  // dropped when groups of level 1 are made: 3 is odd
    const terrain::HeightField terrain(info, std::move(heights));
    GlTest gl;
    Errors errors(gl, terrain, {.k = 17});
    Camera camera = camera_at({30, -500, 0.5}, 0, 0);
    (void)errors.run(camera);
    const auto texture = errors.texture();
    // In row 8 the bump is vertex b of the group to the south and h of the one to the north.
    const double expected = camera.lambda() / (500 + 80);
    for (const auto& [row, column] :
         {std::pair(7, 3), std::pair(9, 3), std::pair(6, 2), std::pair(10, 2), std::pair(4, 4),
          std::pair(12, 4), std::pair(8, 8)}) {
        EXPECT_NEAR(texture[std::size_t(row * 17 + column)], expected, 1e-6 * expected)
            << row << ", " << column;
    }
    EXPECT_EQ(std::count_if(texture.begin(), texture.end(), [](float e) { return e > 0; }), 7);
}

TEST(MultiContextErrors, of_blocks_are_the_same_from_the_gpus_maxima_and_from_the_whole_texture) {
    std::mt19937 random(5);
    for (const int k : {2, 3, 17, 33, 65}) {
        for (const bool bytes : {false, true}) {
            const auto terrain = rough(150, 129, 9);
            GlTest gl;
            // In one part and in several, of which some may be empty.
            const int parts = k == 17 ? 1 : 5;
            Errors blocks(gl, *terrain, {.k = k, .delta = 40, .bytes = bytes, .parts = parts});
            Errors whole(gl, *terrain,
                         {.k = k,
                          .delta = 40,
                          .bytes = bytes,
                          .read_back = ReadBack::whole,
                          .parts = parts});
            const Layout& layout = blocks.pass().layout();
            for (int i = 0; i < 5; ++i) {
                const Camera camera = random_camera(terrain->info(), random);
                const BlockErrors a = blocks.run(camera);
                const BlockErrors b = whole.run(camera);
                EXPECT_EQ(a.read_back_bytes, layout.count() * 4);
                EXPECT_EQ(b.read_back_bytes, std::size_t(layout.samples()) *
                                                 std::size_t(layout.samples()) * (bytes ? 1U : 4U));
                const ReferenceErrors reference(*terrain, layout, camera);
                for (int lod = 1; lod <= layout.coarsest(); ++lod) {
                    for (int row = 0; row < layout.blocks_along(lod); ++row) {
                        for (int column = 0; column < layout.blocks_along(lod); ++column) {
                            ASSERT_EQ(a.at(lod, row, column), b.at(lod, row, column))
                                << "k " << k << ", LOD " << lod << ", " << row << ", " << column;
                            const Bounds bounds = reference.block(lod, row, column);
                            ASSERT_GE(double(a.at(lod, row, column)), bounds.low);
                            if (!bytes) {
                                ASSERT_LE(double(a.at(lod, row, column)), bounds.high * (1 + 1e-7));
                            }
                        }
                    }
                }
            }
        }
    }
}

TEST(MultiContextErrors, of_a_tree_are_those_of_all_blocks_as_far_as_it_is_split_and_no_more) {
    std::mt19937 random(8);
    const auto terrain = hills(257, 200);
    for (const bool bytes : {false, true}) {
        GlTest gl;
        const float delta = 6;
        Errors all(gl, *terrain, {.k = 9, .delta = delta, .bytes = bytes});
        Errors tree(gl, *terrain,
                    {.k = 9, .delta = delta, .bytes = bytes, .read_back = ReadBack::tree});
        const Layout& layout = all.pass().layout();
        std::size_t fetched = 0, left_out = 0;
        for (int i = 0; i < 12; ++i) {
            const Camera camera = random_camera(terrain->info(), random);
            const BlockErrors expected = all.run(camera);
            const BlockErrors found = tree.run(camera);
            std::size_t blocks = 0;
            for (int lod = 1; lod <= layout.coarsest(); ++lod) {
                for (int row = 0; row < layout.blocks_along(lod); ++row) {
                    for (int column = 0; column < layout.blocks_along(lod); ++column) {
                        const bool split = lod == layout.coarsest() ||
                                           expected.at(lod + 1, row / 2, column / 2) > delta;
                        ASSERT_EQ(found.at(lod, row, column), split ? expected.at(lod, row, column)
                                                                    : multi_context::kUnbounded);
                        ++(split ? fetched : left_out);
                        blocks += split;
                    }
                }
            }
            EXPECT_EQ(found.read_back_bytes, 4 * blocks);
        }
        EXPECT_GT(fetched, 100U);
        EXPECT_GT(left_out, 100U);
    }
}

TEST(MultiContextErrors, come_back_in_as_many_parts_as_asked_for) {
    const auto terrain = rough(65, 65, 4);
    for (const ReadBack read_back : {ReadBack::whole, ReadBack::blocks}) {
        GlTest gl;
        Errors errors(gl, *terrain, {.k = 3, .read_back = read_back, .parts = 4});
        int between = 0;
        BlockErrors found;
        errors.pass().run(camera_at({0, 0, 2000}, 30, -10), found, [&] { ++between; });
        EXPECT_EQ(between, 3);
    }
}

TEST(MultiContextErrors, in_bytes_are_the_codes_of_those_in_floats) {
    const auto terrain = hills(129, 129);
    std::mt19937 random(6);
    for (const float delta : {0.37F, 1.0F, 20.0F}) {
        GlTest gl;
        Errors floats(gl, *terrain, {.k = 17, .delta = delta});
        Errors bytes(gl, *terrain, {.k = 17, .delta = delta, .bytes = true});
        std::size_t between = 0;
        for (int i = 0; i < 10; ++i) {
            const Camera camera = random_camera(terrain->info(), random);
            (void)floats.run(camera);
            (void)bytes.run(camera);
            const auto exact = floats.texture();
            const auto coded = bytes.texture();
            for (std::size_t texel = 0; texel < exact.size(); ++texel) {
                const int code = encode_error(exact[texel], delta);
                // GLSL's division may be off by 2.5 steps, so that one code more is possible.
                const int most = std::min(code + 1, multi_context::kUnboundedCode);
                ASSERT_GE(coded[texel], multi_context::decode_error(std::uint8_t(code), delta));
                ASSERT_LE(coded[texel], multi_context::decode_error(std::uint8_t(most), delta));
                between += code > 0 && code < multi_context::kUnboundedCode;
            }
        }
        EXPECT_GT(between, 100U) << delta;
    }
}

TEST(MultiContextErrors, of_a_terrain_of_one_block_need_no_read_back) {
    const auto terrain = rough(17, 9, 4);
    GlTest gl;
    Errors errors(gl, *terrain, {.k = 33});
    EXPECT_EQ(errors.pass().layout().coarsest(), 0);
    EXPECT_EQ(errors.run(camera_at({0, 0, 2000}, 30, -10)).read_back_bytes, 0U);
}

}  // namespace
}  // namespace lodbench::test
