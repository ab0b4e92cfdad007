#pragma once
// The [flight] table of a scenario.

#include "scenario/flight_path.h"
#include "scenario/toml_section.h"

namespace lodbench::scenario {

/// Reads the keys that make a path; `kind` decides which. Relative files are relative to `folder`.
/// A recorded flight is `kept` where that is not empty.
[[nodiscard]] PathSpec read_path(Section& flight, const std::filesystem::path& folder,
                                 const std::filesystem::path& kept);

/// Path of a file that must exist, relative ones under `folder`.
[[nodiscard]] std::filesystem::path existing_file(const Section& section, std::string_view key,
                                                  const std::string& written,
                                                  const std::filesystem::path& folder);

}  // namespace lodbench::scenario
