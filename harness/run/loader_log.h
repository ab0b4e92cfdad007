#pragma once
// LODBENCH_LOADER_DEBUG=1: every step of looking for and opening plugins, on standard error.

#include <fmt/format.h>

#include "base/console.h"

#include <cstdlib>
#include <string_view>
#include <utility>

namespace lodbench::run {

template <typename... Args>
void loader_log(fmt::format_string<Args...> format, Args&&... args) {
    const char* wanted = std::getenv("LODBENCH_LOADER_DEBUG");
    if (wanted == nullptr || std::string_view(wanted) == "0" || *wanted == '\0') return;
    base::tell("lodbench loader: {}", fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace lodbench::run
