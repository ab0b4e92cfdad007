#pragma once
// Texts that say the same with other numbers, as one text with the range.

#include <string>
#include <vector>

namespace lodbench::results {

/// Of texts that differ in nothing but numbers, one: each number in which they differ is "LEAST to
/// GREATEST", as it stood in its text. In the order in which the first of each stood.
[[nodiscard]] std::vector<std::string> fold_alike(const std::vector<std::string>& texts);

}  // namespace lodbench::results
