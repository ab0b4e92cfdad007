#pragma once
// The table at the end of a run, from the cells.

#include <cstdint>
#include <string>
#include <vector>

#include "results/cell.h"

namespace lodbench::report {

/// One method with one set of parameters on one scenario, over its repetitions.
struct TableRow {
    std::string scenario;  ///< and the device where there are several
    std::string label;     ///< the method's id and the parameters that differ between its rows
    std::vector<std::string> fields;    ///< as table_columns() after the first
    std::vector<std::string> failures;  ///< "status: reason" of the repetitions that are not ok
    std::vector<std::string> warnings;  ///< why the figures are not to be trusted
    std::vector<std::string> noise;     ///< what disturbed the times
};

/// "method", "fps (range)", ...
[[nodiscard]] const std::vector<std::string>& table_columns();

/// Rows in order of scenario, method and setting. `seed` is that of the bootstrap.
[[nodiscard]] std::vector<TableRow> table_rows(const std::vector<results::CellRecord>& cells,
                                               std::uint64_t seed);

/// For a terminal: columns aligned, one block a scenario, noise and failures below. For summary.md:
/// Markdown, failures folded.
[[nodiscard]] std::string text_table(const std::vector<TableRow>& rows);
/// What text_table has below its tables.
[[nodiscard]] std::string remarks_text(const std::vector<TableRow>& rows);
[[nodiscard]] std::string markdown_table(const std::vector<TableRow>& rows);

/// What is no Markdown and no HTML, whatever it holds; one line.
[[nodiscard]] std::string markdown_text(const std::string& text);

}  // namespace lodbench::report
