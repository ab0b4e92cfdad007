#include "report/html/figures.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/html/sections.h"

namespace lodbench::report::html {

std::string FigureColumn::field() const {
    return inner == nullptr ? key : fmt::format("{}.{}", key, inner);
}

bool FigureColumn::is_greatest() const {
    const std::string name = field();
    return name.ends_with("_ms.max") || name == "peak_rss_bytes";
}

void add_columns(Table& table, std::span<const FigureColumn> columns) {
    for (const FigureColumn& column : columns) {
        table.columns.push_back({column.title, column.field(), true, column.explanation});
    }
}

void add_fields(std::vector<Field>& row, std::span<const FigureColumn> columns,
                const std::vector<const Json::Value*>& objects) {
    for (const FigureColumn& column : columns) {
        const std::vector<double> values = results::numbers_of(objects, column.key, column.inner);
        const auto value = values.empty()         ? std::nullopt
                           : column.is_greatest() ? std::optional(*std::ranges::max_element(values))
                                                  : measure::median(values);
        row.push_back(number_field(value, column.digits, column.unit));
    }
}

Plot bars_of(const ReportData& data, const ResultSet& set, const std::string& id,
             const std::string& title, const std::string& x_title,
             const std::vector<std::size_t>& chosen) {
    Plot plot;
    plot.kind = Plot::Kind::bars;
    plot.id = set.id + "-" + id;
    plot.title = title;
    plot.x_title = x_title;
    plot.y_title = "method";
    plot.can_be_logarithmic = true;
    for (const std::size_t i : chosen) {
        const results::CellGroup& group = set.groups[i];
        plot.categories.push_back({group.label, group.method, data.color_of(group)});
    }
    return plot;
}

Table figure_table(const ResultSet& set, const char* id, const std::string& caption,
                   std::span<const FigureColumn> columns) {
    Table table = table_of(set, id, caption);
    add_columns(table, columns);
    for (const results::CellGroup& group : set.groups) {
        std::vector<Field>& row = table.rows.emplace_back();
        row.push_back(text_field(group.label));
        table.settings.push_back(setting_of(*group.cells.front()));
        add_fields(row, columns, group.good);
    }
    return table;
}

}  // namespace lodbench::report::html
