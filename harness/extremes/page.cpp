// The matrix as a page, of the report's parts.

#include <fmt/format.h>

#include "extremes/output.h"
#include "report/html/page.h"
#include "report/html/text.h"

namespace lodbench::extremes {

namespace html = report::html;

namespace {

html::Table table_of(const std::string& id, const std::string& caption,
                     const std::vector<std::vector<std::string>>& rows) {
    html::Table table;
    table.id = id;
    table.caption = caption;
    for (const std::string& head : rows.front()) {
        html::Column column;
        column.title = column.field = head;
        column.numeric = false;
        table.columns.push_back(column);
    }
    for (std::size_t row = 1; row < rows.size(); ++row) {
        auto& fields = table.rows.emplace_back();
        for (const std::string& text : rows[row]) fields.push_back(html::text_field(text));
    }
    return table;
}

void add_failure(html::Page& page, const Failure& failure, const std::filesystem::path& folder) {
    const results::ExtremesStep& step = *failure.step;
    page.open_details(
        fmt::format("{} at {}: {}", failure.cell->method, step.step, words_of(*failure.fault)));
    page.paragraph(failure.fault->inherent.empty() ? "Not explained."
                                                   : "Inherent: " + failure.fault->inherent);
    page.raw("<p><code>" + html::escape(step.again) + "</code></p>\n");
    if (!step.picture.empty()) {
        const std::string picture = page.pictures().embed(folder / step.picture);
        page.raw(picture.empty() ? "<p>" + html::escape(step.picture) + "</p>\n"
                                 : fmt::format("<p><img alt=\"{}\" src=\"{}\"></p>\n",
                                               html::escape(step.picture), picture));
    }
    page.close_details();
}

/// Every failure in full, the first of each step with its picture.
void add_axis(html::Page& page, const results::ExtremesMatrix& matrix,
              const results::ExtremesAxis& axis, const std::filesystem::path& folder) {
    page.heading(2, axis.title, html::slug(axis.axis));
    page.paragraph(axis.about);
    std::vector<std::vector<std::string>> rows = {{"method"}};
    rows[0].insert(rows[0].end(), axis.steps.begin(), axis.steps.end());
    for (const results::ExtremesCell& cell : matrix.cells) {
        if (cell.axis != axis.axis) continue;
        auto& row = rows.emplace_back();
        row.push_back(cell.method);
        for (const results::ExtremesStep& step : cell.steps) row.push_back(step.outcome);
    }
    page.table(table_of("steps", axis.title, rows));
    for (const Failure& failure : failures_of(matrix)) {
        if (failure.cell->axis == axis.axis) add_failure(page, failure, folder);
    }
}

}  // namespace

std::string to_html(const results::ExtremesMatrix& matrix, const std::filesystem::path& folder) {
    html::Page page;
    page.heading(2, "Matrix", "matrix");
    page.paragraph(
        "A cell says how bad the worst of its steps was, and how many of those flown were good.");
    page.table(table_of("matrix", "Method by axis", matrix_rows(matrix)));
    page.list(matrix.warnings);
    for (const results::ExtremesAxis& axis : matrix.axes) add_axis(page, matrix, axis, folder);
    const std::string lead =
        html::escape(fmt::format("The {} battery over {}, lodbench {}, {}, on {}.", matrix.form,
                                 matrix.terrain, matrix.version, matrix.began, matrix.device));
    return page.document("Numerical stability at the extremes", "<p>" + lead + "</p>");
}

}  // namespace lodbench::extremes
