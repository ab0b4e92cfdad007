#pragma once
// The files that are built into the program and become part of every report.

#include <string>
#include <string_view>

namespace lodbench::report::html {

struct PageFile {
    std::string_view text;
    /// As a content security policy names it: sha256-...
    std::string hash;
};

[[nodiscard]] PageFile page_css();
[[nodiscard]] PageFile page_js();

}  // namespace lodbench::report::html
