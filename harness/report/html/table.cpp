#include "report/html/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "report/html/text.h"
#include "results/cell_groups.h"

namespace lodbench::report::html {

namespace {

bool is_number(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    return read.ec == std::errc() && read.ptr == text.data() + text.size();
}

/// What a spreadsheet would take for a formula gets an apostrophe in front.
std::string csv_field(std::string_view field) {
    const bool formula = field.find_first_of("=+-@\t\r") == 0 && field != "-" && !is_number(field);
    const std::string text = (formula ? "'" : "") + std::string(field);
    if (text.find_first_of("\",\r\n") == text.npos) return text;
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"') result += '"';
        result += c;
    }
    return result + '"';
}

bool is_in_csv(const Table& table, const Column& column) {
    if (column.place == Column::Place::page) return false;
    return table.settings.empty() || (column.field != "method" && column.field != "scenario");
}

std::string header(const Table& table, const std::set<std::string>& params) {
    std::string csv = "results,scenario";
    if (!table.settings.empty()) {
        csv += ",method";
        for (const std::string& name : params) {
            const bool taken =
                name == "results" || name == "scenario" || name == "method" ||
                std::ranges::find(table.columns, name, &Column::field) != table.columns.end();
            csv += "," + csv_field(taken ? "params." + name : name);
        }
    }
    for (const Column& column : table.columns) {
        if (is_in_csv(table, column)) csv += "," + csv_field(column.field);
    }
    return csv + "\r\n";
}

std::string line(const Table& table, std::size_t row, const std::set<std::string>& params) {
    std::string csv = csv_field(table.results) + ",";
    if (table.settings.empty()) {
        csv += csv_field(table.scenario);
    } else {
        const Setting& setting = table.settings[row];
        csv += csv_field(setting.scenario) + "," + csv_field(setting.method);
        for (const std::string& name : params) {
            const auto value = setting.params.find(name);
            csv += "," + (value == setting.params.end() ? "" : csv_field(value->second));
        }
    }
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        if (is_in_csv(table, table.columns[i])) csv += "," + csv_field(table.rows[row][i].value);
    }
    return csv + "\r\n";
}

}  // namespace

Field text_field(std::string text) {
    return {text, text};
}

Field number_field(std::optional<double> value, int digits, double unit) {
    if (!value) return {readable(value, digits), ""};
    return {readable(*value / unit, digits), exact(*value)};
}

std::string to_html(const Table& table) {
    std::string html = fmt::format(
        "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{0}\"><table "
        "data-table=\"{1}\" data-results=\"{2}\" data-scenario=\"{3}\">\n<caption>{0}</caption>\n"
        "<thead><tr>",
        escape(table.caption), escape(table.id), escape(table.results), escape(table.scenario));
    for (const Column& column : table.columns) {
        if (column.place == Column::Place::csv) continue;
        html += fmt::format("<th scope=\"col\"{}{}>{}</th>", column.numeric ? " class=\"n\"" : "",
                            column.explanation.empty()
                                ? ""
                                : fmt::format(" title=\"{}\"", escape(column.explanation)),
                            escape(column.title));
    }
    html += "</tr></thead>\n<tbody>\n";
    for (const auto& row : table.rows) {
        html += "<tr>";
        for (std::size_t i = 0; i < row.size(); ++i) {
            const Column& column = table.columns[i];
            if (column.place == Column::Place::csv) continue;
            const std::string text = escape(row[i].text);
            if (i == 0) {
                html += fmt::format("<th scope=\"row\" data-field=\"{}\">{}</th>",
                                    escape(column.field), text);
            } else if (column.numeric) {
                html += fmt::format("<td class=\"n\" data-field=\"{}\" data-value=\"{}\">{}</td>",
                                    escape(column.field), escape(row[i].value), text);
            } else {
                html += fmt::format("<td data-field=\"{}\">{}</td>", escape(column.field), text);
            }
        }
        html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

Setting setting_of(const results::CellRecord& cell) {
    Setting setting{cell.scenario, cell.method, {}};
    for (const auto& [name, value] : cell.params.values()) {
        setting.params[name] = results::value_text(value);
    }
    if (!cell.device.empty()) setting.params.emplace("device", cell.device);
    return setting;
}

std::set<std::string> CsvTables::swept() const {
    std::map<std::pair<std::string, std::string>, std::string> first;  // of method and parameter
    std::set<std::string> names;
    for (const auto& [id, tables] : tables_) {
        for (const Table& table : tables) {
            for (const Setting& setting : table.settings) {
                for (const auto& [name, value] : setting.params) {
                    const auto& known = first.try_emplace({setting.method, name}, value);
                    if (known.first->second != value) names.insert(name);
                }
            }
        }
    }
    return names;
}

std::map<std::string, std::string> CsvTables::files() const {
    const std::set<std::string> params = swept();
    std::map<std::string, std::string> files;
    for (const auto& [id, tables] : tables_) {
        std::string& csv = files[id];
        const auto filled =
            std::ranges::find_if(tables, [](const Table& table) { return !table.rows.empty(); });
        csv = header(filled == tables.end() ? tables.front() : *filled, params);
        for (const Table& table : tables) {
            for (std::size_t i = 0; i < table.rows.size(); ++i) csv += line(table, i, params);
        }
    }
    return files;
}

}  // namespace lodbench::report::html
