// What the numbers depend on: machine, driver, scenarios, seed and warnings; and every cell.

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "report/html/figures.h"
#include "report/html/sections.h"
#include "report/html/text.h"
#include "results/json.h"

namespace lodbench::report::html {

namespace {

std::string definition(const char* term, const Json::Value& value) {
    if (value.isNull() || value.isObject() || value.isArray()) return {};
    return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", term,
                       escape(results::value_text(value)));
}

/// Each warning once; those that the run does not raise with the number of cells that do.
std::vector<std::string> warnings_of(const results::ResultFolder& folder) {
    std::vector<std::string> texts = folder.warnings;
    for (const Json::Value& warning : folder.run["warnings"]) {
        if (warning.isString()) texts.push_back(warning.asString());
    }
    for (const Json::Value& noise : folder.run["noise"]) {
        if (noise.isString()) texts.push_back("noise: " + noise.asString());
    }
    std::map<std::string, std::vector<std::string>> cells;
    for (const Json::Value& cell : folder.cells) {
        if (cell["noise"].isString()) {
            texts.push_back(
                fmt::format("noise: {}: {}", cell["cell"].asString(), cell["noise"].asString()));
        }
        for (const Json::Value& warning : cell["warnings"]) {
            cells[warning.asString()].push_back(cell["cell"].asString());
        }
    }
    for (const auto& [warning, names] : cells) {
        if (std::ranges::find(texts, warning) != texts.end()) continue;
        texts.push_back(names.size() == 1 ? fmt::format("{} ({})", warning, names.front())
                                          : fmt::format("{} ({} and {} more)", warning,
                                                        names.front(), names.size() - 1));
    }
    for (const results::CellGroup& group : results::group_cells(folder.cells)) {
        for (const std::string& text : results::disagreements_of(group)) {
            texts.push_back(fmt::format("{}, {}: {}", group.label, group.scenario, text));
        }
    }
    return texts;
}

/// What one must know of the numbers before one reads them.
std::string conditions_html(const results::ResultFolder& folder) {
    const Json::Value& run = folder.run;
    const Json::Value& gl = run["gl"];
    std::string html = "<dl class=\"conditions\">\n";
    html += definition("Results", folder.name);
    const Json::Value& software = results::member_of(gl, "software");
    const std::string renderer = results::value_text(results::member_of(gl, "renderer"));
    html += definition("Renderer", software.isBool() && software.asBool()
                                       ? renderer +
                                             ", in software: times compare methods on this "
                                             "machine, no more"
                                       : renderer);
    html += definition("Timer", results::member_of(gl, "timer_verdict"));
    html += definition("CPU", run["cpu"]);
    html += definition("lodbench", fmt::format("{}, {}", results::value_text(run["tool_version"]),
                                               results::value_text(run["commit"])));
    return html + "</dl>\n";
}

std::string machine_html(const results::ResultFolder& folder) {
    const Json::Value& run = folder.run;
    const Json::Value& gl = run["gl"];
    std::string html = "<dl class=\"conditions\">\n";
    html += definition("Command", run["command_line"]);
    html += definition("Seed", run["seed"]);
    html += definition("System", run["os"]);
    html += definition("Kernel", run["kernel"]);
    html += definition("Cores", run["cores"]);
    html += definition("OpenGL", results::member_of(gl, "version"));
    html += definition("Device", results::member_of(gl, "device"));
    html += definition("Build", run["build_type"]);
    html += definition("Compiler", run["compiler"]);
    return html + "</dl>\n";
}

/// The numbers of a cell that are a number each, in one row.
constexpr FigureColumn kCellColumns[] = {
    {"frames", "frames", nullptr, 0},
    {"fps", "fps", nullptr, 1},
    {"mean, ms", "frame_ms", "mean", 3},
    {"median, ms", "frame_ms", "median", 3},
    {"P90, ms", "frame_ms", "p90", 3},
    {"P99, ms", "frame_ms", "p99", 3},
    {"max, ms", "frame_ms", "max", 3},
    {"triangles", "triangles", "mean", 0},
    {"prepare, s", "prepare_s", nullptr, 3},
    {"GPU, bytes", "gpu_bytes", nullptr, 0},
    {"RSS, bytes", "peak_rss_bytes", nullptr, 0},
    {"screen max, px", "screen_error_px", "max", 3},
    {"pixel max, px", "pixel_error_px", "max", 3},
    {"pixel P99.9, px", "pixel_error_px", "p999", 3},
    {"at pace P99.9, px", "pixel_error_realtime_px", "p999", 3},
    {"cracks, px", "crack_pixels", "total", 0},
    {"popping P99.9, px", "popping_px", "p999", 3},
    {"honesty", "bound_honesty", nullptr, 3},
};

}  // namespace

std::string lead_html(const ReportData& data) {
    std::string html;
    for (const results::ResultFolder& folder : *data.folders) html += conditions_html(folder);
    for (const results::ResultFolder& folder : *data.folders) {
        const std::vector<std::string> warnings = warnings_of(folder);
        if (warnings.empty()) continue;
        html += fmt::format(
            "<section class=\"warnings\" aria-label=\"Warnings of {0}\"><p><strong>{1} "
            "{2}</strong> in {0}</p>\n<ul>\n",
            escape(folder.name), warnings.size(), warnings.size() == 1 ? "warning" : "warnings");
        for (const std::string& warning : warnings) html += "<li>" + escape(warning) + "</li>\n";
        html += "</ul></section>\n";
    }
    return html;
}

void add_context(Page& page, const ReportData& data) {
    page.heading(2, "Context", "context");
    if (const auto& unusable = page.pictures().unusable(); !unusable.empty()) {
        page.heading(3, "Pictures that cannot be shown", "unusable-pictures");
        page.list(unusable);
    }
    for (const results::ResultFolder& folder : *data.folders) {
        if (data.folders->size() > 1) page.heading(3, folder.name);
        page.raw(machine_html(folder));
        for (const Json::Value& scenario : folder.run["scenarios"]) {
            if (!scenario.isObject()) continue;
            page.open_details(fmt::format(
                "Scenario {}, as its file says; flown were {} frames of {} × {} pixels",
                results::value_text(scenario["name"]), results::value_text(scenario["frames"]),
                results::value_text(scenario["width"]), results::value_text(scenario["height"])));
            page.raw("<pre tabindex=\"0\">" + escape(results::value_text(scenario["text"])) +
                     "</pre>\n");
            page.close_details();
        }
        Json::Value run = folder.run;
        run.removeMember("cells");
        if (run["scenarios"].isArray()) {
            for (Json::Value& scenario : run["scenarios"]) {
                if (scenario.isObject()) scenario.removeMember("text");
            }
        }
        page.open_details("run.json");
        page.raw("<pre tabindex=\"0\">" + escape(results::to_text(run, true)) + "</pre>\n");
        page.paragraph(
            "Without the list of planned cells and the scenarios' text, which stands above.",
            "note");
        page.close_details();
    }
}

void add_cells(Page& page, const ReportData& data) {
    page.heading(2, "Every cell", "cells");
    for (const results::ResultFolder& folder : *data.folders) {
        Table table;
        table.id = "cells";
        table.caption = "The cells of " + folder.name + ", as cells.jsonl has them";
        table.results = folder.name;
        table.columns = {{"cell", "cell", false},
                         {"scenario", "scenario", false},
                         {"parameters", "params", false},
                         {"repetition", "repetition"},
                         {"status", "status", false}};
        add_columns(table, kCellColumns);
        for (const Json::Value& cell : folder.cells) {
            std::string params;
            const Json::Value& values = cell["params"];
            for (auto param = values.begin(); param != values.end(); ++param) {
                params += fmt::format("{}{}={}", params.empty() ? "" : " ", param.name(),
                                      results::value_text(*param));
            }
            table.settings.push_back(setting_of(cell));
            std::vector<Field>& row = table.rows.emplace_back();
            row = {text_field(cell["cell"].asString()), text_field(cell["scenario"].asString()),
                   text_field(params), number_field(cell["repetition"].asInt(), 0),
                   text_field(cell["status"].asString())};
            add_fields(row, kCellColumns, {&cell});
        }
        page.open_details(fmt::format("{} cells of {}", folder.cells.size(), folder.name));
        page.table(table, table.rows.size());
        page.close_details();
    }
}

}  // namespace lodbench::report::html
