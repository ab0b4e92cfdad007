#include "report/aligned_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace lodbench::report {

std::string aligned_table(const std::vector<std::vector<std::string>>& lines) {
    std::vector<std::size_t> widths(lines.front().size(), 3);
    for (const auto& line : lines) {
        for (std::size_t i = 0; i < line.size(); ++i)
            widths[i] = std::max(widths[i], line[i].size());
    }
    std::string text;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        for (std::size_t i = 0; i < widths.size(); ++i) {
            text += i == 0 ? fmt::format("| {:<{}} ", lines[l][i], widths[i])
                           : fmt::format("| {:>{}} ", lines[l][i], widths[i]);
        }
        text += "|\n";
        if (l != 0) continue;
        for (std::size_t i = 0; i < widths.size(); ++i) {
            text += "|" + std::string(widths[i] + 1, '-') + (i == 0 ? "-" : ":");
        }
        text += "|\n";
    }
    return text;
}

}  // namespace lodbench::report
