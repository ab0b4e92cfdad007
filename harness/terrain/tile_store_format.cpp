#include "terrain/tile_store_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

#include "api/error.h"

namespace lodbench::terrain {
namespace {

constexpr std::string_view kMagic = "LODTILES";
constexpr std::uint32_t kByteOrder = 0x01020304;

// Offsets of the fields.
constexpr std::size_t kName = 160;
constexpr std::size_t kLevelTable = 416;
constexpr std::size_t kLevelBytes = 16;
constexpr std::size_t kUnused = kLevelTable + kMaxStoreLevels * kLevelBytes;
constexpr std::size_t kChecksum = kStoreHeaderBytes - 8;

template <typename T>
using BitsOf = std::conditional_t<sizeof(T) == 8, std::uint64_t,
                                  std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint16_t>>;

/// Little-endian on any machine; compilers make one move of it.
template <typename T>
void put(std::byte* place, T value) {
    const auto bits = std::bit_cast<BitsOf<T>>(value);
    for (std::size_t byte = 0; byte < sizeof(T); ++byte) place[byte] = std::byte(bits >> 8 * byte);
}

template <typename T>
T get(const std::byte* place) {
    BitsOf<T> bits = 0;
    for (std::size_t byte = 0; byte < sizeof(T); ++byte) {
        bits = BitsOf<T>(bits | BitsOf<T>(BitsOf<T>(place[byte]) << 8 * byte));
    }
    return std::bit_cast<T>(bits);
}

constexpr const char* kRemedy = "the file is damaged or was not written by lodbench; build it anew";

/// Reads fields and says which of them is wrong.
class Fields {
public:
    Fields(std::span<const std::byte> bytes, std::string what)
        : bytes_(bytes), what_(std::move(what)) {}

    template <typename T>
    [[nodiscard]] T at(std::size_t offset) const {
        return get<T>(bytes_.data() + offset);
    }
    template <typename T>
    T within(const char* field, std::size_t offset, T least, T greatest) const {
        const T value = at<T>(offset);
        // So that NaN fails.
        if (!(value >= least && value <= greatest)) {
            refuse(field, value, fmt::format("{} to {}", least, greatest));
        }
        return value;
    }
    template <typename T>
    void equal(const std::string& field, std::size_t offset, T expected) const {
        const T value = at<T>(offset);
        if (value != expected) refuse(field, value, fmt::format("{}", expected));
    }
    template <typename T>
    [[noreturn]] void refuse(const std::string& field, T found, const std::string& expected) const {
        throw InputError(
            fmt::format("{}: {} is {}, expected {}; {}", what_, field, found, expected, kRemedy));
    }

private:
    std::span<const std::byte> bytes_;
    std::string what_;
};

std::uint64_t hex_value(const std::string& hex) {
    std::uint64_t value = 0;
    std::from_chars(hex.data(), hex.data() + hex.size(), value, 16);
    return value;
}

/// What tells that this is a store that can be read at all.
void check_kind(const Fields& fields, std::span<const std::byte> bytes,
                const std::filesystem::path& file) {
    if (std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0) {
        throw InputError(
            fmt::format("{}: not a tiled store (it does not begin with {}); `lodbench terrain "
                        "import` makes one",
                        file.string(), kMagic));
    }
    const auto order = fields.at<std::uint32_t>(8);
    if (order == 0x04030201) {
        throw InputError(
            fmt::format("{}: its bytes are in the wrong order (big-endian); a store is "
                        "little-endian, build it anew",
                        file.string()));
    }
    fields.equal("the mark of the byte order", 8, kByteOrder);
    const auto version = fields.at<std::uint32_t>(12);
    if (version != kStoreVersion) {
        throw InputError(
            fmt::format("{}: a store of version {}, this lodbench reads version {}; build it anew "
                        "with this one",
                        file.string(), version, kStoreVersion));
    }
}

StoreSampling decode_sampling(const Fields& fields) {
    StoreSampling sampling;
    sampling.type = StoreSamples(fields.within<std::uint32_t>("the type of samples", 64, 1, 2));
    if (sampling.type == StoreSamples::float32) {
        fields.equal("the step", 72, 0.0);
        fields.equal<std::int64_t>("the lowest height in steps", 80, 0);
    } else {
        sampling.step = fields.within("the step", 72, kLeastStep, kGreatestStep);
        sampling.lowest = fields.within("the lowest height in steps", 80, -kMostSteps, kMostSteps);
    }
    return sampling;
}

void check_layout(const Fields& fields, const StoreLayout& layout) {
    const TilePyramid& pyramid = layout.pyramid();
    fields.equal("the number of levels", 68, std::uint32_t(pyramid.levels()));
    fields.equal<std::uint64_t>("the offset of the index", 112, kStoreHeaderBytes);
    fields.equal<std::uint64_t>("the number of tiles", 120, pyramid.count());
    fields.equal<std::uint64_t>("the offset of the tiles", 128, layout.data_offset());
    fields.equal<std::uint64_t>("the size of a record", 136, layout.record_bytes());
    fields.equal<std::uint64_t>("the size of the file", 144, layout.file_bytes());
    for (int level = 0; level < kMaxStoreLevels; ++level) {
        const bool exists = level < pyramid.levels();
        const std::size_t place = kLevelTable + std::size_t(level) * kLevelBytes;
        const std::string of = fmt::format(" of level {}", level);
        fields.equal("the rows of tiles" + of, place,
                     std::uint32_t(exists ? pyramid.rows(level) : 0));
        fields.equal("the columns of tiles" + of, place + 4,
                     std::uint32_t(exists ? pyramid.columns(level) : 0));
        fields.equal("the first tile" + of, place + 8, exists ? layout.tiles_before(level) : 0);
    }
}

}  // namespace

bool is_store(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    return extension == ".tiles";
}

std::string StoreSampling::text() const {
    return type == StoreSamples::float32 ? "float32" : fmt::format("uint16, steps of {} m", step);
}

std::uint64_t z_rank(int row, int column, int rows, int columns) {
    std::uint64_t rank = 0;
    int north = 0;
    int west = 0;
    const auto existing = [&](int first_row, int first_column, int side) {
        return std::uint64_t(std::clamp(rows - first_row, 0, side)) *
               std::uint64_t(std::clamp(columns - first_column, 0, side));
    };
    for (int side = int(std::bit_ceil(unsigned(std::max(rows, columns)))) / 2; side > 0;
         side /= 2) {
        if (row >= north + side) {
            rank += existing(north, west, side) + existing(north, west + side, side);
            north += side;
        }
        if (column >= west + side) {
            rank += existing(north, west, side);
            west += side;
        }
    }
    return rank;
}

StoreLayout::StoreLayout(int rows, int columns, const StoreSampling& sampling)
    : pyramid_(rows, columns), record_bytes_(sampling.record_bytes()) {
    std::uint64_t before = 0;
    for (int level = pyramid_.levels() - 1; level >= 0; --level) {
        before_[std::size_t(level)] = before;
        before += std::uint64_t(pyramid_.rows(level)) * std::uint64_t(pyramid_.columns(level));
    }
}

std::uint64_t StoreLayout::offset(const TileId& tile) const {
    const std::uint64_t place =
        tiles_before(tile.level) +
        z_rank(tile.row, tile.column, pyramid_.rows(tile.level), pyramid_.columns(tile.level));
    return data_offset() + place * record_bytes_;
}

std::array<std::byte, kStoreHeaderBytes> encode_header(const StoreHeader& header) {
    const TerrainInfo& info = header.info;
    if (info.name.size() > kStoreNameBytes) {
        throw InputError(fmt::format("terrain '{}': a name of {} bytes; a store holds {}",
                                     info.name, info.name.size(), kStoreNameBytes));
    }
    const StoreLayout layout(info.rows, info.columns, header.sampling);
    const TilePyramid& pyramid = layout.pyramid();
    std::array<std::byte, kStoreHeaderBytes> bytes{};
    const auto set = [&](std::size_t offset, auto value) { put(bytes.data() + offset, value); };
    std::memcpy(bytes.data(), kMagic.data(), kMagic.size());
    set(8, kByteOrder);
    set(12, kStoreVersion);
    set(16, std::uint32_t(kStoreHeaderBytes));
    set(20, std::uint32_t(kTileSamples));
    set(24, std::uint32_t(info.rows));
    set(28, std::uint32_t(info.columns));
    set(32, info.spacing.x);
    set(40, info.spacing.y);
    set(48, info.origin.x);
    set(56, info.origin.y);
    set(64, std::uint32_t(header.sampling.type));
    set(68, std::uint32_t(pyramid.levels()));
    set(72, header.sampling.step);
    set(80, header.sampling.lowest);
    set(88, info.min_height);
    set(92, info.max_height);
    set(96, info.void_count);
    set(104, hex_value(info.checksum));
    set(112, std::uint64_t(kStoreHeaderBytes));
    set(120, std::uint64_t(pyramid.count()));
    set(128, layout.data_offset());
    set(136, std::uint64_t(layout.record_bytes()));
    set(144, layout.file_bytes());
    set(152, std::uint32_t(info.name.size()));
    std::memcpy(bytes.data() + kName, info.name.data(), info.name.size());
    for (int level = 0; level < pyramid.levels(); ++level) {
        const std::size_t place = kLevelTable + std::size_t(level) * kLevelBytes;
        set(place, std::uint32_t(pyramid.rows(level)));
        set(place + 4, std::uint32_t(pyramid.columns(level)));
        set(place + 8, layout.tiles_before(level));
    }
    return bytes;
}

void set_checksum(std::span<std::byte, kStoreHeaderBytes> header, std::uint64_t checksum) {
    put(header.data() + kChecksum, checksum);
}

StoreHeader decode_header(std::span<const std::byte, kStoreHeaderBytes> bytes,
                          std::uint64_t file_bytes, const std::filesystem::path& file) {
    const Fields fields(bytes, file.string());
    check_kind(fields, bytes, file);
    fields.equal("the size of the header", 16, std::uint32_t(kStoreHeaderBytes));
    fields.equal("the number of samples along a tile", 20, std::uint32_t(kTileSamples));
    constexpr std::uint32_t kMostSamples = 1U << 30U;
    StoreHeader header;
    TerrainInfo& info = header.info;
    info.rows = int(fields.within("the number of rows", 24, 2U, kMostSamples));
    info.columns = int(fields.within("the number of columns", 28, 2U, kMostSamples));
    constexpr double kLeast = 1e-9;
    constexpr double kGreatest = 1e12;
    info.spacing.x = fields.within("the spacing (x)", 32, kLeast, kGreatest);
    info.spacing.y = fields.within("the spacing (y)", 40, kLeast, kGreatest);
    constexpr double kMost = std::numeric_limits<double>::max();
    info.origin.x = fields.within("the origin (x)", 48, -kMost, kMost);
    info.origin.y = fields.within("the origin (y)", 56, -kMost, kMost);
    header.sampling = decode_sampling(fields);
    check_layout(fields, StoreLayout(info.rows, info.columns, header.sampling));
    constexpr float kMostHeight = std::numeric_limits<float>::max();
    info.min_height = fields.within("the lowest height", 88, -kMostHeight, kMostHeight);
    info.max_height = fields.within("the highest height", 92, info.min_height, kMostHeight);
    info.void_count = fields.within<std::uint64_t>(
        "the number of voids", 96, 0, std::uint64_t(info.rows) * std::uint64_t(info.columns));
    info.checksum = fmt::format("{:016x}", fields.at<std::uint64_t>(104));
    const auto name_bytes =
        fields.within<std::uint32_t>("the length of the name", 152, 0, kStoreNameBytes);
    info.name.assign(reinterpret_cast<const char*>(bytes.data()) + kName, name_bytes);
    fields.equal<std::uint32_t>("the field at byte 156", 156, 0);
    const auto zeros = [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i) {
            if (bytes[i] == std::byte{}) continue;
            fields.refuse(fmt::format("the byte at {}", i), int(bytes[i]), "0");
        }
    };
    zeros(kName + name_bytes, kLevelTable);
    zeros(kUnused, kChecksum);
    header.checksum = fields.at<std::uint64_t>(kChecksum);
    const std::uint64_t expected = fields.at<std::uint64_t>(144);
    if (file_bytes != expected) {
        throw InputError(fmt::format(
            "{}: {} bytes, its header says {}; it is {}, fetch or build it anew", file.string(),
            file_bytes, expected, file_bytes < expected ? "truncated" : "too long"));
    }
    return header;
}

void encode_entry(const IndexEntry& entry, std::span<std::byte, kIndexEntryBytes> bytes) {
    put(bytes.data(), entry.offset);
    put(bytes.data() + 8, entry.checksum);
    put(bytes.data() + 16, entry.summary.min_height);
    put(bytes.data() + 20, entry.summary.max_height);
    put(bytes.data() + 24, entry.summary.midpoint_error);
    put(bytes.data() + 28, std::uint32_t(0));
}

IndexEntry decode_entry(std::span<const std::byte, kIndexEntryBytes> bytes, const TileId& tile,
                        const StoreLayout& layout, const std::filesystem::path& file) {
    // The name of the tile is text: made only where it is needed.
    const auto checked = [&](const Fields& fields) {
        constexpr float kMost = std::numeric_limits<float>::max();
        IndexEntry entry;
        fields.equal("the offset", 0, layout.offset(tile));
        entry.offset = fields.at<std::uint64_t>(0);
        entry.checksum = fields.at<std::uint64_t>(8);
        entry.summary.min_height = fields.within("the lowest height", 16, -kMost, kMost);
        entry.summary.max_height =
            fields.within("the highest height", 20, entry.summary.min_height, kMost);
        entry.summary.midpoint_error = fields.within("the midpoint error", 24, 0.0F, kMost);
        fields.equal<std::uint32_t>("the field at byte 28", 28, 0);
        return entry;
    };
    try {
        return checked(Fields(bytes, {}));
    } catch (const InputError&) {
        return checked(Fields(bytes, fmt::format("{}: {}", file.string(), name_of(tile))));
    }
}

void encode_tile(std::span<const float> heights, const StoreSampling& sampling,
                 std::span<std::byte> record) {
    std::byte* place = record.data();
    if (sampling.type == StoreSamples::float32) {
        for (const float height : heights) {
            put(place, height);
            place += 4;
        }
        return;
    }
    for (const float height : heights) {
        // Exact: heights are multiples of the step that float32 tells apart. Added to 1.5 * 2^52 a
        // number is rounded to a whole one, of which the last bits of the sum are the last bits.
        const double sum = double(height) / sampling.step + kRounding;
        put(place, std::uint16_t(std::bit_cast<std::uint64_t>(sum)));
        place += 2;
    }
}

void decode_tile(std::span<const std::byte> record, const StoreSampling& sampling,
                 std::span<float> heights) {
    const std::byte* place = record.data();
    if (sampling.type == StoreSamples::float32) {
        for (float& height : heights) {
            height = get<float>(place);
            place += 4;
        }
        return;
    }
    const auto lowest = std::uint16_t(sampling.lowest);
    const auto first = std::int32_t(sampling.lowest);  // at most kMostSteps
    for (float& height : heights) {
        const auto above = std::uint16_t(get<std::uint16_t>(place) - lowest);
        height = float(sampling.step * double(first + above));
        place += 2;
    }
}

std::string name_of(const TileId& tile) {
    return fmt::format("tile (level {}, row {}, column {})", tile.level, tile.row, tile.column);
}

}  // namespace lodbench::terrain
