// Damaged rasters and sidecars: each mutant of a good file is read or refused in one line, and
// nothing else happens. LODBENCH_MUTANTS=N tries N mutants of each file, LODBENCH_MUTATION_SEED=S
// others.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "api/error.h"
#include "support/raster_files.h"
#include "terrain/height_field.h"
#include "terrain/raster_reader.h"

namespace lodbench::terrain {
namespace {

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
    const char* text = std::getenv(name);
    return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// Knuth's MMIX multiplier: the same mutants everywhere.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::size_t below(std::size_t bound) {
        state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
        return std::size_t(state_ >> 33U) % bound;
    }

private:
    std::uint64_t state_;
};

std::string mutated(std::string bytes, Random& random) {
    static constexpr unsigned char kInteresting[] = {0,   1,   2,   7,    16,  32,  64,
                                                     127, 128, 255, '\n', ' ', '-', '"'};
    for (std::size_t edit = 1 + random.below(3); edit > 0 && !bytes.empty(); --edit) {
        const std::size_t at = random.below(bytes.size());
        const char c =
            char(random.below(2) == 0 ? random.below(256)
                                      : kInteresting[random.below(std::size(kInteresting))]);
        switch (random.below(6)) {
            case 0: bytes[at] = char(bytes[at] ^ (1 << random.below(8))); break;
            case 1: bytes.insert(at, 1 + random.below(4), c); break;
            case 2: bytes.erase(at, 1 + random.below(8)); break;
            case 3: bytes.resize(at); break;
            default: bytes[at] = c; break;
        }
    }
    return bytes;
}

/// Makes the checksums of a PNG's chunks right again, so that the mutation gets past them.
std::string with_checksums(std::string file) {
    const auto number = [&](std::size_t at) {
        std::size_t value = 0;
        for (std::size_t i = 0; i < 4; ++i)
            value = value << 8 | static_cast<unsigned char>(file[at + i]);
        return value;
    };
    for (std::size_t at = 8; at + 12 <= file.size();) {
        const std::size_t length = number(at);
        if (length > file.size() - at - 12) break;
        const std::string body = file.substr(at + 4, length + 4);
        file.replace(at + 8 + length, 4, test::Bytes(true).number(test::crc32(body), 4).str());
        at += length + 12;
    }
    return file;
}

class Mutants : public testing::Test {
protected:
    void SetUp() override {
        // Loads the modules: what follows is read in this process, many times and in the open.
        EXPECT_THROW((void)open_with_oiio("none.png"), InputError);
        EXPECT_THROW((void)open_with_gdal("none.asc"), InputError);
    }
    /// Mutates `bytes`, or the sidecar where there is one, `count` times; at least one mutant is
    /// refused.
    void expect_read_or_refused(const std::string& name, const std::string& bytes,
                                const std::string& sidecar = {}) const {
        Random random(from_environment("LODBENCH_MUTATION_SEED", 7));
        const std::uint64_t count = from_environment("LODBENCH_MUTANTS", 300);
        std::uint64_t refused = 0;
        for (std::uint64_t mutant = 0; mutant < count; ++mutant) {
            std::string changed = sidecar.empty() ? mutated(bytes, random) : bytes;
            if (name.ends_with(".png") && mutant % 4 != 0) changed = with_checksums(changed);
            TerrainSource source;
            source.file = folder_.write(name, changed);
            if (!sidecar.empty()) folder_.write(name + ".toml", mutated(sidecar, random));
            try {
                const auto field = load_terrain(source);
                for (const float height : field->samples())
                    ASSERT_TRUE(std::isfinite(height)) << mutant;
            } catch (const InputError& error) {
                ++refused;
                const std::string message = error.what();
                EXPECT_EQ(message.find(folder_.path().string()), 0U) << mutant << ": " << message;
                EXPECT_EQ(message.find('\n'), std::string::npos) << mutant << ": " << message;
            }
        }
        EXPECT_GT(refused, 0U);
    }

    test::TemporaryFolder folder_;
};

const std::vector<int> kSixteen = {0, 1, 2, 3, 100,  200,  -300, 400,
                                   5, 6, 7, 8, 1000, 1001, 1002, 1003};

TEST_F(Mutants, of_pgm) {
    expect_read_or_refused("a.pgm",
                           "P5\n# a comment\n4 4\n1000\n" + test::packed16(kSixteen, true));
}

TEST_F(Mutants, of_sidecars) {
    expect_read_or_refused(
        "a.raw", test::packed16(kSixteen, false),
        "name = \"a\"\nrows = 4\ncolumns = 4\ntype = \"int16\"\nendian = \"little\"\n"
        "spacing = [10, 20.5]\norigin = [1e3, -2]\nvertical_scale = 0.1\nno_data = -300\n");
}

#ifdef LODBENCH_WITH_OIIO
TEST_F(Mutants, of_png) {
    std::vector<std::string> rows;
    for (std::size_t row = 0; row < 4; ++row) {
        const auto first = kSixteen.begin() + std::ptrdiff_t(4 * row);
        rows.push_back(test::packed16({first, first + 4}, true));
    }
    expect_read_or_refused("a.png", test::png(4, 4, 16, 0, rows));
}

TEST_F(Mutants, of_tiff_images) {
    expect_read_or_refused("a.tif", test::Tiff(4, 4, 16, 2, test::packed16(kSixteen, false)).str());
}

TEST_F(Mutants, of_exr) {
    expect_read_or_refused("a.exr", test::exr(2, 2, {1, 2, 3, 4}));
}
#endif

#ifdef LODBENCH_WITH_GDAL
TEST_F(Mutants, of_geotiff) {
    const test::Tiff plain(4, 4, 16, 2, test::packed16(kSixteen, false));
    expect_read_or_refused("a.tif", test::Tiff(plain).place(30, 500000, 4000000, false).str());
    expect_read_or_refused(
        "b.tif", test::Tiff(plain).place(0.001, -120, 40, true).ascii(42113, "-300").str());
}

TEST_F(Mutants, of_ascii_grids) {
    expect_read_or_refused(
        "a.asc",
        "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 30\nNODATA_value -9999\n"
        "1 2 3\n4 -9999 6\n");
}
#endif

}  // namespace
}  // namespace lodbench::terrain
