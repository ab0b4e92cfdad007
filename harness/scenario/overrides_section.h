#pragma once
// Overrides of a scenario as a file of data writes them.

#include <string>
#include <string_view>

#include "scenario/scenario.h"
#include "scenario/toml_section.h"

namespace lodbench::scenario {

/// A value as an override takes it: on one line or several, for parse_toml_value.
[[nodiscard]] std::string toml_text(const toml::node& node);

/// A table of overrides in `section`: keys of a scenario, as "flight.frames", and their values.
/// Empty where the key is absent.
[[nodiscard]] Overrides read_overrides(Section& section, std::string_view key);

/// `over` goes before `base`.
[[nodiscard]] Overrides merged(Overrides base, const Overrides& over);

}  // namespace lodbench::scenario
