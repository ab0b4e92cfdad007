#pragma once
// Markdown that reads well in a terminal too.

#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

namespace lodbench::report {

/// A table of which the first line is the head: columns of equal width, the first to the left, the
/// others to the right. At least one line; all have as many fields.
[[nodiscard]] std::string aligned_table(const std::vector<std::vector<std::string>>& lines);

/// A field of it; "-" for what was not measured. Shown is the value over `unit`.
template <typename Value>
std::string text_of(const std::optional<Value>& value, const char* format) {
    return value ? fmt::format(fmt::runtime(format), *value) : "-";
}
inline std::string text_of(const std::optional<double>& value, const char* format, double unit) {
    return value ? fmt::format(fmt::runtime(format), *value / unit) : "-";
}

}  // namespace lodbench::report
