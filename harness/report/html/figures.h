#pragma once
// Columns of figures: what of cells.jsonl stands in them, and how it is read.

#include <json/value.h>

#include <span>
#include <string>
#include <vector>

#include "report/html/data.h"
#include "report/html/plot.h"
#include "report/html/table.h"

namespace lodbench::report::html {

/// A figure of an object: its member `key`, or of that the member `inner`.
struct FigureColumn {
    const char* title;
    const char* key;
    const char* inner = nullptr;
    int digits = 3;
    double unit = 1;  ///< shown is the figure over it
    const char* explanation = "";
    /// "frame_ms.median"
    [[nodiscard]] std::string field() const;
    /// Whether it is the greatest over the repetitions instead of the median, in every table: the
    /// slowest frame and the most memory that ever were.
    [[nodiscard]] bool is_greatest() const;
};

void add_columns(Table& table, std::span<const FigureColumn> columns);
/// A field for each column, over `objects`: the repetitions of a cell, or parts of them.
void add_fields(std::vector<Field>& row, std::span<const FigureColumn> columns,
                const std::vector<const Json::Value*>& objects);
/// A bar plot, still without its series, of the settings `chosen` from the set.
[[nodiscard]] Plot bars_of(const ReportData& data, const ResultSet& set, const std::string& id,
                           const std::string& title, const std::string& x_title,
                           const std::vector<std::size_t>& chosen);

/// A row for each setting of the set, with these columns.
[[nodiscard]] Table figure_table(const ResultSet& set, const char* id, const std::string& caption,
                                 std::span<const FigureColumn> columns);

}  // namespace lodbench::report::html
