// All samples of a store, mapped: the same as in memory, and no more of them resident than asked.
#include "terrain/mapped_terrain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <fstream>

#include "base/files.h"
#include "sanitizers/sanitizers.h"
#include "support/fake_terrain.h"
#include "support/run_lodbench.h"
#include "support/tile_store_files.h"
#include "terrain/open_terrain.h"
#include "terrain/tile_store.h"
#include "terrain/tile_store_writer.h"

namespace lodbench::test {
namespace {

using terrain::MappedTerrain;
using terrain::StoredTerrain;
using testing::HasSubstr;

class Mapped : public testing::Test {
protected:
    [[nodiscard]] std::shared_ptr<const Terrain> store(int rows, int columns) {
        const terrain::HeightField field = rough_field(rows, columns, 8);
        terrain::write_store(field, std::nullopt, file());
        return std::make_shared<const StoredTerrain>(file());
    }
    [[nodiscard]] fs::path file() const { return folder_.path() / "a.tiles"; }
    ScratchFolder folder_;
};

std::int64_t resident_of_files() {
    std::ifstream statm("/proc/self/statm");
    std::int64_t whole = 0, resident = 0, of_files = 0;
    statm >> whole >> resident >> of_files;
    return of_files * 4096;
}

TEST_F(Mapped, samples_are_those_of_the_store_whatever_its_size) {
    for (const auto& [rows, columns] : {std::pair{2, 3}, {65, 65}, {66, 129}, {150, 100}}) {
        const auto stored = store(rows, columns);
        const MappedTerrain mapped(stored, folder_.path());
        const auto whole = terrain::whole_field(stored);
        EXPECT_TRUE(same_bits(mapped.samples(), whole->samples())) << rows << " x " << columns;
        EXPECT_EQ(mapped.info().checksum, whole->info().checksum);
        expect_equal(mapped, *whole);
        mapped.forget();
        EXPECT_TRUE(same_bits(mapped.samples(), whole->samples()));
    }
}

TEST_F(Mapped, leaves_nothing_in_the_folder) {
    const MappedTerrain mapped(store(100, 100), folder_.path());
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "the store alone";
}

TEST_F(Mapped, forgets_what_is_more_than_asked) {
    if (kAddressSanitizer || kThreadSanitizer) GTEST_SKIP() << "shadow memory counts as files'";
    constexpr std::int64_t kMost = 1 << 20;
    const MappedTerrain mapped(store(1500, 1500), folder_.path(), kMost);  // 9 MB
    const std::int64_t before = resident_of_files();
    std::int64_t most = 0;
    float highest = 0;
    for (std::size_t first = 0; first < mapped.samples().size(); first += 15000) {
        const auto part = mapped.samples().subspan(first, 15000);
        highest = std::max(highest, *std::ranges::max_element(part));
        most = std::max(most, resident_of_files() - before);
        mapped.forget();
    }
    EXPECT_EQ(highest, mapped.info().max_height);
    // The part that was read last, and what the system maps around it.
    EXPECT_LT(most, kMost + (512 << 10));
}

TEST_F(Mapped, a_damaged_tile_and_a_grid_of_another_checksum_are_refused) {
    (void)store(150, 100);
    std::fstream(file(), std::ios::in | std::ios::out | std::ios::binary).seekp(-4, std::ios::end)
        << "bad!";
    const auto damaged = std::make_shared<const StoredTerrain>(file());
    EXPECT_THROW(MappedTerrain(damaged, folder_.path()), TerrainError);

    class OtherChecksum final : public FakeTerrain {
    public:
        OtherChecksum() : FakeTerrain(70, 70) { info_.checksum = "0123456789abcdef"; }
    };
    try {
        const MappedTerrain mapped(std::make_shared<const OtherChecksum>(), folder_.path());
        ADD_FAILURE();
    } catch (const TerrainError& error) {
        EXPECT_THAT(error.what(), HasSubstr("expected 0123456789abcdef"));
    }
}

TEST_F(Mapped, a_disk_without_room_is_told_before_anything_is_read) {
    const auto stored = store(150, 100);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{1000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    std::string words;
    try {
        const MappedTerrain mapped(stored, folder_.path());
    } catch (const base::DiskFullError& error) {
        words = error.what();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(words, folder_.path().string() +
                         ": a scratch file of 0 MiB for the samples of terrain 'rough' cannot be "
                         "made: File too large; free the room, or do not measure (--no-truth)");
    EXPECT_EQ(stored->bytes_read(), 0U);
}

}  // namespace
}  // namespace lodbench::test
