// The only file that knows OpenImageIO: reads height maps, writes rasters of floats. The format is
// named by the extension, never guessed from the content, so that no other of its readers gets a
// stranger's bytes.

#include "terrain/readers/module.h"

#include <fmt/format.h>

#include "api/error.h"
#include "terrain/colour_heights.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <vector>

#include "terrain/png_check.h"

namespace lodbench::terrain {
namespace {

std::string one_line(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    return text.empty() ? "OpenImageIO says nothing more" : "OpenImageIO: " + text;
}

const char* format_of(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    if (extension == ".exr") return "openexr";
    return extension == ".png" ? "png" : "tiff";
}

/// `channels` are 1, or 2 where the second is alpha: NaN where that is 0.
template <typename T>
void copy_as_double(const std::vector<std::byte>& bytes, std::size_t first, int channels,
                    std::span<double> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        std::array<T, 2> pixel{T(0), T(1)};
        const std::size_t size = sizeof(T) * std::size_t(channels);
        std::memcpy(pixel.data(), bytes.data() + (first + i) * size, size);
        values[i] = pixel[1] == T(0) ? std::numeric_limits<double>::quiet_NaN() : double(pixel[0]);
    }
}

/// No compression of these formats packs more than a few thousand samples into a byte. A damaged
/// header that claims more would cost gigabytes before the first row turns out to be missing.
constexpr std::int64_t kMostSamplesPerByte = 1 << 14;

class OiioReader final : public RasterReader {
public:
    explicit OiioReader(const std::filesystem::path& file) : file_(file) {
        if (format_of(file) == std::string_view("png")) {
            const PngHeader header = check_png(file);
            check_size(header.height, header.width);
            png_bit_depth_ = header.bit_depth;
        }
        input_ = OIIO::ImageInput::create(format_of(file));
        if (!input_) {
            throw EnvironmentError(fmt::format("{}: this OpenImageIO has no reader for {}; {}",
                                               file.string(), format_of(file),
                                               one_line(OIIO::geterror())));
        }
        OIIO::ImageSpec wish;
        wish.attribute("oiio:UnassociatedAlpha", 1);  // else samples are multiplied by alpha
        if (!input_->open(file.string(), spec_, wish)) {
            refuse(fmt::format("is no {} image that can be read; {}", format_of(file),
                               one_line(input_->geterror())));
        }
        description_.masked = spec_.nchannels == 2 && spec_.alpha_channel == 1;
        if (spec_.nchannels != 1 && !description_.masked) {
            refuse(fmt::format("{} channels; a height map has one: {}", spec_.nchannels,
                               kColourHeights));
        }
        if (spec_.depth > 1) refuse("a volume; a height map is flat");
        check_size(spec_.height, spec_.width);
        description_.rows = spec_.height;
        description_.columns = spec_.width;
        choose_type();
        refuse_stretched();
        description_.kind =
            fmt::format("{}, {}, through OpenImageIO", input_->format_name(), spec_.format.c_str());
    }

    void read_row(int row, std::span<double> values) override {
        if (row >= strip_end_) read_strip(row);
        const std::size_t first = std::size_t(row - strip_begin_) * std::size_t(spec_.width);
        const int channels = spec_.nchannels;
        switch (type_.basetype) {
            case OIIO::TypeDesc::UINT8:
                return copy_as_double<std::uint8_t>(strip_, first, channels, values);
            case OIIO::TypeDesc::INT8:
                return copy_as_double<std::int8_t>(strip_, first, channels, values);
            case OIIO::TypeDesc::UINT16:
                return copy_as_double<std::uint16_t>(strip_, first, channels, values);
            case OIIO::TypeDesc::INT16:
                return copy_as_double<std::int16_t>(strip_, first, channels, values);
            case OIIO::TypeDesc::UINT32:
                return copy_as_double<std::uint32_t>(strip_, first, channels, values);
            case OIIO::TypeDesc::INT32:
                return copy_as_double<std::int32_t>(strip_, first, channels, values);
            case OIIO::TypeDesc::FLOAT:
                return copy_as_double<float>(strip_, first, channels, values);
            default: return copy_as_double<double>(strip_, first, channels, values);
        }
    }

private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(fmt::format("{}: {}", file_.string(), what));
    }

    void check_size(std::int64_t rows, std::int64_t columns) const {
        check_raster_size(file_, rows, columns);
        const auto bytes = std::int64_t(std::filesystem::file_size(file_));
        if (rows * columns / kMostSamplesPerByte > bytes) {
            refuse(
                fmt::format("{} rows x {} columns, but only {} bytes; it is damaged, fetch or "
                            "convert it anew",
                            rows, columns, bytes));
        }
    }

    void choose_type() {
        // Halves widen to float without loss; everything else is read as it lies.
        type_ = spec_.format == OIIO::TypeDesc::HALF ? OIIO::TypeDesc(OIIO::TypeDesc::FLOAT)
                                                     : spec_.format;
        static constexpr std::array kRead = {OIIO::TypeDesc::UINT8,  OIIO::TypeDesc::INT8,
                                             OIIO::TypeDesc::UINT16, OIIO::TypeDesc::INT16,
                                             OIIO::TypeDesc::UINT32, OIIO::TypeDesc::INT32,
                                             OIIO::TypeDesc::FLOAT,  OIIO::TypeDesc::DOUBLE};
        if (std::ranges::find(kRead, type_.basetype) == kRead.end()) {
            refuse(fmt::format("samples of type {}; integers of up to 32 bits and floats are read",
                               spec_.format.c_str()));
        }
        if (type_.is_floating_point()) return;
        const double values = std::exp2(8 * type_.size());
        description_.integers =
            type_.is_signed() ? std::pair{-values / 2, values / 2 - 1} : std::pair{0.0, values - 1};
    }

    /// OpenImageIO stretches samples of fewer bits than their type to the type's full range, and
    /// turns "white is zero" over. Heights must come as they were written, so these are refused.
    void refuse_stretched() const {
        int bits = spec_.get_int_attribute("oiio:BitsPerSample", int(spec_.format.size() * 8));
        if (png_bit_depth_ > 0) bits = png_bit_depth_;
        if (bits != int(spec_.format.size() * 8)) {
            refuse(fmt::format("{} bits a sample; convert it to 8 or 16", bits));
        }
        if (spec_.get_int_attribute("tiff:PhotometricInterpretation", 1) == 0) {
            refuse("white is zero in this TIFF; convert it to black is zero");
        }
    }

    void read_strip(int row) {
        const bool tiled = spec_.tile_width > 0;
        const int height = tiled ? spec_.tile_height : 64;
        strip_begin_ = row - row % height;
        strip_end_ = std::min(strip_begin_ + height, spec_.height);
        strip_.resize(std::size_t(strip_end_ - strip_begin_) * std::size_t(spec_.width) *
                      std::size_t(spec_.nchannels) * type_.size());
        const int top = spec_.y + strip_begin_;
        const int bottom = spec_.y + strip_end_;
        const bool read =
            tiled ? input_->read_tiles(0, 0, spec_.x, spec_.x + spec_.width, top, bottom, spec_.z,
                                       spec_.z + 1, 0, spec_.nchannels, type_, strip_.data())
                  : input_->read_scanlines(0, 0, top, bottom, spec_.z, 0, spec_.nchannels, type_,
                                           strip_.data());
        if (!read) {
            refuse(fmt::format("rows from {} cannot be read, the file may be truncated; {}",
                               strip_begin_, one_line(input_->geterror())));
        }
    }

    std::filesystem::path file_;
    std::unique_ptr<OIIO::ImageInput> input_;
    OIIO::ImageSpec spec_;
    OIIO::TypeDesc type_;
    std::vector<std::byte> strip_;
    int png_bit_depth_ = 0;  ///< 0: not a PNG
    int strip_begin_ = 0;
    int strip_end_ = 0;
};

}  // namespace

}  // namespace lodbench::terrain

lodbench::terrain::RasterReader* lodbench_open_raster(const std::filesystem::path& file) {
    return new lodbench::terrain::OiioReader(file);
}

void lodbench_write_exr(const lodbench::terrain::FloatRaster& raster,
                        const std::filesystem::path& file) {
    const auto refuse = [&](const std::string& words) {
        throw lodbench::EnvironmentError(fmt::format("{}: cannot be written; {}", file.string(),
                                                     lodbench::terrain::one_line(words)));
    };
    const auto output = OIIO::ImageOutput::create("openexr");
    if (!output) refuse(OIIO::geterror());
    OIIO::ImageSpec spec(raster.columns, raster.rows, int(raster.channels.size()),
                         OIIO::TypeDesc::FLOAT);
    spec.channelnames = raster.channels;
    spec.attribute("compression", "zip");
    for (const auto& [name, text] : raster.attributes) spec.attribute(name, text);
    if (!output->open(file.string(), spec) ||
        !output->write_image(OIIO::TypeDesc::FLOAT, raster.values.data()) || !output->close()) {
        refuse(output->geterror());
    }
}
