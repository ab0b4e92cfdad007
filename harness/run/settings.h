#pragma once
// Parameters of methods as text, before the method's specs have judged them.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lodbench::run {

/// Parameter and value.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// One --set of the command line.
struct Setting {
    std::string method;  ///< "" where none was named
    std::string name, value;
};

/// Reads "[METHOD.]NAME=VALUE"; no part may be empty. Throws InputError saying that `form` was
/// expected.
[[nodiscard]] Setting parse_setting(std::string_view text, std::string_view form);

}  // namespace lodbench::run
