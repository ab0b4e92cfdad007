#pragma once
// A comparison of two runs in words: for a terminal, and as a comment on a change.

#include <string>

#include "compare/comparison.h"

namespace lodbench::report {

[[nodiscard]] std::string comparison_text(const compare::Comparison& comparison);
/// What changed first, times as a table, what is the same folded away.
[[nodiscard]] std::string comparison_markdown(const compare::Comparison& comparison);

/// "triangles.max: 61211 before, 61212 after"
[[nodiscard]] std::string text_of(const compare::Change& change);
/// "frame 7: triangles 61211 before, 61212 after (in 1 of 25 frames)"
[[nodiscard]] std::string text_of(const compare::FrameChange& change);
/// "slower: 1.07 times frame_ms.median (1.05 to 1.09), 14.2 before, 15.2 after, ..."
[[nodiscard]] std::string text_of(const compare::TimeComparison& time);

}  // namespace lodbench::report
