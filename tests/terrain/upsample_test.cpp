// Upsampled terrains go through the samples of what they came from.

#include "terrain/upsample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "api/error.h"
#include "support/tile_store_files.h"
#include "terrain/open_terrain.h"

namespace lodbench::test {
namespace {

using terrain::HeightField;
using terrain::Upsampling;

class FieldRows final : public terrain::TerrainRows {
public:
    explicit FieldRows(const HeightField& field) : field_(field) { info_ = field.info(); }
    [[nodiscard]] terrain::Provenance provenance() const override { return {}; }
    void next(std::span<float> heights) override {
        ASSERT_LT(row_, info_.rows) << "asked for more rows than there are";
        field_.read({row_++, 0, 1, info_.columns}, heights);
    }

private:
    const HeightField& field_;
    int row_ = 0;
};

HeightField upsampled(const HeightField& field, const Upsampling& upsampling) {
    FieldRows rows(field);
    std::vector<float> heights;
    terrain::upsample(rows, upsampling, [&](std::span<const float> row) {
        heights.insert(heights.end(), row.begin(), row.end());
    });
    return {terrain::upsampled(field.info(), upsampling), std::move(heights)};
}

float at(const HeightField& field, int row, int column) {
    return field
        .samples()[std::size_t(row) * std::size_t(field.info().columns) + std::size_t(column)];
}

HeightField field_of(int rows, int columns, auto height) {
    std::vector<float> heights;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) heights.push_back(height(row, column));
    }
    return {grid("test", rows, columns), std::move(heights)};
}

TEST(Upsample, keeps_the_samples_to_the_bit_and_the_north_west_corner_in_its_place) {
    const HeightField field = rough_field(7, 9, 1);
    for (const Upsampling& upsampling : {Upsampling{.factor = 1},
                                         {.factor = 2},
                                         {.factor = 3},
                                         {.factor = 8},
                                         {.factor = 8, .fractal_amplitude = 50, .seed = 3},
                                         {.factor = 64},
                                         {.factor = 4, .rows = 10, .columns = 17},
                                         {.factor = 5, .rows = 30, .columns = 2},
                                         {.factor = 1, .rows = 3, .columns = 4}}) {
        const HeightField larger = upsampled(field, upsampling);
        const int factor = upsampling.factor;
        SCOPED_TRACE(factor);
        EXPECT_EQ(larger.info().rows, upsampling.rows.value_or(6 * factor + 1));
        EXPECT_EQ(larger.info().columns, upsampling.columns.value_or(8 * factor + 1));
        for (int row = 0; row * factor < larger.info().rows; ++row) {
            for (int column = 0; column * factor < larger.info().columns; ++column) {
                ASSERT_EQ(at(larger, row * factor, column * factor), at(field, row, column));
            }
        }
        const glm::dvec2 place = larger.info().position(0, 0) - field.info().position(0, 0);
        EXPECT_NEAR(place.x, 0, 1e-9);
        EXPECT_NEAR(place.y, 0, 1e-9);
        EXPECT_DOUBLE_EQ(larger.info().spacing.x * factor, field.info().spacing.x);
    }
}

TEST(Upsample, of_a_plane_is_the_plane_up_to_its_border) {
    const HeightField plane =
        field_of(5, 6, [](int row, int column) { return float(24 * row - 40 * column); });
    const HeightField larger = upsampled(plane, {.factor = 8});
    for (int row = 0; row < larger.info().rows; ++row) {
        for (int column = 0; column < larger.info().columns; ++column) {
            EXPECT_EQ(at(larger, row, column), float(3 * row - 5 * column));
        }
    }
}

TEST(Upsample, between_samples_is_catmull_and_rom_s) {
    // Halfway: (-a + 9 b + 9 c - d) / 16.
    const HeightField bump = field_of(2, 4, [](int, int column) {
        return std::array{0.F, 16.F, 32.F, -16.F}[std::size_t(column)];
    });
    const HeightField larger = upsampled(bump, {.factor = 2});
    EXPECT_EQ(at(larger, 0, 3), (0 + 9 * 16 + 9 * 32 + 16) / 16.0F);
    EXPECT_EQ(at(larger, 1, 3), at(larger, 0, 3));
    // At the border the line goes on: -16 before the first.
    EXPECT_EQ(at(larger, 0, 1), (16 + 0 + 9 * 16 - 32) / 16.0F);
}

TEST(Upsample, noise_depends_on_seed_and_place_alone_and_keeps_its_bounds) {
    const HeightField flat = field_of(40, 650, [](int, int) { return 100.0F; });
    const Upsampling all{.factor = 8, .fractal_amplitude = 10, .seed = 5};
    const HeightField one = upsampled(flat, all);
    // Cut from another side of the same rows, wider than a thread's share of them.
    Upsampling part = all;
    part.rows = 100;
    part.columns = 4500;
    const HeightField cut = upsampled(flat, part);
    double greatest = 0;
    double sum = 0;
    for (int row = 0; row < 100; ++row) {
        for (int column = 0; column < 4500; ++column) {
            ASSERT_EQ(at(one, row, column), at(cut, row, column));
            greatest = std::max(greatest, std::abs(at(one, row, column) - 100.0));
            sum += at(one, row, column) - 100.0;
        }
    }
    EXPECT_LE(greatest, 10 + 5 + 2.5);
    EXPECT_GT(greatest, 10);
    EXPECT_NEAR(sum / 450000, 0, 0.1);
    Upsampling other = all;
    other.seed = 6;
    EXPECT_NE(at(upsampled(flat, other), 4, 4), at(one, 4, 4));
    EXPECT_EQ(at(upsampled(flat, other), 8, 8), 100.0F);
}

TEST(Upsample, refuses_what_it_cannot_do) {
    const TerrainInfo info = grid("a", 9, 9);
    const auto refusal = [&](const Upsampling& upsampling) -> std::string {
        try {
            (void)terrain::upsampled(info, upsampling);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(refusal({.factor = 0}), "upsampling: a factor of 0; it must be 1 to 64");
    EXPECT_EQ(refusal({.factor = 65}), "upsampling: a factor of 65; it must be 1 to 64");
    EXPECT_EQ(refusal({.factor = 2, .fractal_amplitude = -1}),
              "upsampling: a fractal of -1 m; it must be 0 or more");
    EXPECT_EQ(refusal({.factor = 6, .fractal_amplitude = 1}),
              "upsampling: a fractal and a factor of 6; with a fractal it must be a power of two");
    EXPECT_EQ(refusal({.factor = 2, .rows = 18}), "upsampling: 18 rows of 17; keep 2 to 17");
    EXPECT_EQ(refusal({.factor = 2, .columns = 1}), "upsampling: 1 columns of 17; keep 2 to 17");
    EXPECT_NE(refusal({.factor = 2, .fractal_amplitude = NAN}), "");
}

TEST(Upsample, a_source_that_asks_for_it_is_loaded_larger_whatever_it_is_made_of) {
    terrain::TerrainSource source;
    source.synthetic = "ridged";
    source.rows = 17;
    source.columns = 33;
    source.spacing_x = source.spacing_y = 20;
    const Upsampling upsampling{.factor = 4, .fractal_amplitude = 3, .seed = 2};
    const HeightField expected = upsampled(*terrain::load_terrain(source), upsampling);
    source.upsampling = upsampling;
    terrain::OpenTerrain opened = terrain::open_terrain_with_provenance(source);
    EXPECT_EQ(opened.terrain->info().checksum, expected.info().checksum);
    EXPECT_EQ(opened.terrain->info().columns, 129);
    EXPECT_EQ(opened.terrain->info().spacing.x, 5);
    EXPECT_EQ(opened.terrain->info().name, "ridged-x4");
    EXPECT_EQ(opened.provenance.kind, "synthetic, upsampled by 4");

    // The same samples from a store. What it stays on disk for is refused.
    const TemporaryFolder folder;
    terrain::TerrainSource stored;
    stored.file = folder.path() / "a.tiles";
    source.upsampling.reset();
    terrain::write_store(*terrain::load_terrain(source), std::nullopt, stored.file);
    stored.upsampling = upsampling;
    EXPECT_EQ(terrain::open_terrain(stored)->info().checksum, expected.info().checksum);
    stored.cold = true;
    try {
        (void)terrain::open_terrain(stored);
        FAIL() << "it was cold";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(),
                    testing::HasSubstr("cold is set, but what is upsampled lies in memory"));
    }
}

TEST(Upsample, a_source_is_refused_with_its_place_before_memory_is_taken) {
    terrain::TerrainSource source;
    source.synthetic = "plane";
    source.rows = source.columns = 1025;
    source.where = "a.toml:2";
    source.upsampling = Upsampling{.factor = 64};
    try {
        (void)terrain::load_terrain(source);
        FAIL() << "275 GB were held";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::StartsWith("a.toml:2: terrain 'plane-x64'"));
    }
}

}  // namespace
}  // namespace lodbench::test
