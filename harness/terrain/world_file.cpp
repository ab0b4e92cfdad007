#include "terrain/world_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "api/error.h"
#include "base/printable.h"

namespace lodbench::terrain {

namespace fs = std::filesystem;

namespace {

/// x scale, two rotations, y scale, and x, y of the centre of the north-west pixel.
constexpr std::size_t kNumbers = 6;
constexpr std::size_t kMostBytes = 4096;

std::array<double, kNumbers> read_world_file(const fs::path& file) {
    std::string text(kMostBytes, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(text.data(), std::streamsize(text.size()));
    text.resize(std::size_t(stream.gcount()));
    std::array<double, kNumbers> numbers{};
    std::size_t at = 0;
    for (std::size_t i = 0; i < kNumbers; ++i) {
        const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n", at), text.size());
        at = std::min(text.find_first_of(" \t\r\n", begin), text.size());
        const std::size_t sign = begin < at && text[begin] == '+' ? 1 : 0;
        const auto [end, error] =
            std::from_chars(text.data() + begin + sign, text.data() + at, numbers[i]);
        if (error != std::errc() || end != text.data() + at || !std::isfinite(numbers[i])) {
            throw InputError(fmt::format(
                "{}: number {} of a world file is {}; expected six numbers, with decimal points",
                file.string(), i + 1, base::printable(text.substr(begin, at - begin))));
        }
    }
    return numbers;
}

}  // namespace

std::optional<fs::path> find_beside(const fs::path& image, const std::string& extension) {
    std::string upper = extension;
    std::ranges::transform(upper, upper.begin(),
                           [](unsigned char c) { return char(std::toupper(c)); });
    for (const std::string& ending : {extension, upper}) {
        const fs::path file = fs::path(image).replace_extension(ending);
        std::error_code error;
        if (file != image && fs::is_regular_file(file, error)) return file;
    }
    return std::nullopt;
}

std::optional<fs::path> find_world_file(const fs::path& image) {
    std::string extension = image.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    std::vector<std::string> endings = {".wld"};
    if (extension.size() > 2) {
        endings.push_back({'.', extension[1], extension.back(), 'w'});
        endings.push_back(extension + "w");
    }
    for (const std::string& ending : endings) {
        if (const auto file = find_beside(image, ending)) return file;
    }
    return std::nullopt;
}

RasterDescription with_world_file(const fs::path& image, RasterDescription description) {
    if (description.spacing || !description.spacing_hint.empty()) return description;
    const std::optional<fs::path> file = find_world_file(image);
    if (!file) return description;
    const auto [width, across, down, height, west, north] = read_world_file(*file);
    if (across != 0 || down != 0) {
        throw InputError(
            fmt::format("{}: rotated by terms {} and {}; warp the image upright with "
                        "gdalwarp",
                        file->string(), across, down));
    }
    if (!(width > 0 && height < 0)) {
        throw InputError(
            fmt::format("{}: pixels of {} by {}; the first must be positive, the second "
                        "negative: turn the image over, north to the top",
                        file->string(), width, height));
    }
    const glm::dvec2 spacing(width, -height);
    const glm::dvec2 corner(west, north + (description.rows - 1) * height);
    if (const auto system = find_beside(image, ".prj")) {
        description.spacing_hint = fmt::format(
            "what the numbers of {} are stands in {}, which is not read beside an image",
            file->filename().string(), system->filename().string());
        return description;
    }
    if (looks_like_degrees(corner, spacing, description.rows, description.columns)) {
        description.spacing_hint = fmt::format("pixels of {} x {} in {} look like degrees",
                                               spacing.x, spacing.y, file->filename().string());
        return description;
    }
    description.spacing = spacing;
    description.origin = corner;
    description.reference =
        fmt::format("none named; the numbers of {} taken for metres", file->filename().string());
    return description;
}

bool looks_like_degrees(glm::dvec2 corner, glm::dvec2 pixel, int rows, int columns) {
    const glm::dvec2 far = corner + pixel * glm::dvec2(columns, rows);
    const bool in_range = std::abs(corner.x) <= 360.5 && std::abs(far.x) <= 361 &&
                          std::abs(corner.y) <= 90.5 && std::abs(far.y) <= 91;
    if (!in_range) return false;
    // Grids of local surveys begin at 0, 0 and may be as fine as a quarter metre.
    const bool somewhere = corner.x != 0.5 * pixel.x || corner.y != 0.5 * pixel.y;
    const double finest = std::max(pixel.x, pixel.y);
    return finest < 0.02 || (somewhere && corner != glm::dvec2(0) && finest < 1) ||
           pixel.x * columns > 350;
}

}  // namespace lodbench::terrain
