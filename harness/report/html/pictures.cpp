#include "report/html/pictures.h"

#include <fmt/format.h>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/files.h"
#include "base/modules.h"
#include "measure/modules/ssim.h"
#include "picture/png.h"
#include "report/html/text.h"

namespace lodbench::report::html {

namespace {

constexpr float kQuality = 78;  // of 100: letters of 15 pixels stay clean
constexpr std::uintmax_t kLargestFile = 64U << 20;

std::string data_uri(const char* type, std::span<const std::uint8_t> bytes) {
    return fmt::format("data:image/{};base64,{}", type, base64(bytes));
}

std::optional<std::string> webp_uri(const picture::Image& image) {
    void* symbol = base::find_in_module("webp", "lodbench_encode_webp");
    if (symbol == nullptr) return std::nullopt;
    std::vector<std::uint8_t> bytes;
    const auto encode = reinterpret_cast<decltype(&lodbench_encode_webp)>(symbol);
    if (!encode({image.rgb, image.width, image.height}, kQuality, bytes)) return std::nullopt;
    return data_uri("webp", bytes);
}

}  // namespace

std::string PictureBudget::embed(const std::filesystem::path& png) {
    const auto unusable = [&](const char* why) {
        unusable_.push_back(
            fmt::format("{}: {}", (png.parent_path().filename() / png.filename()).string(), why));
        return std::string();
    };
    std::error_code absent;
    if (!std::filesystem::is_regular_file(png, absent)) return unusable("there is no such file");
    if (std::filesystem::file_size(png, absent) > kLargestFile) return unusable("above 64 MiB");
    if (left_ == 0) {  // spent: not even looked at
        ++left_out_;
        return {};
    }
    const std::string file = base::read_text(png);
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(file.data()), file.size());
    const std::optional<picture::Image> image = picture::read_png(bytes);
    if (!image) return unusable("damaged, or no PNG");
    std::string uri = webp_uri(*image).value_or("");
    if (uri.empty() || uri.size() > file.size() * 4 / 3) uri = data_uri("png", bytes);
    if (uri.size() > left_) {
        left_ = 0;  // what follows is no smaller
        ++left_out_;
        return {};
    }
    left_ -= uri.size();
    return uri;
}

}  // namespace lodbench::report::html
