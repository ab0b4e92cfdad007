#include "picture/png.h"

#include <fmt/format.h>
#include <png.h>

#include <string>

#include "api/error.h"
#include "base/files.h"

namespace lodbench::picture {

void write_png(const std::filesystem::path& path, int width, int height,
               std::span<const std::uint8_t> rgb) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = png_uint_32(width);
    image.height = png_uint_32(height);
    image.format = PNG_FORMAT_RGB;
    if (rgb.size() != PNG_IMAGE_SIZE(image)) {
        throw ContractError(fmt::format("write_png: expected {} bytes for {}x{}, found {}",
                                        PNG_IMAGE_SIZE(image), width, height, rgb.size()));
    }
    png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string file(bytes, '\0');
    if (png_image_write_to_memory(&image, file.data(), &bytes, 0, rgb.data(), 0, nullptr) == 0) {
        throw EnvironmentError(fmt::format("{}: libpng: {}", path.string(), image.message));
    }
    file.resize(bytes);
    base::write_whole(path, file);
}

std::optional<Image> read_png(std::span<const std::uint8_t> file) {
    constexpr png_uint_32 kLargest = 8192;  // pixels a side
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&header, file.data(), file.size()) == 0 ||
        header.width > kLargest || header.height > kLargest) {
        png_image_free(&header);
        return std::nullopt;
    }
    header.format = PNG_FORMAT_RGB;
    Image image{int(header.width), int(header.height), {}};
    image.rgb.resize(PNG_IMAGE_SIZE(header));
    if (png_image_finish_read(&header, nullptr, image.rgb.data(), 0, nullptr) == 0) {
        return std::nullopt;
    }
    return image;
}

}  // namespace lodbench::picture
