#include "terrain/png_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <vector>

#include "api/error.h"

namespace lodbench::terrain {
namespace {

/// CRC-32 as in annex D of the standard.
class Crc32 {
public:
    Crc32() {
        for (std::uint32_t byte = 0; byte < 256; ++byte) {
            std::uint32_t value = byte;
            for (int bit = 0; bit < 8; ++bit) {
                value = (value & 1U) != 0 ? 0xEDB88320U ^ (value >> 1) : value >> 1;
            }
            table_[byte] = value;
        }
    }
    void begin() { state_ = 0xFFFFFFFFU; }
    void add(std::string_view bytes) {
        for (const char c : bytes) {
            state_ = table_[(state_ ^ static_cast<unsigned char>(c)) & 0xFFU] ^ (state_ >> 8);
        }
    }
    [[nodiscard]] std::uint32_t value() const { return ~state_; }

private:
    std::array<std::uint32_t, 256> table_{};
    std::uint32_t state_ = 0;
};

std::uint32_t big_endian(std::string_view bytes) {
    std::uint32_t value = 0;
    for (const char c : bytes.substr(0, 4)) value = value << 8 | static_cast<unsigned char>(c);
    return value;
}

class Walk {
public:
    explicit Walk(const std::filesystem::path& file)
        : file_(file), stream_(file, std::ios::binary), buffer_(1 << 16) {}

    PngHeader run() {
        if (take(8) != "\x89PNG\r\n\x1a\n") refuse("is no PNG (its first bytes say so)");
        PngHeader header;
        for (bool first = true;; first = false) {
            const std::uint32_t length = big_endian(take(4));
            crc_.begin();
            const std::string type(take(4));
            if (first) {
                if (type != "IHDR" || length != 13)
                    refuse("is damaged: its header chunk is missing");
                const std::string_view data = take(13);
                header = {big_endian(data), big_endian(data.substr(4)), data[8]};
                if (header.width == 0 || header.height == 0 || header.width > 0x7FFFFFFFU ||
                    header.height > 0x7FFFFFFFU) {
                    refuse(fmt::format("{} rows x {} columns are no size of a PNG", header.height,
                                       header.width));
                }
            } else {
                for (std::uint32_t left = length; left > 0;) {
                    left -= std::uint32_t(take(std::min<std::size_t>(left, buffer_.size())).size());
                }
            }
            const std::uint32_t computed = crc_.value();
            if (big_endian(take(4)) != computed) {
                refuse(fmt::format(
                    "is damaged: a chunk before byte {} has another checksum than it says",
                    std::int64_t(stream_.tellg())));
            }
            if (type == "IEND") return header;
        }
    }

private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(fmt::format("{}: {}; fetch or convert it anew", file_.string(), what));
    }

    /// The next bytes; they stay until the next call.
    std::string_view take(std::size_t count) {
        stream_.read(buffer_.data(), std::streamsize(count));
        if (!stream_) refuse("is truncated: it ends before its end chunk");
        const std::string_view bytes(buffer_.data(), count);
        crc_.add(bytes);
        return bytes;
    }

    const std::filesystem::path& file_;
    std::ifstream stream_;
    std::vector<char> buffer_;
    Crc32 crc_;
};

}  // namespace

PngHeader check_png(const std::filesystem::path& file) {
    return Walk(file).run();
}

}  // namespace lodbench::terrain
