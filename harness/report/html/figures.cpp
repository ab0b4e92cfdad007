#include "report/html/figures.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/html/sections.h"

namespace lodbench::report::html {

bool is_greatest(const std::string& name) {
    return name.ends_with("_ms.max") || name == "peak_rss_bytes";
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
        add_fields(row, columns, group);
    }
    return table;
}

}  // namespace lodbench::report::html
