#pragma once
// The matrix as text, as Markdown and as a page.

#include <filesystem>
#include <string>
#include <vector>

#include "results/extremes.h"

namespace lodbench::extremes {

/// Head and rows of the matrix: a row a method, a column an axis.
[[nodiscard]] std::vector<std::vector<std::string>> matrix_rows(
    const results::ExtremesMatrix& matrix);

/// One failure of one step.
struct Failure {
    const results::ExtremesCell* cell = nullptr;
    const results::ExtremesStep* step = nullptr;
    const results::ExtremesFault* fault = nullptr;
};
/// All of them, in the order of the matrix.
[[nodiscard]] std::vector<Failure> failures_of(const results::ExtremesMatrix& matrix);

/// "crack: 12 of 19200 pixels show a crack (frame 0)"
[[nodiscard]] std::string words_of(const results::ExtremesFault& fault);

[[nodiscard]] std::string to_markdown(const results::ExtremesMatrix& matrix);
/// The whole page, which opens offline; its pictures lie in `folder`.
[[nodiscard]] std::string to_html(const results::ExtremesMatrix& matrix,
                                  const std::filesystem::path& folder);
/// extremes.json, extremes.md and extremes.html, each written whole.
void write_all(const results::ExtremesMatrix& matrix, const std::filesystem::path& folder);

}  // namespace lodbench::extremes
