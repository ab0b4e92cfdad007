// What a method asks for is counted, and nothing else.

#include "run/served_terrain.h"

#include <gtest/gtest.h>

#include "api/error.h"
#include "support/tile_store_files.h"

namespace lodbench::test {
namespace {

TEST(ServedTerrain, counts_what_is_delivered_through_it_alone) {
    const std::shared_ptr<const terrain::HeightField> field(
        new terrain::HeightField(rough_field(129, 129, 1)));
    const run::ServedTerrain served(field);
    EXPECT_EQ(served.info().checksum, field->info().checksum);
    std::vector<float> tile(kTileSampleCount), same(kTileSampleCount), block(6), equal(6);
    served.read_tile({1, 0, 0}, tile);
    field->read_tile({1, 0, 0}, same);
    EXPECT_EQ(tile, same);
    served.read({5, 7, 2, 3}, block);
    field->read({5, 7, 2, 3}, equal);
    EXPECT_EQ(block, equal);
    EXPECT_EQ(served.tiles_served(), 1U);
    EXPECT_EQ(served.samples_served(), 65U * 65 + 6);
    EXPECT_EQ(served.bytes_read(), 0U) << "it lies in memory";

    EXPECT_THROW(served.read_tile({0, 2, 0}, tile), ContractError);
    EXPECT_THROW(served.read({128, 0, 2, 3}, block), ContractError);
    EXPECT_EQ(served.tile_summary({0, 1, 1}).max_height, field->tile_summary({0, 1, 1}).max_height);
    EXPECT_EQ(served.tiles_served(), 1U) << "summaries serve nothing";
    EXPECT_EQ(served.samples_served(), 65U * 65 + 6) << "what is refused is not served";
}

TEST(ServedTerrain, says_what_its_store_read_for_it) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "a.tiles";
    terrain::write_store(rough_field(129, 129, 1), 0.5, file);
    const auto own = std::make_shared<terrain::StoredTerrain>(file);
    const terrain::StoredTerrain other(file);
    const run::ServedTerrain served(own);
    std::vector<float> tile(kTileSampleCount);
    other.read_tile({0, 0, 0}, tile);
    EXPECT_EQ(served.bytes_read(), 0U);
    served.read_tile({0, 0, 0}, tile);
    EXPECT_EQ(served.bytes_read(), 65U * 65 * 2);
}

}  // namespace
}  // namespace lodbench::test
