#include "report/html/table.h"

#include <fmt/format.h>

#include <charconv>
#include <string_view>

#include "report/html/text.h"

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

void CsvTables::add(const Table& table) {
    std::string& csv = files_[table.id];
    if (csv.empty()) {
        csv = "results,scenario";
        for (const Column& column : table.columns) csv += "," + csv_field(column.field);
        csv += "\r\n";
    }
    for (const auto& row : table.rows) {
        csv += csv_field(table.results) + "," + csv_field(table.scenario);
        for (const Field& field : row) csv += "," + csv_field(field.value);
        csv += "\r\n";
    }
}

}  // namespace lodbench::report::html
