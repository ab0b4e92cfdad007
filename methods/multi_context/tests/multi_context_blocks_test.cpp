// Blocks, their errors and their selection, without GL.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "multi_context/block_mesh.h"
#include "multi_context/block_tree.h"
#include "multi_context_reference.h"
#include "terrain/height_field.h"

namespace lodbench::test {
namespace {

using multi_context::BlockErrors;
using multi_context::HeightRanges;
using multi_context::Layout;
using multi_context::SelectedBlock;
using multi_context::Selection;

std::shared_ptr<const terrain::HeightField> random_heights(int rows, int columns, unsigned seed) {
    TerrainInfo info;
    info.name = "random";
    info.rows = rows;
    info.columns = columns;
    info.spacing = {30, 20};
    info.origin = {100000, -50000};
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> height(0, 300);
    std::vector<float> heights(std::size_t(rows) * std::size_t(columns));
    for (float& h : heights) h = height(random);
    return std::make_shared<terrain::HeightField>(info, std::move(heights));
}

HeightRanges ranges_of(const Terrain& terrain, const Layout& layout) {
    return {terrain, layout, [](const SampleRect&, std::span<const float>) {}};
}

Camera from_above(const TerrainInfo& info) {
    Camera camera;
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    camera.position = {(info.extent_min() + info.extent_max()) / 2.0,
                       info.max_height + 2 * std::max(size.x, size.y)};
    camera.orientation = Camera::look({0, 0, -1});
    return camera;
}

// Figure 6: n = 2, k = 2, delta = 5; the errors quadtree has 9 at its root and 1, 2, 4, 6 below.
TEST(MultiContextBlocks, the_papers_worked_example_draws_three_blocks_of_lod_1_and_four_of_lod_0) {
    const auto terrain = random_heights(5, 5, 1);
    const Layout layout(5, 5, 2);
    ASSERT_EQ(layout.n(), 2);
    ASSERT_EQ(layout.coarsest(), 2);
    BlockErrors errors{layout, 5, std::vector<float>(layout.count()), {}, {}};
    errors.blocks[layout.index(2, 0, 0)] = 9;
    const float children[] = {1, 2, 4, 6};
    for (int i = 0; i < 4; ++i) errors.blocks[layout.index(1, i / 2, i % 2)] = children[i];
    // The same as figure 5a has it: every error at the centre of its group.
    BlockErrors texture{layout, 5, {}, std::vector<float>(25), {}};
    texture.texels[2 * 5 + 2] = 9;
    texture.texels[1 * 5 + 1] = 1;
    texture.texels[1 * 5 + 3] = 2;
    texture.texels[3 * 5 + 1] = 4;
    texture.texels[3 * 5 + 3] = 6;

    const HeightRanges ranges = ranges_of(*terrain, layout);
    const std::vector<SelectedBlock> expected = {{1, 0, 0}, {1, 0, 1}, {1, 1, 0}, {0, 2, 2},
                                                 {0, 2, 3}, {0, 3, 2}, {0, 3, 3}};
    for (const BlockErrors* form : {&errors, &texture}) {
        Selection selection;
        multi_context::Traversal(terrain->info(), layout, ranges, *form, 5,
                                 from_above(terrain->info()))
            .select(selection);
        EXPECT_EQ(selection.blocks, expected);
        EXPECT_EQ(selection.culled, 0U);
    }
}

TEST(MultiContextBlocks, layouts_take_in_the_terrain_and_a_block) {
    EXPECT_EQ(Layout(4097, 4097, 33).n(), 12) << "the paper's";
    EXPECT_EQ(Layout(4097, 4097, 33).coarsest(), 7);
    EXPECT_EQ(Layout(1025, 1025, 33).n(), 10);
    EXPECT_EQ(Layout(1026, 2, 33).n(), 11);
    EXPECT_EQ(Layout(2, 2, 17).n(), 4);
    EXPECT_EQ(Layout(2, 2, 17).coarsest(), 0);
    EXPECT_EQ(Layout(2, 2, 17).count(), 0U);
    EXPECT_EQ(Layout(66, 3, 33).samples(), 129);
    const Layout layout(1025, 1025, 33);
    std::set<std::size_t> places;
    for (int lod = 1; lod <= layout.coarsest(); ++lod) {
        EXPECT_EQ((layout.block_cells() << lod) * layout.blocks_along(lod), 1024);
        EXPECT_EQ(layout.groups_along(lod), layout.blocks_along(lod) * 32)
            << "a group is a cell of the block's mesh";
        for (int row = 0; row < layout.blocks_along(lod); ++row) {
            for (int column = 0; column < layout.blocks_along(lod); ++column) {
                EXPECT_TRUE(places.insert(layout.index(lod, row, column)).second);
            }
        }
    }
    EXPECT_EQ(places.size(), layout.count());
    EXPECT_EQ(*places.rbegin(), layout.count() - 1);
}

TEST(MultiContextBlocks, every_group_has_a_texel_of_its_own) {
    const Layout layout(33, 33, 17);
    std::set<std::pair<int, int>> texels;
    std::size_t groups = 0;
    for (int level = 1; level <= layout.n(); ++level) {
        for (int row = 0; row < layout.groups_along(level); ++row) {
            for (int column = 0; column < layout.groups_along(level); ++column, ++groups) {
                texels.insert(
                    {Layout::group_centre(level, row), Layout::group_centre(level, column)});
            }
        }
    }
    EXPECT_EQ(texels.size(), groups);
    EXPECT_EQ(groups, (1024U - 1) / 3);
    EXPECT_LT(texels.rbegin()->first, layout.samples());
}

TEST(MultiContextBlocks, the_mesh_is_the_papers) {
    const auto mesh = multi_context::make_block_mesh(33, false);
    EXPECT_EQ(mesh.vertices.size(), 33U * 33);
    EXPECT_EQ(mesh.indices.size(), 6U * 32 * 32);
    EXPECT_EQ(mesh.vertices.size() * sizeof(mesh.vertices[0]) +
                  mesh.indices.size() * sizeof(mesh.indices[0]),
              37644U);
    const auto larger = multi_context::make_block_mesh(65, false);
    EXPECT_EQ(larger.vertices.size() * 12 + larger.indices.size() * 4, 149004U)
        << "the paper's example, of another k than its test";
    // Each cell once, and its diagonal from the north-west to the south-east: the edge ai of (1).
    std::map<std::pair<int, int>, double> area;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::vec3 a = mesh.vertices[mesh.indices[i]], b = mesh.vertices[mesh.indices[i + 1]],
                        c = mesh.vertices[mesh.indices[i + 2]];
        const float west = std::min({a.x, b.x, c.x}), north = std::min({a.z, b.z, c.z});
        area[{int(north), int(west)}] +=
            0.5 * double(std::abs((b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x)));
        int diagonal_ends = 0;
        for (const glm::vec3& v : {a, b, c}) {
            diagonal_ends += (v.x == west && v.z == north) || (v.x == west + 1 && v.z == north + 1);
        }
        EXPECT_EQ(diagonal_ends, 2);
    }
    EXPECT_EQ(area.size(), 32U * 32);
    for (const auto& [cell, covered] : area) EXPECT_EQ(covered, 1);
}

TEST(MultiContextBlocks, byte_codes_never_stand_for_less_and_split_no_block_that_passes) {
    std::mt19937 random(3);
    for (const float delta : {0.01F, 0.3F, 1.0F, 1.7F, 5.0F, 1000.0F}) {
        std::uniform_real_distribution<float> within(0, 3 * delta);
        const auto check = [&](float error) {
            const std::uint8_t code = encode_error(error, delta);
            const float decoded = multi_context::decode_error(code, delta);
            ASSERT_GE(decoded, error);
            if (code != multi_context::kUnboundedCode) {
                ASSERT_LE(decoded - error, delta / 128 * 1.0001F)
                    << "rounded up by more than a step";
            } else {
                ASSERT_GT(error, 1.98F * delta);
            }
            ASSERT_EQ(decoded > delta, error > delta) << error << " of " << delta;
        };
        for (int i = 0; i < 100000; ++i) check(within(random));
        for (int code = 0; code < 255; ++code) {
            const float exact = float(code) * (delta / 128);
            check(exact);
            check(std::nextafter(exact, 2 * delta));
            if (code > 0) check(std::nextafter(exact, 0.0F));
        }
        EXPECT_EQ(encode_error(0, delta), 0);
        EXPECT_EQ(encode_error(multi_context::kUnbounded, delta), 255);
    }
}

TEST(MultiContextBlocks, height_ranges_are_those_of_all_samples_of_a_block) {
    for (const auto& [rows, columns] : {std::pair(70, 131), std::pair(65, 65), std::pair(2, 40)}) {
        const auto terrain = random_heights(rows, columns, 5);
        const Layout layout(rows, columns, 17);
        const HeightRanges ranges = ranges_of(*terrain, layout);
        for (int lod = 0; lod <= layout.coarsest(); ++lod) {
            for (int row = 0; row < layout.blocks_along(lod); ++row) {
                for (int column = 0; column < layout.blocks_along(lod); ++column) {
                    const int cells = 16 << lod;
                    const bool exists = row * cells < rows - 1 && column * cells < columns - 1;
                    ASSERT_EQ(ranges.exists(lod, row, column), exists);
                    if (!exists) continue;
                    float low = 1e9F, high = -1e9F;
                    for (int r = row * cells; r <= std::min((row + 1) * cells, rows - 1); ++r) {
                        for (int c = column * cells;
                             c <= std::min((column + 1) * cells, columns - 1); ++c) {
                            float h = 0;
                            terrain->read({r, c, 1, 1}, std::span(&h, 1));
                            low = std::min(low, h);
                            high = std::max(high, h);
                        }
                    }
                    ASSERT_EQ(ranges.at(lod, row, column).low, low);
                    ASSERT_EQ(ranges.at(lod, row, column).high, high);
                }
            }
        }
    }
}

TEST(MultiContextBlocks, the_selection_is_what_a_search_from_below_finds) {
    std::mt19937 random(11);
    const auto unit = [&] { return std::uniform_real_distribution(0.0, 1.0)(random); };
    std::size_t drawn = 0, culled = 0, mixed = 0;
    for (int i = 0; i < 200; ++i) {
        const auto terrain =
            random_heights(129 - int(unit() * 60), 129 - int(unit() * 60), 17U + unsigned(i));
        const TerrainInfo& info = terrain->info();
        const Layout layout(info.rows, info.columns, 17);
        const HeightRanges ranges = ranges_of(*terrain, layout);
        BlockErrors errors{layout, 1, std::vector<float>(layout.count()), {}, {}};
        for (float& error : errors.blocks) error = float(3 * unit() * unit());
        // As (4) makes them: no child has more than its parent.
        for (int lod = 2; lod <= layout.coarsest(); ++lod) {
            for (int row = 0; row < layout.blocks_along(lod); ++row) {
                for (int column = 0; column < layout.blocks_along(lod); ++column) {
                    float& error = errors.blocks[layout.index(lod, row, column)];
                    for (int child = 0; child < 4; ++child) {
                        error = std::max(
                            error, errors.at(lod - 1, 2 * row + child / 2, 2 * column + child % 2));
                    }
                }
            }
        }
        Camera camera;
        const glm::dvec2 size = info.extent_max() - info.extent_min();
        camera.position = {info.origin + size * glm::dvec2(unit() * 1.6 - 0.3, unit() * 1.6 - 0.3),
                           100 + 900 * unit()};
        camera.orientation = Camera::look({unit() - 0.5, unit() - 0.5, -0.6 * unit()});
        camera.vertical_fov = 0.3 + unit();
        Selection selection;
        multi_context::Traversal(info, layout, ranges, errors, 1, camera).select(selection);
        std::set<std::array<int, 3>> found;
        for (const SelectedBlock& b : selection.blocks) {
            EXPECT_TRUE(found.insert({b.lod, b.row, b.column}).second);
        }
        const auto expected = search_from_below(
            *terrain, layout, camera,
            [&](int lod, int row, int column) { return errors.at(lod, row, column) <= 1; });
        EXPECT_EQ(found, expected) << "case " << i;
        drawn += found.size();
        culled += selection.culled;
        mixed += found.size() > 1 && (*found.begin())[0] != (*found.rbegin())[0];
    }
    EXPECT_GT(drawn, 500U);
    EXPECT_GT(culled, 200U);
    EXPECT_GT(mixed, 50U);
}

}  // namespace
}  // namespace lodbench::test
