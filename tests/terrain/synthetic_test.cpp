// Synthetic terrains: their formulas, their bits, and what they refuse.

#include "terrain/synthetic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/error.h"

namespace lodbench::terrain {
namespace {

TerrainSource form(const std::string& name, int rows, int columns) {
    TerrainSource source;
    source.synthetic = name;
    source.rows = rows;
    source.columns = columns;
    return source;
}

float at(const HeightField& field, int row, int column) {
    return field
        .samples()[std::size_t(row) * std::size_t(field.info().columns) + std::size_t(column)];
}

std::string refusal(const TerrainSource& source) {
    try {
        (void)load_terrain(source);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Synthetic, plane_has_one_height) {
    TerrainSource source = form("plane", 3, 5);
    source.shape["height"] = 12.5;
    const auto field = load_terrain(source);
    EXPECT_EQ(field->info().min_height, 12.5F);
    EXPECT_EQ(field->info().max_height, 12.5F);
}

TEST(Synthetic, ramp_rises_by_its_slopes_east_and_north) {
    TerrainSource source = form("ramp", 4, 6);
    source.shape = {{"base", 1}, {"slope_x", 0.5}, {"slope_y", 0.25}};
    const auto field = load_terrain(source);  // 10 m spacing
    EXPECT_EQ(at(*field, 3, 0), 1.0F);
    EXPECT_EQ(at(*field, 3, 5), 1.0F + 25.0F);
    EXPECT_EQ(at(*field, 0, 0), 1.0F + 7.5F);
}

TEST(Synthetic, sphere_cap_lies_on_its_sphere) {
    TerrainSource source = form("sphere-cap", 33, 65);
    source.spacing_y = 7;
    source.shape = {{"radius", 900}, {"base", 3}};
    const auto field = load_terrain(source);
    const double rim = std::sqrt(900.0 * 900 - 320.0 * 320 - 112.0 * 112);
    for (int row = 0; row < 33; ++row) {
        for (int column = 0; column < 65; ++column) {
            const double x = 10.0 * (column - 32);
            const double y = 7.0 * (16 - row);
            const double z = double(at(*field, row, column)) - 3 + rim;
            // Half a unit in the last place of a float under 128, and the rounding of doubles near
            // 900.
            EXPECT_NEAR(z, std::sqrt(900.0 * 900 - x * x - y * y), 0x1p-18 + 1e-12);
        }
    }
    EXPECT_EQ(field->info().min_height, 3.0F);
    source.shape["radius"] = 300;
    EXPECT_EQ(refusal(source),
              "synthetic terrain 'sphere-cap': radius = 300: the sphere must reach the corners, "
              "339.034 m from the centre");
}

TEST(Synthetic, checkerboard_raises_every_second_sample) {
    TerrainSource source = form("checkerboard", 3, 4);
    source.shape = {{"base", -5}, {"height", 30}};
    const auto field = load_terrain(source);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            EXPECT_EQ(at(*field, row, column), (row + column) % 2 == 0 ? -5.0F : 25.0F);
        }
    }
}

TEST(Synthetic, terraces_are_the_ridged_relief_cut_into_levels) {
    TerrainSource source = form("terraces", 65, 65);
    source.shape = {{"base", 7}, {"height", 600}, {"step", 50}};
    source.seed = 3;
    const auto field = load_terrain(source);
    source.synthetic = "ridged";
    source.shape.erase("step");
    const auto relief = load_terrain(source);
    int levels_met = 0;
    for (std::size_t i = 0; i < field->samples().size(); ++i) {
        const float below = relief->samples()[i] - field->samples()[i];
        EXPECT_GE(below, -1e-4);  // the relief is rounded to float
        EXPECT_LT(below, 50 + 1e-4);
        EXPECT_EQ(std::fmod(double(field->samples()[i]) - 7, 50), 0);
        levels_met += i > 0 && field->samples()[i] != field->samples()[i - 1];
    }
    EXPECT_GT(levels_met, 100) << "cliffs between neighbours";
    source.synthetic = "terraces";
    source.shape["step"] = 0;
    EXPECT_EQ(refusal(source), "synthetic terrain 'terraces': step = 0: it must be above 0");
}

TEST(Synthetic, bump_raises_one_sample) {
    TerrainSource source = form("bump", 5, 7);
    const auto field = load_terrain(source);
    EXPECT_EQ(at(*field, 2, 3), 100.0F);
    EXPECT_EQ(std::ranges::count(field->samples(), 0.0F), 34);
    source.shape = {{"row", 5}};
    EXPECT_EQ(refusal(source), "synthetic terrain 'bump': row = 5: it must lie in 0 to 4");
    source.shape = {{"row", 1.5}};
    EXPECT_EQ(refusal(source), "synthetic terrain 'bump': row = 1.5: it must be a whole number");
}

TEST(Synthetic, step_is_a_cliff_before_its_column) {
    TerrainSource source = form("step", 2, 6);
    source.shape = {{"column", 4}, {"height", 50}};
    const auto field = load_terrain(source);
    EXPECT_EQ(at(*field, 0, 3), 0.0F);
    EXPECT_EQ(at(*field, 0, 4), 50.0F);
    EXPECT_EQ(at(*field, 1, 5), 50.0F);
}

// Taken from the first build; an optimiser or a machine that changes one bit of one height is found
// here.
TEST(Synthetic, ridged_is_the_same_to_the_bit_everywhere) {
    TerrainSource source = form("ridged", 129, 65);
    source.seed = 7;
    EXPECT_EQ(load_terrain(source)->info().checksum, "8aad382ea650e826");
}

TEST(Synthetic, every_form_repeats_itself_and_fits_any_size) {
    for (const SyntheticForm& known : synthetic_forms()) {
        for (const auto& [rows, columns] : {std::pair{2, 2}, std::pair{2, 31}, std::pair{64, 3}}) {
            const TerrainSource source = form(known.name, rows, columns);
            const auto once = load_terrain(source);
            EXPECT_EQ(once->info().rows, rows);
            EXPECT_EQ(once->info().columns, columns);
            EXPECT_EQ(once->info().checksum, load_terrain(source)->info().checksum) << known.name;
        }
    }
}

TEST(Synthetic, ridged_stays_in_its_range_and_follows_its_seed) {
    TerrainSource source = form("ridged", 257, 257);
    source.shape = {{"base", 500}, {"height", 1000}};
    const auto one = load_terrain(source);
    EXPECT_GE(one->info().min_height, 500.0F);
    EXPECT_LE(one->info().max_height, 1500.0F);
    EXPECT_GT(one->info().max_height - one->info().min_height, 300.0F) << "no relief";
    source.seed = 2;
    EXPECT_NE(load_terrain(source)->info().checksum, one->info().checksum);
}

// The noise of every octave is zero on its own lattice; were the lattices not moved apart, all
// octaves would peak together at each node of the first.
TEST(Synthetic, ridged_octaves_do_not_share_their_nodes) {
    TerrainSource source = form("ridged", 65, 65);
    EXPECT_LT(at(*load_terrain(source), 64, 0), 2000.0F * 0.999F);
    EXPECT_LT(at(*load_terrain(source), 0, 64), 2000.0F * 0.999F);
}

TEST(Synthetic, documented_parameters_are_the_known_ones) {
    for (const SyntheticForm& known : synthetic_forms()) {
        for (const ShapeParam& param : known.params) {
            TerrainSource source = form(known.name, 9, 9);
            source.shape[param.name] = std::numeric_limits<double>::quiet_NaN();
            EXPECT_EQ(refusal(source), std::string("synthetic terrain '") + known.name +
                                           "': " + param.name + " = nan: it must be finite");
        }
    }
}

TEST(Synthetic, refuses_unknown_names_and_lists_the_known) {
    EXPECT_EQ(refusal(form("mountain", 9, 9)),
              "unknown synthetic terrain 'mountain'; known: plane, ramp, sphere-cap, bump, step, "
              "checkerboard, ridged, terraces");
    TerrainSource source = form("ramp", 9, 9);
    source.shape["slope"] = 1;
    source.where = "scenario.toml:12";
    EXPECT_EQ(refusal(source),
              "scenario.toml:12: synthetic terrain 'ramp': unknown shape parameter 'slope'; known: "
              "base, slope_x, slope_y");
}

TEST(Synthetic, refuses_sizes_without_a_cell_or_beyond_the_cap) {
    EXPECT_EQ(
        refusal(form("plane", 1, 9)),
        "synthetic terrain 'plane': 1 rows x 9 columns make no surface; at least 2 x 2 samples "
        "are needed");
    EXPECT_NE(refusal(form("plane", 0, 0)), "accepted");
    EXPECT_NE(refusal(form("plane", -5, -5)), "accepted");
    EXPECT_EQ(refusal(form("plane", 2000000000, 2000000000)),
              "synthetic terrain 'plane': 2000000000 rows x 2000000000 columns are more than the "
              "2147483648 samples that are held in memory; crop or thin it, or make it a store "
              "(.tiles)");
}

TEST(Synthetic, refuses_heights_that_do_not_fit_a_float) {
    TerrainSource source = form("plane", 2, 2);
    source.shape["height"] = 1e39;
    EXPECT_EQ(refusal(source),
              "terrain 'plane': the height at row 0, column 0 is inf; every height must be finite");
}

}  // namespace
}  // namespace lodbench::terrain
