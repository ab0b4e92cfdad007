// Rasters that need no library: raw samples with a sidecar, and binary PGM.

#include <fmt/format.h>

#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <vector>

#include "api/error.h"
#include "terrain/raster_reader.h"

namespace lodbench::terrain {
namespace {

enum class Encoding { uint8, int16, uint16, float32 };

std::size_t bytes_of(Encoding encoding) {
    switch (encoding) {
        case Encoding::uint8: return 1;
        case Encoding::float32: return 4;
        default: return 2;
    }
}

/// Samples of one type, packed, from an offset to the end of the file.
class PackedReader final : public RasterReader {
public:
    PackedReader(const std::filesystem::path& file, RasterDescription description,
                 Encoding encoding, bool big_endian, std::uint64_t offset)
        : file_(file),
          stream_(file, std::ios::binary),
          encoding_(encoding),
          big_endian_(big_endian) {
        description_ = std::move(description);
        if (encoding != Encoding::float32) {
            const double values = std::exp2(8 * int(bytes_of(encoding)));
            description_.integers = encoding == Encoding::int16
                                        ? std::pair{-values / 2, values / 2 - 1}
                                        : std::pair{0.0, values - 1};
        }
        check_raster_size(file, description_.rows, description_.columns);
        const std::uint64_t expected = offset + std::uint64_t(description_.rows) *
                                                    std::uint64_t(description_.columns) *
                                                    bytes_of(encoding);
        const std::uint64_t found = std::filesystem::file_size(file);
        if (found != expected) {
            throw InputError(fmt::format(
                "{}: {} bytes, but {} rows x {} columns of {} bytes{} make {}; the file is {} or "
                "its "
                "size is given wrongly",
                file.string(), found, description_.rows, description_.columns, bytes_of(encoding),
                offset > 0 ? fmt::format(" after a header of {}", offset) : "", expected,
                found < expected ? "truncated" : "too long"));
        }
        stream_.seekg(std::streamoff(offset));
        bytes_.resize(std::size_t(description_.columns) * bytes_of(encoding));
    }

    void read_row(int row, std::span<double> values) override {
        stream_.read(reinterpret_cast<char*>(bytes_.data()), std::streamsize(bytes_.size()));
        if (!stream_) {
            throw InputError(fmt::format("{}: row {} cannot be read", file_.string(), row));
        }
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = value(i);
    }

private:
    [[nodiscard]] double value(std::size_t index) const {
        const std::size_t size = bytes_of(encoding_);
        std::uint32_t bits = 0;
        for (std::size_t byte = 0; byte < size; ++byte) {
            const std::size_t place = big_endian_ ? byte : size - 1 - byte;
            bits = bits << 8 | bytes_[index * size + place];
        }
        switch (encoding_) {
            case Encoding::int16: return std::int16_t(bits);
            case Encoding::float32: return std::bit_cast<float>(bits);
            default: return bits;
        }
    }

    std::filesystem::path file_;
    std::ifstream stream_;
    Encoding encoding_;
    bool big_endian_;
    std::vector<std::uint8_t> bytes_;
};

/// The header of a PGM: "P5", width, height, maximal value, apart by white space and comments, then
/// one byte of white space.
class PgmHeader {
public:
    explicit PgmHeader(const std::filesystem::path& file)
        : file_(file), stream_(file, std::ios::binary) {
        char magic[2] = {};
        stream_.read(magic, 2);
        if (!stream_ || magic[0] != 'P' || magic[1] != '5') {
            throw InputError(
                fmt::format("{}: not a binary PGM (it does not begin with P5); convert it to one",
                            file.string()));
        }
        columns = number("width");
        rows = number("height");
        maximum = number("maximal value");
        if (maximum < 1 || maximum > 65535) {
            throw InputError(
                fmt::format("{}: maximal value {}; a PGM has 1 to 65535", file.string(), maximum));
        }
        offset = std::uint64_t(stream_.tellg()) + 1;
    }

    std::int64_t columns = 0;
    std::int64_t rows = 0;
    std::int64_t maximum = 0;
    std::uint64_t offset = 0;

private:
    std::int64_t number(const char* what) {
        int c = stream_.get();
        while (std::isspace(c) != 0 || c == '#') {
            if (c == '#') {
                while (c != '\n' && c != EOF) c = stream_.get();
            } else {
                c = stream_.get();
            }
        }
        std::string digits;
        for (; std::isdigit(c) != 0 && digits.size() < 18; c = stream_.get()) digits += char(c);
        if (digits.empty() || c == EOF) {
            throw InputError(
                fmt::format("{}: the PGM header ends before its {}", file_.string(), what));
        }
        stream_.unget();
        std::int64_t value = 0;
        std::from_chars(digits.data(), digits.data() + digits.size(), value);
        return value;
    }

    const std::filesystem::path& file_;
    std::ifstream stream_;
};

}  // namespace

std::unique_ptr<RasterReader> open_raw(const std::filesystem::path& file, const Sidecar& sidecar) {
    const std::filesystem::path toml = sidecar_path(file);
    if (sidecar.file.empty()) {
        throw InputError(
            fmt::format("{}: a raw file needs {} beside it, with rows, columns, type and endian",
                        file.string(), toml.string()));
    }
    const auto need = [&toml](bool given, const char* key) {
        if (!given) {
            throw InputError(
                fmt::format("{}: {} is missing; a raw file needs rows, columns, type "
                            "(int16, uint16, float32) and endian (little, big)",
                            toml.string(), key));
        }
    };
    need(sidecar.rows.has_value(), "rows");
    need(sidecar.columns.has_value(), "columns");
    need(sidecar.type.has_value(), "type");
    need(sidecar.big_endian.has_value(), "endian");
    RasterDescription description;
    description.rows = *sidecar.rows;
    description.columns = *sidecar.columns;
    Encoding encoding = Encoding::float32;
    std::string type = "float32";
    if (*sidecar.type != SampleType::float32) {
        const bool is_signed = *sidecar.type == SampleType::int16;
        encoding = is_signed ? Encoding::int16 : Encoding::uint16;
        type = is_signed ? "int16" : "uint16";
    }
    description.kind =
        fmt::format("raw, {}, {} endian", type, *sidecar.big_endian ? "big" : "little");
    return std::make_unique<PackedReader>(file, description, encoding, *sidecar.big_endian, 0);
}

std::unique_ptr<RasterReader> open_pgm(const std::filesystem::path& file) {
    const PgmHeader header(file);
    check_raster_size(file, header.rows, header.columns);
    RasterDescription description;
    description.rows = int(header.rows);
    description.columns = int(header.columns);
    const bool wide = header.maximum > 255;
    description.kind =
        fmt::format("PGM, {}, maximum {}", wide ? "uint16" : "uint8", header.maximum);
    return std::make_unique<PackedReader>(
        file, description, wide ? Encoding::uint16 : Encoding::uint8, true, header.offset);
}

}  // namespace lodbench::terrain
