// Which tiles are collected, which tree grows from them, and what is drawn of it.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "support/fake_terrain.h"
#include "support/pyramid_tiles.h"
#include "tile_quadtree/tile_cut.h"
#include "tile_quadtree/tile_mesh.h"
#include "tile_quadtree/visible_tiles.h"

namespace lodbench::tile_quadtree {
namespace {

using test::all_tiles;
using test::FakeTerrain;

constexpr std::pair<int, int> kSizes[] = {{2, 2},     {65, 65},     {66, 65},
                                          {129, 129}, {257, 257},   {100, 300},
                                          {700, 66},  {1025, 1025}, {600, 999}};

std::set<std::size_t> indices_of(const TileCatalogue& catalogue, const std::vector<TileId>& tiles) {
    std::set<std::size_t> found;
    for (const TileId& tile : tiles) found.insert(catalogue.index(tile));
    EXPECT_EQ(found.size(), tiles.size()) << "a tile twice";
    return found;
}

/// The root and the children of each visible tile.
std::size_t tested_from_above(const TileCatalogue& catalogue, const std::vector<TileId>& visible) {
    std::size_t tested = 1;
    for (const TileId& tile : visible) {
        catalogue.for_each_child(tile, [&](const TileId&) { ++tested; });
    }
    return tested;
}

TEST(VisibleTiles, of_one_tree_and_of_two_layers_are_those_that_touch_the_region) {
    std::mt19937 random(1);
    for (const auto& [rows, columns] : kSizes) {
        const FakeTerrain terrain(rows, columns);
        const TileCatalogue catalogue(terrain);
        std::vector<SampleBox> regions = {{}, catalogue.whole()};
        for (int i = 0; i < 20; ++i) {
            const int row = int(random() % unsigned(rows)),
                      column = int(random() % unsigned(columns));
            regions.push_back({row, column, int(row + random() % unsigned(rows - row)),
                               int(column + random() % unsigned(columns - column))});
        }
        for (const SampleBox& region : regions) {
            std::vector<TileId> touching = all_tiles(catalogue.pyramid());
            std::erase_if(touching, [&](const TileId& tile) {
                return !catalogue.samples(tile).touches(region);
            });
            const auto expected = indices_of(catalogue, touching);
            VisibleTiles one;
            collect_from_one_tree(catalogue, region, one);
            EXPECT_EQ(indices_of(catalogue, one.tiles), expected);
            EXPECT_EQ(one.tested, tested_from_above(catalogue, touching));
            for (const int upper : {0, 1, 2, 4, 12}) {
                const DoubleLayerTree layers(catalogue, upper);
                EXPECT_EQ(layers.upper_depth() + layers.lower_depth() + 1,
                          catalogue.pyramid().levels());
                VisibleTiles two;
                layers.collect(
                    region, [](const TileId&) { return true; }, two);
                EXPECT_EQ(indices_of(catalogue, two.tiles), expected)
                    << rows << " x " << columns << ", UL " << upper;
                // Children of a tile that is out of view are not visited.
                EXPECT_LE(two.tested, one.tested);
                VisibleTiles pruned;
                layers.collect(
                    region, [](const TileId&) { return false; }, pruned);
                EXPECT_TRUE(std::ranges::all_of(pruned.tiles, [&](const TileId& tile) {
                    return catalogue.depth(tile) <= layers.upper_depth();
                }));
            }
        }
    }
}

/// Each cell of the grid is covered by one drawn tile.
void expect_covered_once(const TileCatalogue& catalogue, const std::vector<DrawnTile>& drawn) {
    std::vector<int> covered(catalogue.pyramid().count(), 0);
    for (const DrawnTile& tile : drawn) {
        // Count at level 0 tiles.
        const int side = 1 << tile.tile.level;
        for (int row = tile.tile.row * side; row < (tile.tile.row + 1) * side; ++row) {
            for (int column = tile.tile.column * side; column < (tile.tile.column + 1) * side;
                 ++column) {
                const TileId leaf{0, row, column};
                if (catalogue.pyramid().contains(leaf)) ++covered[catalogue.index(leaf)];
            }
        }
    }
    const int leaves = catalogue.pyramid().rows(0) * catalogue.pyramid().columns(0);
    for (int i = 0; i < leaves; ++i) ASSERT_EQ(covered[std::size_t(i)], 1) << "tile " << i;
}

TileTree random_tree(const TileCatalogue& catalogue, unsigned seed, double share,
                     int most_leaves = 1 << 20) {
    return grow_tree(
        catalogue, most_leaves,
        [&](const TileId& tile) {
            std::mt19937 random(seed * 7919U + unsigned(catalogue.index(tile)));
            return tile.level > 0 && std::uniform_real_distribution(0.0, 1.0)(random) < share;
        },
        [](const TileId&) { return true; }, [&](const TileId& tile) { return double(tile.level); });
}

TEST(TileTree, equal_input_grows_an_equal_tree_and_never_more_leaves_than_allowed) {
    const FakeTerrain terrain(1025, 1025);
    const TileCatalogue catalogue(terrain);
    for (unsigned seed = 0; seed < 20; ++seed) {
        const TileTree unlimited = random_tree(catalogue, seed, 0.8);
        EXPECT_EQ(unlimited.refused, 0);
        for (const int most : {1, 4, 6, 7, 8, 50}) {
            const TileTree tree = random_tree(catalogue, seed, 0.8, most);
            EXPECT_LE(int(tree.leaves().size()), most);
            EXPECT_EQ(tree.refused > 0, unlimited.leaves().size() > std::size_t(most));
            EXPECT_EQ(random_tree(catalogue, seed, 0.8, most).leaves(), tree.leaves());
        }
    }
}

TEST(TileTree, most_urgent_tiles_split_first) {
    const FakeTerrain terrain(257, 257);
    const TileCatalogue catalogue(terrain);
    // Room for the root's children and one child's: the south-eastern one is the most urgent.
    const TileTree tree = grow_tree(
        catalogue, 7, [](const TileId& tile) { return tile.level > 0; },
        [](const TileId&) { return true; },
        [](const TileId& tile) { return double(tile.row + tile.column); });
    const std::vector<TileId> leaves = tree.leaves();
    EXPECT_EQ(leaves.size(), 7U);
    EXPECT_EQ(std::ranges::count_if(leaves,
                                    [](const TileId& tile) {
                                        return tile.level == 0 && tile.row >= 2 && tile.column >= 2;
                                    }),
              4);
}

TEST(TileTree, what_is_not_in_view_is_left_out_with_all_below_it) {
    const FakeTerrain terrain(257, 257);
    const TileCatalogue catalogue(terrain);
    const TileTree nothing = grow_tree(
        catalogue, 100, [](const TileId&) { return true; }, [](const TileId&) { return false; },
        [](const TileId&) { return 1.0; });
    EXPECT_TRUE(nothing.nodes.empty());
    CutBuilder cut(catalogue);
    EXPECT_TRUE(cut.build(nothing, [](const TileId&) { return true; }).empty());
    const TileTree west = grow_tree(
        catalogue, 100, [](const TileId& tile) { return tile.level > 0; },
        [&](const TileId& tile) { return catalogue.samples(tile).first_column < 128; },
        [](const TileId&) { return 1.0; });
    EXPECT_EQ(west.leaves().size(), 8U);
}

TEST(Cut, covers_every_leaf_once_whatever_is_resident) {
    for (const auto& [rows, columns] : kSizes) {
        const FakeTerrain terrain(rows, columns);
        const TileCatalogue catalogue(terrain);
        CutBuilder cut(catalogue);
        for (unsigned seed = 0; seed < 30; ++seed) {
            const TileTree tree = random_tree(catalogue, seed, 0.8);
            const auto whole = cut.build(tree, [](const TileId&) { return true; });
            expect_covered_once(catalogue, whole);
            EXPECT_EQ(whole.size(), tree.leaves().size());
            for (const double there : {0.0, 0.5, 0.9}) {
                const auto resident = [&](const TileId& tile) {
                    std::mt19937 random(seed * 31U + unsigned(catalogue.index(tile)));
                    return tile == catalogue.pyramid().root() ||
                           std::uniform_real_distribution(0.0, 1.0)(random) < there;
                };
                const auto drawn = cut.build(tree, resident);
                expect_covered_once(catalogue, drawn);
                for (const DrawnTile& tile : drawn) {
                    EXPECT_TRUE(resident(tile.source()));
                    for (int up = 0; up < tile.coarsened; ++up) {
                        EXPECT_FALSE(resident(
                            {tile.tile.level + up, tile.tile.row >> up, tile.tile.column >> up}))
                            << "a nearer ancestor is resident";
                    }
                }
                if (there == 0) {
                    EXPECT_EQ(drawn.size(), 1U);
                }
            }
        }
    }
}

TEST(Cut, a_missing_tile_is_drawn_from_its_nearest_ancestor_and_no_other_tile_suffers) {
    const FakeTerrain terrain(257, 257);
    const TileCatalogue catalogue(terrain);
    CutBuilder cut(catalogue);
    const TileTree tree = random_tree(catalogue, 0, 1.0);
    const auto drawn = cut.build(tree, [](const TileId& tile) {
        return !(tile == TileId{0, 1, 1}) && !(tile == TileId{0, 3, 3}) &&
               !(tile == TileId{1, 1, 1});
    });
    ASSERT_EQ(drawn.size(), 16U);
    for (const DrawnTile& tile : drawn) {
        // The first hole is filled by its parent; the second one's parent is missing too.
        const int expected = tile.tile == TileId{0, 1, 1}   ? 1
                             : tile.tile == TileId{0, 3, 3} ? 2
                                                            : 0;
        EXPECT_EQ(tile.coarsened, expected);
        EXPECT_EQ(tile.stands_in, expected > 0);
    }
    const auto quarter = cut.build(
        tree, [](const TileId& tile) { return tile.level > 0 || tile.row > 1 || tile.column > 1; });
    EXPECT_EQ(quarter.size(), 13U)
        << "of a tile none of whose children is there it is drawn itself";
    EXPECT_EQ(std::ranges::count(quarter, true, &DrawnTile::stands_in), 1);
}

/// The drawn tile over a level-0 tile; nullptr where none is.
const DrawnTile* tile_over(const TileCatalogue& catalogue,
                           const std::map<std::size_t, const DrawnTile*>& drawn, int row,
                           int column) {
    for (TileId tile{0, row, column}; catalogue.pyramid().contains(tile);
         tile = {tile.level + 1, tile.row / 2, tile.column / 2}) {
        const auto found = drawn.find(catalogue.index(tile));
        if (found != drawn.end()) return found->second;
    }
    return nullptr;
}

TEST(Cut, tiles_on_both_sides_of_a_line_put_their_vertices_at_the_same_places) {
    const FakeTerrain terrain(1025, 700);
    const TileCatalogue catalogue(terrain);
    CutBuilder cut(catalogue);
    int coarsened = 0;
    for (unsigned seed = 0; seed < 60; ++seed) {
        const auto tiles = cut.build(random_tree(catalogue, seed, 0.75), [&](const TileId& tile) {
            return seed % 3 == 0 || (unsigned(catalogue.index(tile)) * 2654435761U + seed) % 7 > 2;
        });
        std::map<std::size_t, const DrawnTile*> drawn;
        for (const DrawnTile& tile : tiles) drawn[catalogue.index(tile.tile)] = &tile;
        for (const DrawnTile& tile : tiles) {
            coarsened += tile.coarsened > 0;
            const int side = 1 << tile.tile.level;
            const int row = tile.tile.row * side, column = tile.tile.column * side;
            for (int i = 0; i < side; ++i) {
                const std::array<const DrawnTile*, 4> beyond = {
                    tile_over(catalogue, drawn, row - 1, column + i),
                    tile_over(catalogue, drawn, row + i, column - 1),
                    tile_over(catalogue, drawn, row + i, column + side),
                    tile_over(catalogue, drawn, row + side, column + i)};
                for (std::size_t edge = 0; edge < 4; ++edge) {
                    const int level = tile.tile.level + tile.edges.coarser[edge];
                    EXPECT_GE(level, tile.source().level);
                    if (beyond[edge] == nullptr) continue;
                    EXPECT_EQ(level,
                              beyond[edge]->tile.level + beyond[edge]->edges.coarser[3 - edge]);
                    EXPECT_GE(level, beyond[edge]->source().level);
                }
            }
            if (seed % 3 != 0) continue;
            // With all resident: the coarser of both, no more.
            for (std::size_t edge = 0; edge < 4; ++edge) {
                if (tile.edges.coarser[edge] == 0) continue;
                const DrawnTile* other = edge == 0   ? tile_over(catalogue, drawn, row - 1, column)
                                         : edge == 1 ? tile_over(catalogue, drawn, row, column - 1)
                                         : edge == 2
                                             ? tile_over(catalogue, drawn, row, column + side)
                                             : tile_over(catalogue, drawn, row + side, column);
                ASSERT_NE(other, nullptr);
                EXPECT_EQ(tile.edges.coarser[edge], other->tile.level - tile.tile.level);
            }
        }
    }
    EXPECT_GT(coarsened, 100) << "too easy to judge by";
}

TEST(Cut, no_vertices_are_more_than_six_levels_coarser_than_a_tile_that_they_touch) {
    const FakeTerrain terrain(16385, 16385);  // nine levels
    const TileCatalogue catalogue(terrain);
    ASSERT_EQ(catalogue.pyramid().root().level, 8);
    // One path down to the full resolution, along the middle of the terrain from the north-west.
    const auto splits = [](const TileId& tile) {
        const int middle = 127 >> tile.level;
        return tile.level > 0 && tile.row == middle && tile.column == middle;
    };
    const TileTree tree = grow_tree(
        catalogue, 1000, splits, [](const TileId&) { return true; },
        [](const TileId&) { return 1.0; });
    EXPECT_EQ(std::ranges::min(tree.leaves(), {}, &TileId::level).level, 0);
    CutBuilder cut(catalogue);
    const auto most_coarser = [&](const auto& resident) {
        const auto drawn = cut.build(tree, resident);
        expect_covered_once(catalogue, drawn);
        int most = 0;
        for (const DrawnTile& tile : drawn) {
            most = std::max({most, tile.coarsened, std::ranges::max(tile.edges.coarser)});
        }
        return most;
    };
    EXPECT_EQ(most_coarser([](const TileId&) { return true; }), kMostCoarser)
        << "no more than needed gives way";
    for (int missing = 0; missing < 8; ++missing) {
        EXPECT_LE(most_coarser([&](const TileId& tile) { return tile.level != missing; }),
                  kMostCoarser);
        EXPECT_LE(most_coarser([&](const TileId& tile) { return tile.level > missing; }),
                  kMostCoarser);
        // One tile beside the path alone has nothing nearer than the root.
        EXPECT_LE(most_coarser([&](const TileId& tile) {
                      return tile.level >= 8 || tile.row == tile.column;
                  }),
                  kMostCoarser);
    }
}

TEST(TileMesh, has_two_triangles_a_cell_turned_alike_and_cut_as_longest_edge_bisection_cuts) {
    const TileMesh mesh = tile_mesh();
    EXPECT_EQ(mesh.tile_count, 3 * 2 * 64 * 64);
    EXPECT_EQ(mesh.skirt_count, 3 * 2 * 256);
    EXPECT_EQ(mesh.coarse_count, 3 * 2 * 16 * 16);
    const auto at = [&](int i) {
        const int vertex = mesh.indices[std::size_t(i)];
        return glm::ivec2(vertex % 65, vertex / 65);
    };
    int twice_area = 0;
    std::set<std::pair<int, int>> diagonals;
    for (int i = 0; i < mesh.tile_count; i += 3) {
        const glm::ivec2 a = at(i), b = at(i + 1), c = at(i + 2);
        // Rows count southward.
        const int twice = -((b - a).x * (c - a).y - (b - a).y * (c - a).x);
        EXPECT_EQ(twice, 1);
        twice_area += twice;
        for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
            if (p.x == q.x || p.y == q.y) continue;
            EXPECT_EQ(p.x % 2, p.y % 2) << "a diagonal joins even with odd";
            EXPECT_EQ(q.x % 2, q.y % 2);
            diagonals.insert({std::min(p.x, q.x), std::min(p.y, q.y)});
        }
    }
    EXPECT_EQ(twice_area, 2 * 64 * 64);
    EXPECT_EQ(diagonals.size(), 64U * 64U);
}

}  // namespace
}  // namespace lodbench::tile_quadtree
