#include "report/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>

#include "measure/statistics.h"
#include "results/cell_groups.h"

namespace lodbench::report {

using namespace results::figures;

namespace {

constexpr const char* kAbsent = "-";

/// A column after that of the methods: the median over the repetitions, or the greatest of them.
struct TableColumn {
    const char* title;
    results::CellFigure figure;
    int digits;  ///< after the point
    double unit = 1;
    bool greatest = false;
};

constexpr TableColumn kColumns[] = {
    {"median ms", of<&Cell::frame_ms, &TimeSummary::median>, 3},
    {"P90 ms", of<&Cell::frame_ms, &TimeSummary::p90>, 3},
    {"max ms", of<&Cell::frame_ms, &TimeSummary::max>, 3, 1, true},
    {"triangles", of<&Cell::triangles, &CountSummary::mean>, 0},
    {"prepare s", of<&Cell::prepare_s>, 3},
    {"GPU MiB", of<&Cell::gpu_bytes>, 1, results::kMebibyte},
    {"RSS MiB", of<&Cell::peak_rss_bytes>, 0, results::kMebibyte, true},
    {"P99.9 px", of<&Cell::pixel_error_px, &ErrorFigures::p999>, 2},
    {"max px", of<&Cell::pixel_error_px, &ErrorFigures::max>, 2},
    {"crack px", of<&Cell::crack_pixels, &TotalAndMax::total>, 0},
    {"pop px", of<&Cell::popping_px, &PoppingFigures::p999>, 2},
    {"honesty", of<&Cell::bound_honesty>, 3},
};

std::string text_of(const TableColumn& column, const results::CellGroup& group) {
    const std::vector<double> values = results::numbers_of(group, column.figure);
    if (values.empty()) return kAbsent;
    const double value =
        column.greatest ? *std::ranges::max_element(values) : *measure::median(values);
    return fmt::format("{:.{}f}", value / column.unit, column.digits);
}

std::string fps_text(const std::vector<const results::CellRecord*>& cells, std::uint64_t seed) {
    const auto interval = measure::run_interval(results::numbers_of(cells, of<&Cell::fps>), seed);
    if (!interval) return kAbsent;
    return fmt::format("{:.1f} ({:.1f}..{:.1f})", interval->centre, interval->low, interval->high);
}

/// What is folded away below the tables, in Markdown.
class Fold {
public:
    explicit Fold(const char* title) : title_(title) {}
    void add(const TableRow& row, const std::string& words) {
        lines_ += fmt::format("- {}, {}: {}\n", markdown_text(row.label),
                              markdown_text(row.scenario), markdown_text(words));
        ++count_;
    }
    [[nodiscard]] std::string text() const {
        if (count_ == 0) return {};
        return fmt::format("\n<details><summary>{}: {}</summary>\n\n{}\n</details>\n", title_,
                           count_, lines_);
    }

private:
    const char* title_;
    std::string lines_;
    std::size_t count_ = 0;
};

}  // namespace

const std::vector<std::string>& table_columns() {
    static const std::vector<std::string> columns = [] {
        std::vector<std::string> titles = {"method", "fps (range)"};
        for (const TableColumn& column : kColumns) titles.emplace_back(column.title);
        return titles;
    }();
    return columns;
}

std::vector<TableRow> table_rows(const std::vector<results::CellRecord>& cells,
                                 std::uint64_t seed) {
    std::vector<TableRow> rows;
    for (const results::CellGroup& group : results::group_cells(cells)) {
        TableRow row{group.comparison(),
                     group.label,
                     {},
                     results::failures_of(group),
                     results::disagreements_of(group),
                     results::noise_of(group)};
        row.fields.push_back(fps_text(group.good, seed));
        for (const TableColumn& column : kColumns) row.fields.push_back(text_of(column, group));
        rows.push_back(std::move(row));
    }
    return rows;
}

std::string text_table(const std::vector<TableRow>& rows) {
    const std::vector<std::string>& columns = table_columns();
    std::vector<std::size_t> widths;
    for (const std::string& column : columns) widths.push_back(column.size());
    for (const TableRow& row : rows) {
        widths[0] = std::max(widths[0], row.label.size());
        for (std::size_t i = 0; i < row.fields.size(); ++i) {
            widths[i + 1] = std::max(widths[i + 1], row.fields[i].size());
        }
    }
    const auto line = [&](const std::string& first, const auto& rest) {
        std::string text = fmt::format("  {:<{}}", first, widths[0]);
        for (std::size_t i = 1; i < columns.size(); ++i) {
            text += fmt::format("  {:>{}}", rest(i), widths[i]);
        }
        return text + "\n";
    };
    std::string text;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const TableRow& row = rows[r];
        if (r == 0 || row.scenario != rows[r - 1].scenario) {
            text += fmt::format("{}{}\n", r == 0 ? "" : "\n", row.scenario);
            text += line(columns[0], [&](std::size_t i) { return columns[i]; });
        }
        text += line(row.label, [&](std::size_t i) { return row.fields[i - 1]; });
    }
    return text + remarks_text(rows);
}

std::string remarks_text(const std::vector<TableRow>& rows) {
    std::string failures;
    std::string warnings;
    std::string noise;
    for (const TableRow& row : rows) {
        for (const std::string& failure : row.failures) {
            failures += fmt::format("  {}, {}: {}\n", row.label, row.scenario, failure);
        }
        for (const std::string& warning : row.warnings) {
            warnings += fmt::format("  {}, {}: {}\n", row.label, row.scenario, warning);
        }
        for (const std::string& words : row.noise) {
            noise += fmt::format("  {}, {}, {}\n", row.label, row.scenario, words);
        }
    }
    std::string text;
    if (!warnings.empty()) text += "\nWarnings\n" + warnings;
    if (!noise.empty()) text += "\nNoise\n" + noise;
    if (!failures.empty()) text += "\nNot measured\n" + failures;
    return text;
}

std::string markdown_text(const std::string& text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&': result += "&amp;"; break;
            case '<': result += "&lt;"; break;
            case '>': result += "&gt;"; break;
            case '|':
            case '`':
            case '*':
            case '_':
            case '[':
            case ']':
            case '\\': (result += '\\') += c; break;
            case '\n':
            case '\r': result += ' '; break;
            default: result += c;
        }
    }
    return result;
}

std::string markdown_table(const std::vector<TableRow>& rows) {
    std::string text;
    Fold warnings{"Warnings"};
    Fold failures{"Not measured"};
    std::string noise;  // not folded: it is about the figures above
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const TableRow& row = rows[r];
        if (r == 0 || row.scenario != rows[r - 1].scenario) {
            text += fmt::format("{}**lodbench: {}**\n\n| {} |\n|---|", r == 0 ? "" : "\n",
                                markdown_text(row.scenario), fmt::join(table_columns(), " | "));
            for (std::size_t i = 1; i < table_columns().size(); ++i) text += "---:|";
            text += "\n";
        }
        text +=
            fmt::format("| {} | {} |\n", markdown_text(row.label), fmt::join(row.fields, " | "));
        for (const std::string& warning : row.warnings) warnings.add(row, warning);
        for (const std::string& failure : row.failures) failures.add(row, failure);
        for (const std::string& words : row.noise) {
            noise += fmt::format("- Noise: {}, {}, {}\n", markdown_text(row.label),
                                 markdown_text(row.scenario), markdown_text(words));
        }
    }
    if (!noise.empty()) text += "\n" + noise;
    return text + warnings.text() + failures.text();
}

}  // namespace lodbench::report
