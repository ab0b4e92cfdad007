#pragma once
// Markdown that reads well in a terminal too.

#include <string>
#include <vector>

namespace lodbench::report {

/// A table of which the first line is the head: columns of equal width, the first to the left, the
/// others to the right. At least one line; all have as many fields.
[[nodiscard]] std::string aligned_table(const std::vector<std::vector<std::string>>& lines);

}  // namespace lodbench::report
