#pragma once
// Terrains and their stores, and bytes of a store changed on purpose.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "raster_files.h"
#include "support/pyramid_tiles.h"
#include "terrain/tile_store.h"
#include "terrain/tile_store_writer.h"

namespace lodbench::test {

inline TerrainInfo grid(const std::string& name, int rows, int columns) {
    TerrainInfo info;
    info.name = name;
    info.rows = rows;
    info.columns = columns;
    return info;
}

/// Heights from a seed, rough enough that no two tiles are equal; both signs, and a negative zero.
inline terrain::HeightField rough_field(int rows, int columns, std::uint64_t seed) {
    TerrainInfo info = grid("rough", rows, columns);
    info.spacing = {10, 7};
    info.origin = {1000, -2000};
    info.void_count = 3;
    base::SplitMix64 random(seed);
    std::vector<float> heights(std::size_t(rows) * std::size_t(columns));
    for (float& height : heights) height = float(double(random.next() >> 40U) * 1e-4 - 300);
    heights[1] = -0.0F;
    return {info, std::move(heights)};
}

inline bool same_bits(std::span<const float> one, std::span<const float> other) {
    return std::ranges::equal(one, other, [](float a, float b) {
        return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
    });
}

/// All that a terrain tells and serves.
inline void expect_equal(const Terrain& store, const terrain::HeightField& field) {
    EXPECT_EQ(store.info().name, field.info().name);
    EXPECT_EQ(store.info().rows, field.info().rows);
    EXPECT_EQ(store.info().columns, field.info().columns);
    EXPECT_EQ(store.info().spacing, field.info().spacing);
    EXPECT_EQ(store.info().origin, field.info().origin);
    EXPECT_EQ(store.info().min_height, field.info().min_height);
    EXPECT_EQ(store.info().max_height, field.info().max_height);
    EXPECT_EQ(store.info().void_count, field.info().void_count);
    EXPECT_EQ(store.info().checksum, field.info().checksum);
    std::vector<float> one(kTileSampleCount), other(kTileSampleCount);
    for (const TileId& tile : all_tiles(field.tiles())) {
        SCOPED_TRACE(terrain::name_of(tile));
        store.read_tile(tile, one);
        field.read_tile(tile, other);
        EXPECT_TRUE(same_bits(one, other));
        const TileSummary a = store.tile_summary(tile), b = field.tile_summary(tile);
        EXPECT_EQ(a.min_height, b.min_height);
        EXPECT_EQ(a.max_height, b.max_height);
        EXPECT_EQ(a.midpoint_error, b.midpoint_error);
    }
    base::SplitMix64 random(9);
    for (int i = 0; i < 60; ++i) {
        SampleRect rect;
        rect.row = int(random.below(std::uint64_t(field.info().rows)));
        rect.column = int(random.below(std::uint64_t(field.info().columns)));
        rect.rows = int(random.below(std::uint64_t(field.info().rows - rect.row + 1)));
        rect.columns = int(random.below(std::uint64_t(field.info().columns - rect.column + 1)));
        if (i == 0) rect = {0, 0, field.info().rows, field.info().columns};
        std::vector<float> a(std::size_t(rect.rows) * std::size_t(rect.columns)), b(a.size());
        store.read(rect, a);
        field.read(rect, b);
        EXPECT_TRUE(same_bits(a, b))
            << rect.row << ' ' << rect.column << ' ' << rect.rows << ' ' << rect.columns;
    }
}

inline std::string bytes_of(const std::filesystem::path& file) {
    std::string bytes(std::filesystem::file_size(file), '\0');
    std::ifstream(file, std::ios::binary).read(bytes.data(), std::streamsize(bytes.size()));
    return bytes;
}

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

template <typename T>
T field_at(const std::string& bytes, std::size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

template <typename T>
void set_field(std::string& bytes, std::size_t offset, T value) {
    std::memcpy(bytes.data() + offset, &value, sizeof value);
}

/// Makes header and index such that their checksum holds: what a liar would do.
inline void sign(std::string& bytes) {
    const auto tiles = field_at<std::uint64_t>(bytes, 120);
    const auto all = std::as_bytes(std::span(bytes));
    base::WordHash hash;
    hash.add(all.first(1016));
    if (tiles <= (bytes.size() - 1024) / 32) hash.add(all.subspan(1024, tiles * 32));
    set_field(bytes, 1016, hash.value());
}

/// Makes the index say of a tile's bytes what they are.
inline void sign_tile(std::string& bytes, std::size_t index) {
    const auto record = field_at<std::uint64_t>(bytes, 136);
    const auto offset = field_at<std::uint64_t>(bytes, 1024 + index * 32);
    base::WordHash hash;
    hash.add(std::as_bytes(std::span(bytes)).subspan(offset, record));
    set_field(bytes, 1024 + index * 32 + 8, hash.value());
    sign(bytes);
}

}  // namespace lodbench::test
