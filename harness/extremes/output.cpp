#include "extremes/output.h"

#include <fmt/format.h>

#include "base/files.h"
#include "results/json.h"

namespace lodbench::extremes {

using results::ExtremesCell;
using results::ExtremesFault;
using results::ExtremesMatrix;
using results::ExtremesStep;

namespace {

std::string cell_text(const ExtremesCell& cell) {
    if (cell.flown == 0) return cell.grade;
    return fmt::format("{} {}/{}", cell.grade, cell.good, cell.flown);
}

/// A field of a Markdown table: one line, no column's end in it.
std::string field(const std::string& text) {
    std::string escaped;
    for (const char c : text) escaped += c == '|' ? "\\|" : std::string(1, c == '\n' ? ' ' : c);
    return escaped;
}

std::string markdown_table(const std::vector<std::vector<std::string>>& rows) {
    std::string text;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        for (const std::string& value : rows[row]) text += "| " + field(value) + " ";
        text += "|\n";
        if (row > 0) continue;
        for (std::size_t i = 0; i < rows[0].size(); ++i) text += "|---";
        text += "|\n";
    }
    return text;
}

std::string last_good(const ExtremesCell& cell) {
    return cell.last_good.empty() ? "none" : cell.last_good;
}

/// Failures of an axis: a row each.
std::string failure_rows(const std::vector<Failure>& failures, const std::string& axis) {
    std::vector<std::vector<std::string>> rows = {
        {"method", "last good", "fails at", "what broke", "inherent", "again"}};
    for (const Failure& failure : failures) {
        if (failure.cell->axis != axis) continue;
        rows.push_back({failure.cell->method, last_good(*failure.cell), failure.step->step,
                        words_of(*failure.fault), failure.fault->inherent,
                        "`" + failure.step->again + "`"});
    }
    return rows.size() > 1 ? markdown_table(rows) : "Nothing failed.\n";
}

std::string not_flown(const ExtremesMatrix& matrix, const std::string& axis) {
    std::string text;
    for (const ExtremesCell& cell : matrix.cells) {
        if (cell.axis != axis) continue;
        for (const ExtremesStep& step : cell.steps) {
            if (step.outcome != "not-flown") continue;
            text += fmt::format("- {}, {}: {}\n", cell.method, step.step, step.reason);
        }
    }
    return text.empty() ? "" : "\nNot flown:\n\n" + text;
}

}  // namespace

std::vector<std::vector<std::string>> matrix_rows(const ExtremesMatrix& matrix) {
    std::vector<std::vector<std::string>> rows = {{"method"}};
    for (const results::ExtremesAxis& axis : matrix.axes) rows[0].push_back(axis.axis);
    for (const std::string& method : matrix.methods) {
        auto& row = rows.emplace_back();
        row.push_back(method);
        for (const results::ExtremesAxis& axis : matrix.axes) {
            const ExtremesCell* cell = matrix.find(method, axis.axis);
            row.push_back(cell == nullptr ? "-" : cell_text(*cell));
        }
    }
    return rows;
}

std::vector<Failure> failures_of(const ExtremesMatrix& matrix) {
    std::vector<Failure> failures;
    for (const ExtremesCell& cell : matrix.cells) {
        for (const ExtremesStep& step : cell.steps) {
            for (const ExtremesFault& fault : step.faults) {
                failures.push_back({&cell, &step, &fault});
            }
        }
    }
    return failures;
}

std::string words_of(const ExtremesFault& fault) {
    return fmt::format("{}: {}{}", fault.what, fault.words,
                       fault.where.empty() ? "" : " (" + fault.where + ")");
}

std::string to_markdown(const ExtremesMatrix& matrix) {
    std::string text = fmt::format(
        "# Extremes\n\nThe {} battery over {} (checksum {}), lodbench {}, {}, on {}.\n\n"
        "A cell says how bad the worst of its steps was, and how many of those flown were good: "
        "*stable*: nothing broke; *degrades*: cracks, uncovered ground, a bound that does not "
        "hold, "
        "a surface that moved; *breaks*: a call failed, vertices were not finite, a selection "
        "could not be repeated, nothing was drawn; *dies*: crash, hang, memory.\n\n",
        matrix.form, matrix.terrain, matrix.terrain_checksum, matrix.version, matrix.began,
        matrix.device);
    text += markdown_table(matrix_rows(matrix));
    for (const std::string& warning : matrix.warnings) text += "\nWarning: " + warning + "\n";
    const std::vector<Failure> failures = failures_of(matrix);
    for (const results::ExtremesAxis& axis : matrix.axes) {
        text += fmt::format("\n## {}\n\n{}\n\nSteps: ", axis.title, axis.about);
        for (std::size_t i = 0; i < axis.steps.size(); ++i) {
            text += (i > 0 ? "; " : "") + axis.steps[i];
        }
        text += ".\n\n" + failure_rows(failures, axis.axis) + not_flown(matrix, axis.axis);
    }
    return text;
}

void write_all(const ExtremesMatrix& matrix, const std::filesystem::path& folder) {
    base::write_whole(folder / results::kExtremesFile, results::to_text(to_json(matrix)) + "\n");
    base::write_whole(folder / "extremes.md", to_markdown(matrix));
    base::write_whole(folder / "extremes.html", to_html(matrix, folder));
}

}  // namespace lodbench::extremes
