#include "report/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>

#include "measure/statistics.h"
#include "report/json.h"

namespace lodbench::report {

namespace {

constexpr double kMebibyte = 1048576.0;
constexpr const char* kAbsent = "-";

using Cells = std::vector<const Json::Value*>;

/// The numbers at a path of keys, of the cells that have them.
std::vector<double> numbers(const Cells& cells, const char* key, const char* inner = nullptr) {
    std::vector<double> values;
    for (const Json::Value* cell : cells) {
        const Json::Value& outer = (*cell)[key];
        const Json::Value& value = inner == nullptr || !outer.isObject() ? outer : outer[inner];
        if (const auto number = read_number_or_inf(value)) values.push_back(*number);
    }
    return values;
}

std::string median(std::vector<double> values, const char* format, double unit = 1) {
    const auto centre = measure::percentile(values, 0.5);
    return centre ? fmt::format(fmt::runtime(format), *centre / unit) : kAbsent;
}

std::string greatest(const std::vector<double>& values, const char* format, double unit = 1) {
    if (values.empty()) return kAbsent;
    return fmt::format(fmt::runtime(format), *std::ranges::max_element(values) / unit);
}

std::string fps_text(const Cells& cells, std::uint64_t seed) {
    const auto interval = measure::run_interval(numbers(cells, "fps"), seed);
    if (!interval) return kAbsent;
    return fmt::format("{:.1f} ({:.1f}..{:.1f})", interval->centre, interval->low, interval->high);
}

std::string value_text(const Json::Value& value) {
    if (value.isString()) return value.asString();
    if (value.isBool()) return value.asBool() ? "true" : "false";
    if (value.isIntegral()) return fmt::format("{}", value.asInt64());
    return value.isNumeric() ? fmt::format("{}", value.asDouble()) : kAbsent;
}

/// Names of a method's parameters that have more than one value among its cells.
std::map<std::string, std::set<std::string>> swept_names(const std::vector<Json::Value>& cells) {
    std::map<std::string, std::map<std::string, std::set<std::string>>> values;
    for (const Json::Value& cell : cells) {
        const Json::Value& params = cell["params"];
        if (!params.isObject()) continue;
        for (const std::string& name : params.getMemberNames()) {
            values[cell["method"].asString()][name].insert(value_text(params[name]));
        }
    }
    std::map<std::string, std::set<std::string>> swept;
    for (const auto& [method, params] : values) {
        for (const auto& [name, texts] : params) {
            if (texts.size() > 1) swept[method].insert(name);
        }
    }
    return swept;
}

std::string label_of(const Json::Value& cell,
                     const std::map<std::string, std::set<std::string>>& swept) {
    std::string label = cell["method"].asString();
    const auto names = swept.find(label);
    if (names == swept.end()) return label;
    for (const std::string& name : names->second) {
        label += fmt::format(" {}={}", name, value_text(cell["params"][name]));
    }
    return label;
}

}  // namespace

const std::vector<std::string>& table_columns() {
    static const std::vector<std::string> columns = {
        "method",  "fps (range)", "median ms", "P90 ms", "max ms",   "triangles", "prepare s",
        "GPU MiB", "RSS MiB",     "P99.9 px",  "max px", "crack px", "pop px",    "honesty"};
    return columns;
}

std::vector<TableRow> table_rows(const std::vector<Json::Value>& cells, std::uint64_t seed) {
    const auto swept = swept_names(cells);
    std::map<std::pair<std::string, std::string>, Cells> groups;
    for (const Json::Value& cell : cells) {
        groups[{cell["scenario"].asString(), label_of(cell, swept)}].push_back(&cell);
    }
    std::vector<TableRow> rows;
    for (const auto& [key, members] : groups) {
        TableRow row{key.first, key.second, {}, {}};
        Cells good;
        for (const Json::Value* cell : members) {
            if ((*cell)["status"].asString() == "ok") {
                good.push_back(cell);
            } else {
                row.failures.push_back(
                    fmt::format("{} (repetition {}): {}", (*cell)["status"].asString(),
                                (*cell)["repetition"].asInt(), (*cell)["reason"].asString()));
            }
        }
        row.fields = {fps_text(good, seed),
                      median(numbers(good, "frame_ms", "median"), "{:.3f}"),
                      median(numbers(good, "frame_ms", "p90"), "{:.3f}"),
                      greatest(numbers(good, "frame_ms", "max"), "{:.3f}"),
                      median(numbers(good, "triangles", "mean"), "{:.0f}"),
                      median(numbers(good, "prepare_s"), "{:.3f}"),
                      median(numbers(good, "gpu_bytes"), "{:.1f}", kMebibyte),
                      greatest(numbers(good, "peak_rss_bytes"), "{:.0f}", kMebibyte),
                      median(numbers(good, "pixel_error_px", "p999"), "{:.2f}"),
                      median(numbers(good, "pixel_error_px", "max"), "{:.2f}"),
                      median(numbers(good, "crack_pixels", "total"), "{:.0f}"),
                      median(numbers(good, "popping_px", "p999"), "{:.2f}"),
                      median(numbers(good, "bound_honesty"), "{:.3f}")};
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
    std::string failures;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const TableRow& row = rows[r];
        if (r == 0 || row.scenario != rows[r - 1].scenario) {
            text += fmt::format("{}{}\n", r == 0 ? "" : "\n", row.scenario);
            text += line(columns[0], [&](std::size_t i) { return columns[i]; });
        }
        text += line(row.label, [&](std::size_t i) { return row.fields[i - 1]; });
        for (const std::string& failure : row.failures) {
            failures += fmt::format("  {}, {}: {}\n", row.label, row.scenario, failure);
        }
    }
    if (!failures.empty()) text += "\nNot measured\n" + failures;
    return text;
}

std::string markdown_table(const std::vector<TableRow>& rows) {
    std::string text;
    std::string failures;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const TableRow& row = rows[r];
        if (r == 0 || row.scenario != rows[r - 1].scenario) {
            text += fmt::format("{}## {}\n\n| {} |\n|---|", r == 0 ? "" : "\n", row.scenario,
                                fmt::join(table_columns(), " | "));
            for (std::size_t i = 1; i < table_columns().size(); ++i) text += "---:|";
            text += "\n";
        }
        text += fmt::format("| {} | {} |\n", row.label, fmt::join(row.fields, " | "));
        for (const std::string& failure : row.failures) {
            failures += fmt::format("- {}, {}: {}\n", row.label, row.scenario, failure);
        }
    }
    if (!failures.empty()) text += "\n## Not measured\n\n" + failures;
    return text;
}

}  // namespace lodbench::report
