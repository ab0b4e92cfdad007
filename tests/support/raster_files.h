#pragma once
// Small rasters written byte by byte, so that what an importer reads is known without an importer's
// help.

#include <unistd.h>

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace lodbench::test {

/// A folder of its own that goes away with the object.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "lodbench-XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    std::filesystem::path write(const std::string& name, std::string_view bytes) const {
        std::ofstream(path_ / name, std::ios::binary) << bytes;
        return path_ / name;
    }

private:
    std::filesystem::path path_;
};

/// Bytes in one order.
class Bytes {
public:
    explicit Bytes(bool big_endian) : big_endian_(big_endian) {}
    Bytes& number(std::uint64_t value, int size) {
        for (int i = 0; i < size; ++i) {
            text_ += char(value >> (8 * (big_endian_ ? size - 1 - i : i)));
        }
        return *this;
    }
    Bytes& real32(float value) { return number(std::bit_cast<std::uint32_t>(value), 4); }
    Bytes& real64(double value) { return number(std::bit_cast<std::uint64_t>(value), 8); }
    Bytes& text(std::string_view text) {
        text_ += text;
        return *this;
    }
    [[nodiscard]] const std::string& str() const { return text_; }

private:
    bool big_endian_;
    std::string text_;
};

/// 16-bit samples packed.
inline std::string packed16(const std::vector<int>& samples, bool big_endian) {
    Bytes bytes(big_endian);
    for (const int sample : samples) bytes.number(std::uint64_t(std::uint16_t(sample)), 2);
    return bytes.str();
}

/// CRC-32 of PNG chunks.
inline std::uint32_t crc32(std::string_view bytes) {
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const unsigned char byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0);
    }
    return ~crc;
}

/// PNG of stored (uncompressed) blocks. `rows` holds each row's packed bytes.
inline std::string png(std::uint32_t width, std::uint32_t height, int bit_depth, int colour_type,
                       const std::vector<std::string>& rows) {
    std::string file = "\x89PNG\r\n\x1a\n";
    const auto chunk = [&](std::string_view type, const std::string& data) {
        const std::string body = std::string(type) + data;
        file += Bytes(true).number(data.size(), 4).text(body).number(crc32(body), 4).str();
    };
    chunk("IHDR", Bytes(true)
                      .number(width, 4)
                      .number(height, 4)
                      .number(std::uint64_t(bit_depth), 1)
                      .number(std::uint64_t(colour_type), 1)
                      .number(0, 3)
                      .str());
    std::string raw;
    for (const std::string& row : rows) raw += std::string(1, '\0') + row;
    std::uint32_t a = 1;
    std::uint32_t b = 0;
    for (const unsigned char byte : raw) {
        a = (a + byte) % 65521;
        b = (b + a) % 65521;
    }
    chunk("IDAT", "\x78\x01" +
                      Bytes(false)
                          .number(1, 1)
                          .number(raw.size(), 2)
                          .number(~raw.size() & 0xFFFF, 2)
                          .text(raw)
                          .str() +
                      Bytes(true).number(b << 16 | a, 4).str());
    chunk("IEND", "");
    return file;
}

/// A little-endian TIFF of one strip. Sample formats: 1 unsigned, 2 signed, 3 float.
class Tiff {
public:
    Tiff(int width, int height, int bits, int sample_format, std::string samples)
        : samples_(std::move(samples)) {
        const auto strip_bytes = std::uint64_t(samples_.size());
        for (const auto& [tag, value] : std::initializer_list<std::pair<int, std::uint64_t>>{
                 {256, std::uint64_t(width)},
                 {257, std::uint64_t(height)},
                 {258, std::uint64_t(bits)},
                 {259, 1},
                 {262, 1},
                 {273, 8},
                 {277, 1},
                 {278, std::uint64_t(height)},
                 {279, strip_bytes},
                 {339, std::uint64_t(sample_format)}}) {
            add(tag, 4, 1, Bytes(false).number(value, 4).str());
        }
    }
    Tiff& doubles(int tag, const std::vector<double>& values) {
        Bytes bytes(false);
        for (const double value : values) bytes.real64(value);
        return add(tag, 12, values.size(), bytes.str());
    }
    Tiff& shorts(int tag, const std::vector<int>& values) {
        return add(tag, 3, values.size(), packed16(values, false));
    }
    Tiff& ascii(int tag, const std::string& text) {
        return add(tag, 2, text.size() + 1, text + '\0');
    }
    /// Pixels of `spacing`, the north-west corner at (west, north); geographic WGS 84 or UTM zone
    /// 11 N.
    Tiff& place(double spacing, double west, double north, bool geographic) {
        doubles(33550, {spacing, spacing, 0});
        doubles(33922, {0, 0, 0, west, north, 0});
        return keys(geographic);
    }
    Tiff& keys(bool geographic) {
        return shorts(34735, geographic ? std::vector<int>{1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, 1,
                                                           2048, 0, 1, 4326}
                                        : std::vector<int>{1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1,
                                                           3072, 0, 1, 32611});
    }
    /// A mask in a second directory: a byte a sample, 0 where there is no data.
    Tiff& mask(std::string bytes) {
        mask_ = std::move(bytes);
        return *this;
    }
    [[nodiscard]] std::string str() const {
        std::string strip = samples_;
        if (strip.size() % 2 != 0) strip += '\0';
        const std::uint64_t directory = 8 + strip.size();
        std::uint64_t heap = directory + 2 + entries_.size() * 12 + 4;
        Bytes file(false);
        file.text("II").number(42, 2).number(directory, 4).text(strip).number(entries_.size(), 2);
        std::string tail;
        for (const Entry& entry : entries_) {
            file.number(std::uint64_t(entry.tag), 2)
                .number(std::uint64_t(entry.type), 2)
                .number(entry.count, 4);
            std::string data = entry.data;
            if (data.size() <= 4) {
                data.resize(4, '\0');
                file.text(data);
            } else {
                if (data.size() % 2 != 0) data += '\0';
                file.number(heap + tail.size(), 4);
                tail += data;
            }
        }
        std::string whole = file.number(0, 4).text(tail).str();
        if (!mask_.empty()) append_mask(whole, directory + 2 + entries_.size() * 12);
        return whole;
    }

private:
    struct Entry {
        int tag;
        int type;
        std::uint64_t count;
        std::string data;
    };
    Tiff& add(int tag, int type, std::uint64_t count, std::string data) {
        // Tags ascend in a directory.
        auto place = entries_.begin();
        while (place != entries_.end() && place->tag < tag) ++place;
        entries_.insert(place, {tag, type, count, std::move(data)});
        return *this;
    }
    /// `link`: where the offset of the next directory stands.
    void append_mask(std::string& file, std::uint64_t link) const {
        const std::uint64_t strip = file.size();
        file += mask_;
        if (file.size() % 2 != 0) file += '\0';
        file.replace(link, 4, Bytes(false).number(file.size(), 4).str());
        Bytes directory(false);
        directory.number(11, 2);
        const auto size = [this](int tag) {
            for (const Entry& entry : entries_) {
                if (entry.tag == tag) return entry.data;
            }
            return std::string(4, '\0');
        };
        const auto value = [&](int tag, std::uint64_t number) {
            directory.number(std::uint64_t(tag), 2).number(4, 2).number(1, 4).number(number, 4);
        };
        value(254, 4);  // a mask
        for (const int tag : {256, 257}) {
            directory.number(std::uint64_t(tag), 2).number(4, 2).number(1, 4).text(size(tag));
        }
        value(258, 8);
        value(259, 1);
        value(262, 4);  // a mask
        value(273, strip);
        value(277, 1);
        directory.number(278, 2).number(4, 2).number(1, 4).text(size(257));
        value(279, mask_.size());
        value(339, 1);
        file += directory.number(0, 4).str();
    }
    std::string samples_;
    std::string mask_;
    std::vector<Entry> entries_;
};

/// OpenEXR, one float channel, scan lines, no compression.
inline std::string exr(int width, int height, const std::vector<float>& samples) {
    Bytes header(false);
    const auto attribute = [&header](const char* name, const char* type, const std::string& value) {
        header.text(name).number(0, 1).text(type).number(0, 1).number(value.size(), 4).text(value);
    };
    const std::string box = Bytes(false)
                                .number(0, 8)
                                .number(std::uint64_t(width - 1), 4)
                                .number(std::uint64_t(height - 1), 4)
                                .str();
    header.number(20000630, 4).number(2, 4);
    attribute("channels", "chlist",
              Bytes(false)
                  .text("Y")
                  .number(0, 1)
                  .number(2, 4)
                  .number(0, 4)
                  .number(1, 4)
                  .number(1, 4)
                  .number(0, 1)
                  .str());
    attribute("compression", "compression", std::string(1, '\0'));
    attribute("dataWindow", "box2i", box);
    attribute("displayWindow", "box2i", box);
    attribute("lineOrder", "lineOrder", std::string(1, '\0'));
    attribute("pixelAspectRatio", "float", Bytes(false).real32(1).str());
    attribute("screenWindowCenter", "v2f", Bytes(false).number(0, 8).str());
    attribute("screenWindowWidth", "float", Bytes(false).real32(1).str());
    header.number(0, 1);
    const auto line = std::uint64_t(width) * 4;
    const std::uint64_t first = header.str().size() + std::uint64_t(height) * 8;
    Bytes file(false);
    file.text(header.str());
    for (int row = 0; row < height; ++row) file.number(first + std::uint64_t(row) * (line + 8), 8);
    for (int row = 0; row < height; ++row) {
        file.number(std::uint64_t(row), 4).number(line, 4);
        for (int column = 0; column < width; ++column) {
            file.real32(samples[std::size_t(row * width + column)]);
        }
    }
    return file.str();
}

}  // namespace lodbench::test
