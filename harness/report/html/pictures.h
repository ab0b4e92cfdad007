#pragma once
// Pictures as text of the page itself.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace lodbench::report::html {

/// Takes pictures into the page until its bytes are spent.
class PictureBudget {
public:
    explicit PictureBudget(std::size_t bytes) : left_(bytes) {}

    /// A data URI: WebP where its module is there and makes it smaller, else the PNG as it is. ""
    /// where it does not fit any more, or cannot be shown.
    [[nodiscard]] std::string embed(const std::filesystem::path& png);

    /// How many did not fit.
    [[nodiscard]] std::size_t left_out() const { return left_out_; }
    /// "FILE: why" of those that cannot be shown, for the page to say.
    [[nodiscard]] const std::vector<std::string>& unusable() const { return unusable_; }

private:
    std::size_t left_;
    std::size_t left_out_ = 0;
    std::vector<std::string> unusable_;
};

}  // namespace lodbench::report::html
