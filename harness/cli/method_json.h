#pragma once
// A method's descriptor as JSON, for `list` and `describe`.

#include <json/value.h>

#include "run/plugin_library.h"

namespace lodbench::cli {

[[nodiscard]] Json::Value method_json(const run::MethodInfo& method);
/// "real", "1", "0.01..100": what people read of a parameter.
[[nodiscard]] std::string type_words(const run::ParamInfo& param);
[[nodiscard]] std::string default_words(const run::ParamInfo& param);
[[nodiscard]] std::string range_words(const run::ParamInfo& param);

}  // namespace lodbench::cli
