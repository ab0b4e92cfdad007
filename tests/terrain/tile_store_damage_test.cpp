// Damaged stores, and those that lie, are refused by name, or the tile is.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fuzz/tile_store_fuzz.h"

namespace lodbench::test {
namespace {

using terrain::name_of;
using terrain::StoredTerrain;
using testing::HasSubstr;

constexpr int kRows = 200, kColumns = 150;  // 4 x 3, 2 x 2, 1 x 1: with padding

class DamagedStore : public testing::Test {
protected:
    /// What opening says; empty where it is content.
    std::string refusal(const std::string& bytes) {
        write_bytes(file_, bytes);
        try {
            const StoredTerrain store(file_);
            return "";
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), testing::StartsWith(file_.string() + ": "));
            return std::string(error.what()).substr(file_.string().size() + 2);
        }
    }
    std::vector<std::string> faults(const std::string& bytes) {
        write_bytes(file_, bytes);
        return terrain::check_tiles(StoredTerrain(file_)).faults;
    }
    /// Offset of a tile's sample in the file.
    static std::size_t sample(const TileId& tile, int row, int column) {
        const terrain::StoreLayout layout(kRows, kColumns, {terrain::StoreSamples::steps, 0.5, 0});
        return layout.offset(tile) + std::size_t(row * kTileSamples + column) * 2;
    }
    static std::size_t entry(const TileId& tile) {
        return 1024 + 32 * TilePyramid(kRows, kColumns).index(tile);
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_.path() / "a.tiles";
    std::string whole_ = [this] {
        terrain::write_store(rough_field(kRows, kColumns, 2), 0.5, file_);
        return bytes_of(file_);
    }();
};

TEST_F(DamagedStore, with_any_bit_of_header_or_index_flipped_is_refused) {
    ASSERT_EQ(refusal(whole_), "");
    base::SplitMix64 random(1);
    const std::size_t end = 1024 + 32 * TilePyramid(kRows, kColumns).count();
    for (std::size_t place = 0; place < end; ++place) {
        std::string bytes = whole_;
        bytes[place] = char(bytes[place] ^ (1 << random.below(8)));
        EXPECT_NE(refusal(bytes), "") << place;
    }
}

TEST_F(DamagedStore, with_a_bit_of_a_tile_flipped_names_that_tile_and_gives_all_others) {
    base::SplitMix64 random(2);
    const TilePyramid pyramid(kRows, kColumns);
    const terrain::StoreLayout layout(kRows, kColumns, {terrain::StoreSamples::steps, 0.5, 0});
    for (int i = 0; i < 150; ++i) {
        const std::uint64_t place =
            layout.data_offset() + random.below(whole_.size() - layout.data_offset());
        std::string bytes = whole_;
        bytes[place] = char(bytes[place] ^ (1 << random.below(8)));
        const std::vector<std::string> found = faults(bytes);
        ASSERT_EQ(found.size(), 1U) << place << ": " << testing::PrintToString(found);
        const StoredTerrain store(file_);
        std::vector<float> heights(kTileSampleCount);
        int failed = 0;
        for (int level = 0; level < pyramid.levels(); ++level) {
            for (int row = 0; row < pyramid.rows(level); ++row) {
                for (int column = 0; column < pyramid.columns(level); ++column) {
                    const TileId tile{level, row, column};
                    const std::uint64_t offset = layout.offset(tile);
                    const bool hit = place >= offset && place < offset + layout.record_bytes();
                    try {
                        store.read_tile(tile, heights);
                        EXPECT_FALSE(hit);
                    } catch (const TerrainError& error) {
                        EXPECT_TRUE(hit);
                        EXPECT_THAT(error.what(), HasSubstr(name_of(tile) + ": the checksum is "));
                        EXPECT_THAT(found[0], HasSubstr(name_of(tile) + ": the checksum is "));
                        ++failed;
                    }
                }
            }
        }
        EXPECT_EQ(failed, 1);
    }
}

TEST_F(DamagedStore, cut_anywhere_is_refused) {
    base::SplitMix64 random(3);
    for (int i = 0; i < 200; ++i) {
        const std::size_t length =
            i < 20 ? whole_.size() - std::size_t(i) - 1 : std::size_t(random.below(whole_.size()));
        EXPECT_THAT(refusal(whole_.substr(0, length)), HasSubstr("truncated")) << length;
    }
    EXPECT_THAT(refusal(whole_ + "x"), HasSubstr("it is too long"));
    EXPECT_THAT(refusal(""),
                HasSubstr("0 bytes, of which a tiled store's header alone takes 1024"));
}

TEST_F(DamagedStore, of_another_kind_is_refused_in_words) {
    std::string bytes = whole_;
    bytes.replace(0, 8, "\x89PNG\r\n\x1a\n");
    EXPECT_THAT(refusal(bytes), HasSubstr("not a tiled store (it does not begin with LODTILES)"));
    bytes = whole_;
    std::reverse(bytes.begin() + 8, bytes.begin() + 12);
    sign(bytes);
    EXPECT_THAT(refusal(bytes), HasSubstr("in the wrong order (big-endian)"));
    bytes = whole_;
    set_field(bytes, 12, 2U);
    sign(bytes);
    EXPECT_EQ(refusal(bytes),
              "a store of version 2, this lodbench reads version 1; build it anew with this one");
    bytes = whole_;
    set_field(bytes, 12, 9U);
    EXPECT_THAT(refusal(bytes), HasSubstr("version 9")) << "whatever else its header has";
    EXPECT_THROW(StoredTerrain(folder_.path()), InputError);
    EXPECT_THROW(StoredTerrain(folder_.path() / "none.tiles"), InputError);
}

TEST_F(DamagedStore, that_lies_in_its_header_is_refused_by_the_field) {
    struct Lie {
        std::size_t offset;
        std::uint64_t value;
        int bytes;
        const char* words;
    };
    const auto real = [](double value) { return std::bit_cast<std::uint64_t>(value); };
    const auto single = [](float value) {
        return std::uint64_t(std::bit_cast<std::uint32_t>(value));
    };
    const Lie lies[] = {
        {16, 4096, 4, "the size of the header is 4096, expected 1024"},
        {20, 33, 4, "the number of samples along a tile is 33, expected 65"},
        {24, 0, 4, "the number of rows is 0, expected 2 to 1073741824"},
        {24, 0xffffffff, 4, "the number of rows is 4294967295"},
        {24, 1 << 30, 4, "the number of levels is 3, expected 25"},
        {28, 1, 4, "the number of columns is 1"},
        {28, 151, 4, ""},  // as many tiles: the range of heights, or the checksum of the grid
        {28, 300, 4, "the number of"},
        {32, real(NAN), 8, "the spacing (x) is nan"},
        {32, real(0), 8, "the spacing (x) is 0"},
        {40, real(-1), 8, "the spacing (y) is -1"},
        {48, real(INFINITY), 8, "the origin (x) is inf"},
        {56, real(NAN), 8, "the origin (y) is nan"},
        {64, 0, 4, "the type of samples is 0, expected 1 to 2"},
        {64, 1, 4, "the step is 0.5, expected 0"},
        {68, 0xffffffff, 4, "the number of levels is 4294967295, expected 3"},
        {72, real(NAN), 8, "the step is nan"},
        {72, real(1e300), 8, "the step is 1e+300"},
        {80, std::uint64_t(1) << 62U, 8, "the lowest height in steps is 4611686018427387904"},
        {88, single(NAN), 4, "the lowest height is nan"},
        {88, single(-1e6F), 4, "heights of -1000000 to"},
        {92, single(INFINITY), 4, "the highest height is inf"},
        {92, single(-1e6F), 4, "the highest height is -1000000"},
        {96, std::uint64_t(1) << 60U, 8, "the number of voids is"},
        {112, 0, 8, "the offset of the index is 0"},
        {120, std::uint64_t(1) << 60U, 8, "the number of tiles is 1152921504606846976"},
        {128, 8, 8, "the offset of the tiles is 8"},
        {136, 0, 8, "the size of a record is 0, expected 8450"},
        {144, 1, 8, "the size of the file is 1"},
        {152, 0xffffffff, 4, "the length of the name is 4294967295, expected 0 to 256"},
        {152, 2, 4, "the byte at 162 is "},
        {156, 1, 4, "the field at byte 156 is 1"},
        {416, 5, 4, "the rows of tiles of level 0 is 5, expected 4"},
        {424, 0, 4, "the first tile of level 0 is 0, expected 5"},
        {416 + 3 * 16, 1, 4, "the rows of tiles of level 3 is 1, expected 0"},
        {900, 1, 4, "the byte at 900 is 1"},
    };
    for (const Lie& lie : lies) {
        std::string bytes = whole_;
        for (int i = 0; i < lie.bytes; ++i) {
            bytes[lie.offset + std::size_t(i)] = char(lie.value >> (8 * i));
        }
        sign(bytes);
        const std::string found = refusal(bytes);
        if (*lie.words != '\0') {
            EXPECT_THAT(found, HasSubstr(lie.words)) << lie.offset;
        } else {
            EXPECT_TRUE(!found.empty() || !faults(bytes).empty());
        }
    }
}

TEST_F(DamagedStore, that_lies_about_a_tile_is_refused_by_its_name) {
    const TileId tile{0, 1, 2};
    const auto lie = [&](std::size_t offset, auto value) {
        std::string bytes = whole_;
        set_field(bytes, entry(tile) + offset, value);
        sign(bytes);
        return refusal(bytes);
    };
    const std::string name = "tile (level 0, row 1, column 2): ";
    const auto next = field_at<std::uint64_t>(whole_, entry(tile) + 32);
    for (const std::uint64_t offset :
         {std::uint64_t(0), next, std::uint64_t(whole_.size()), ~std::uint64_t(0), next + 1}) {
        EXPECT_THAT(lie(0, offset),
                    HasSubstr(name + "the offset is " + std::to_string(offset) + ", expected "));
    }
    EXPECT_THAT(lie(16, float(NAN)), HasSubstr(name + "the lowest height is nan"));
    EXPECT_THAT(lie(16, 1e9F), HasSubstr(name + "the highest height is "));
    EXPECT_THAT(lie(20, float(INFINITY)), HasSubstr(name + "the highest height is inf"));
    EXPECT_THAT(lie(24, -1.0F), HasSubstr(name + "the midpoint error is -1"));
    EXPECT_THAT(lie(28, 7U), HasSubstr(name + "the field at byte 28 is 7"));
}

TEST_F(DamagedStore, with_a_summary_that_is_not_the_tile_s_is_found_by_the_check) {
    const TileId tile{1, 1, 0};
    std::string bytes = whole_;
    set_field(bytes, entry(tile) + 24, 1e5F);
    sign(bytes);
    EXPECT_THAT(
        faults(bytes),
        testing::ElementsAre(HasSubstr("tile (level 1, row 1, column 0): its summary says ")));
    bytes = whole_;
    set_field(bytes, entry(tile) + 16, -1e5F);
    sign(bytes);
    EXPECT_THAT(faults(bytes),
                testing::ElementsAre(
                    HasSubstr("tile (level 1, row 1, column 0): its summary says -100000 to")));
    // Heights that the index denies are not served.
    bytes = whole_;
    set_field(bytes, entry(tile) + 20, field_at<float>(whole_, entry(tile) + 16));
    sign(bytes);
    EXPECT_THAT(faults(bytes),
                testing::Contains(
                    HasSubstr("tile (level 1, row 1, column 0): heights that are not within")));
}

TEST_F(DamagedStore, with_tiles_that_do_not_fit_together_is_found_by_the_check) {
    const TilePyramid pyramid(kRows, kColumns);
    const auto changed = [&](const TileId& tile, int row, int column) {
        std::string bytes = whole_;
        const std::size_t place = sample(tile, row, column);
        // To a neighbour's height, which is within the tile's range.
        set_field(bytes, place, field_at<std::uint16_t>(whole_, sample(tile, row, column) - 4));
        sign_tile(bytes, pyramid.index(tile));
        return faults(bytes);
    };
    // Rows 0 to 64 of tile row 1 are those from 64 on; its western border is its neighbour's
    // eastern one.
    EXPECT_THAT(changed({0, 1, 1}, 10, 64),
                testing::Contains("tile (level 0, row 1, column 2): its western border is not its "
                                  "neighbour's eastern one"));
    EXPECT_THAT(changed({0, 1, 1}, 64, 10),
                testing::Contains("tile (level 0, row 2, column 1): its northern border is not its "
                                  "neighbour's southern one"));
    EXPECT_THAT(changed({0, 3, 0}, 40, 10),
                testing::Contains("tile (level 0, row 3, column 0): beyond the grid it does not "
                                  "repeat the nearest sample"));
    EXPECT_THAT(changed({1, 0, 0}, 10, 10),
                testing::Contains("tile (level 1, row 0, column 0): its heights are not those of "
                                  "the finer levels"));
    // In the middle of a tile only the grid's checksum, or what follows from it, can tell.
    EXPECT_FALSE(changed({0, 1, 1}, 11, 11).empty());
}

TEST_F(DamagedStore, of_another_grid_than_its_header_says_is_found_by_whoever_reads_all) {
    std::string bytes = whole_;
    set_field(bytes, 104, std::uint64_t(0x1234));
    sign(bytes);
    const std::string found = "the checksum " + StoredTerrain(file_).info().checksum;
    EXPECT_THAT(faults(bytes),
                testing::ElementsAre(HasSubstr(found + ", the header says 0000000000001234")));
    EXPECT_THROW((void)terrain::whole_field(StoredTerrain(file_)), TerrainError);
}

TEST_F(DamagedStore, with_heights_that_are_none_serves_none) {
    for (const float bad : {float(NAN), float(INFINITY), -float(INFINITY), 1e30F}) {
        terrain::write_store(rough_field(2, 2, 1), std::nullopt, file_);
        std::string bytes = bytes_of(file_);
        set_field(bytes, 1024 + 32 + 4 * 5, bad);
        sign_tile(bytes, 0);
        write_bytes(file_, bytes);
        const StoredTerrain store(file_);
        std::vector<float> heights(kTileSampleCount);
        EXPECT_THROW(store.read_tile({0, 0, 0}, heights), TerrainError);
        EXPECT_THROW((void)terrain::whole_field(store), TerrainError);
    }
}

TEST_F(DamagedStore, that_is_vast_and_empty_costs_no_memory) {
    // 2^20 x 2^20 samples: 6 TB, of which not a block is on the disk but the header's.
    const TerrainInfo info = grid("vast", 1 << 20, 1 << 20);
    auto header = terrain::encode_header({info, {}, 0});
    write_bytes(file_, std::string(reinterpret_cast<const char*>(header.data()), header.size()));
    std::error_code error;
    const terrain::StoreLayout layout(info.rows, info.columns, {});
    std::filesystem::resize_file(file_, layout.file_bytes(), error);
    if (error) GTEST_SKIP() << "the file system has no files of 6 TB: " << error.message();
    try {
        const StoredTerrain store(file_);
        ADD_FAILURE();
    } catch (const std::runtime_error& refused) {
        EXPECT_THAT(refused.what(),
                    testing::AnyOf(HasSubstr("tile (level 0, row 0, column 0): the offset is 0"),
                                   HasSubstr("MiB of memory are free")));
    }
}

/// What the fuzzer begins from and a few thousand changes of it, for compilers that have none.
TEST_F(DamagedStore, changed_at_random_never_does_more_than_refuse) {
    base::SplitMix64 random(4);
    int opened = 0;
    for (const std::string& store : seed_stores()) {
        for (int i = 0; i < 300; ++i) {
            std::string input = std::string(1, char(random.below(4))) + store;
            const std::uint64_t changes = random.below(6);
            for (std::uint64_t change = 0; change < changes; ++change) {
                // Most of them in the header and the index.
                const std::size_t reach = random.below(3) > 0 ? 1200 : input.size() - 1;
                const std::size_t place = 1 + random.below(reach);
                const std::uint64_t kind = random.below(3);
                if (kind == 0) input[place] = char(random.next());
                if (kind == 1) input[place] = char(input[place] ^ (1 << random.below(8)));
                if (kind == 2) input[place] = random.below(2) == 0 ? '\0' : '\xff';
            }
            if (random.below(20) == 0) input.resize(random.below(input.size()));
            const auto bytes =
                std::span(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
            if (use_as_store(bytes)) ++opened;
        }
    }
    EXPECT_GT(opened, 300);
    EXPECT_FALSE(use_as_store({}));
}

}  // namespace
}  // namespace lodbench::test
