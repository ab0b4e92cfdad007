#pragma once
// JUnit XML, which every CI system shows: of a campaign and of a comparison.

#include <string>

#include "compare/comparison.h"
#include "results/folder.h"

namespace lodbench::report {

/// A suite for each scenario, a case for each cell. Crashed and timed out are errors, failed is a
/// failure.
[[nodiscard]] std::string junit_of(const results::ResultFolder& folder);

/// A suite for each scenario; for each setting a case of its figures and one of each time. What
/// fails the gate is a failure; what cannot be told is skipped, with the reason.
[[nodiscard]] std::string junit_of(const compare::Comparison& comparison);

/// Text between tags or in an attribute: what XML 1.0 cannot hold (control characters, U+FFFE,
/// bytes that are not UTF-8) becomes U+FFFD; line ends and tabs keep their meaning.
[[nodiscard]] std::string xml_text(const std::string& text);

}  // namespace lodbench::report
