#pragma once
// Pictures as text of the page itself.

#include <cstddef>
#include <filesystem>
#include <string>

namespace lodbench::report::html {

/// Takes pictures into the page until its bytes are spent.
class PictureBudget {
public:
    explicit PictureBudget(std::size_t bytes) : left_(bytes) {}

    /// A data URI: WebP where its module is there and makes it smaller, else the PNG as it is. ""
    /// where there is no such file, it is no picture, or it does not fit any more.
    [[nodiscard]] std::string embed(const std::filesystem::path& png);

    [[nodiscard]] std::size_t left_out() const { return left_out_; }

private:
    std::size_t left_;
    std::size_t left_out_ = 0;
};

}  // namespace lodbench::report::html
