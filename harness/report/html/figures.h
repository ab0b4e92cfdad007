#pragma once
// Columns of figures: what of a record stands in them, and how it is shown.

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "report/html/data.h"
#include "report/html/plot.h"
#include "report/html/table.h"

namespace lodbench::report::html {

/// A figure of a record, and how it is shown.
template <typename Record>
struct ColumnOf {
    const char* title;
    results::Figure<Record> figure;
    int digits = 3;
    double unit = 1;  ///< shown is the figure over it
    const char* explanation = "";
};
using FigureColumn = ColumnOf<results::CellRecord>;

/// Whether of a figure of this name the greatest over the repetitions is told instead of the
/// median, in every table: the slowest frame and the most memory that ever were.
[[nodiscard]] bool is_greatest(const std::string& name);

template <typename Columns>
void add_columns(Table& table, const Columns& columns) {
    for (const auto& column : columns) {
        table.columns.push_back({column.title, column.figure.name(), true, column.explanation});
    }
}

/// A field for each column, over `records`: a group of cells, or repetitions, or parts of them.
template <typename Columns, typename Records>
void add_fields(std::vector<Field>& row, const Columns& columns, const Records& records) {
    for (const auto& column : columns) {
        const std::vector<double> values = results::numbers_of(records, column.figure);
        const auto value = values.empty() ? std::nullopt
                           : is_greatest(column.figure.name())
                               ? std::optional(*std::ranges::max_element(values))
                               : measure::median(values);
        row.push_back(number_field(value, column.digits, column.unit));
    }
}

/// A bar plot, still without its series, of the settings `chosen` from the set.
[[nodiscard]] Plot bars_of(const ReportData& data, const ResultSet& set, const std::string& id,
                           const std::string& title, const std::string& x_title,
                           const std::vector<std::size_t>& chosen);

/// A row for each setting of the set, with these columns.
[[nodiscard]] Table figure_table(const ResultSet& set, const char* id, const std::string& caption,
                                 std::span<const FigureColumn> columns);

}  // namespace lodbench::report::html
