// What the numbers depend on: machine, driver, scenarios, seed and warnings; and every cell.

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <string>

#include "report/html/figures.h"
#include "report/html/sections.h"
#include "report/html/text.h"
#include "results/deterministic.h"
#include "results/health.h"
#include "results/json.h"

namespace lodbench::report::html {

using namespace results::figures;

namespace {

std::string definition(const char* term, const std::string& value) {
    if (value.empty()) return {};
    return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", term, escape(value));
}

template <typename Number>
std::string definition(const char* term, const std::optional<Number>& value) {
    return value ? definition(term, fmt::format("{}", *value)) : std::string();
}

std::string count_text(std::optional<int> count) {
    return count ? std::to_string(*count) : "-";
}

/// Each warning once; those that the run does not raise with the number of cells that do.
std::vector<std::string> warnings_of(const results::ResultFolder& folder) {
    std::vector<std::string> texts = folder.warnings;
    std::ranges::copy(folder.run.warnings, std::back_inserter(texts));
    for (const std::string& noise : folder.run.noise) texts.push_back("noise: " + noise);
    std::map<std::string, std::vector<std::string>> cells;
    for (const results::CellRecord& cell : folder.cells) {
        if (!cell.noise.empty())
            texts.push_back(fmt::format("noise: {}: {}", cell.cell, cell.noise));
        for (const std::string& warning : cell.warnings) cells[warning].push_back(cell.cell);
    }
    for (const auto& [warning, names] : cells) {
        if (std::ranges::find(texts, warning) != texts.end()) continue;
        texts.push_back(names.size() == 1 ? fmt::format("{} ({})", warning, names.front())
                                          : fmt::format("{} ({} and {} more)", warning,
                                                        names.front(), names.size() - 1));
    }
    for (const results::CellGroup& group : results::group_cells(folder.cells)) {
        for (const std::string& text : results::health_words(group.good)) {
            texts.push_back(
                fmt::format("noise: {}, {}: {}", group.label, group.comparison(), text));
        }
        for (const std::string& text : results::disagreements_of(group)) {
            texts.push_back(fmt::format("{}, {}: {}", group.label, group.comparison(), text));
        }
    }
    std::ranges::copy(results::device_differences(folder.cells), std::back_inserter(texts));
    std::ranges::copy(results::borrowed_truth(folder.cells), std::back_inserter(texts));
    return texts;
}

/// What one must know of the numbers before one reads them.
std::string conditions_html(const results::ResultFolder& folder) {
    const results::RunRecord& run = folder.run;
    const results::GlContext gl = run.gl.value_or(results::GlContext());
    std::string html = "<dl class=\"conditions\">\n";
    html += definition("Results", folder.name);
    html += definition("Renderer", gl.software.value_or(false)
                                       ? gl.renderer +
                                             ", in software: times compare methods on this "
                                             "machine, no more"
                                       : gl.renderer);
    html += definition("Timer", gl.timer_verdict);
    html += definition("CPU", run.cpu);
    if (const auto devices = results::devices_of(folder.cells); devices.size() > 1) {
        for (const std::string& device : devices) html += definition("Device", device);
    }
    html += definition(
        "lodbench", fmt::format("{}, {}", run.tool_version, run.commit.empty() ? "-" : run.commit));
    return html + "</dl>\n";
}

std::string machine_html(const results::ResultFolder& folder) {
    const results::RunRecord& run = folder.run;
    const results::GlContext gl = run.gl.value_or(results::GlContext());
    const results::HealthContext health = run.health.value_or(results::HealthContext());
    std::string html = "<dl class=\"conditions\">\n";
    html += definition("Command", run.command_line);
    html += definition("Seed", std::to_string(run.seed));
    html += definition("System", run.os);
    html += definition("Kernel", run.kernel);
    html += definition("Cores", run.cores);
    html += definition("OpenGL", gl.version);
    html += definition("Device", gl.device);
    html += definition("GPU's sensors", health.gpu ? health.gpu->source : health.gpu_absent);
    html += definition("CPU governor", health.cpu_governor);
    html += definition("Cool-down, s", run.cool_down_s);
    html += definition("Build", run.build_type);
    html += definition("Compiler", run.compiler);
    return html + "</dl>\n";
}

/// The numbers of a cell that are a number each, in one row.
constexpr FigureColumn kCellColumns[] = {
    {"frames", of<&Cell::frames>, 0},
    {"fps", of<&Cell::fps>, 1},
    {"mean, ms", of<&Cell::frame_ms, &TimeSummary::mean>, 3},
    {"median, ms", of<&Cell::frame_ms, &TimeSummary::median>, 3},
    {"P90, ms", of<&Cell::frame_ms, &TimeSummary::p90>, 3},
    {"P99, ms", of<&Cell::frame_ms, &TimeSummary::p99>, 3},
    {"max, ms", of<&Cell::frame_ms, &TimeSummary::max>, 3},
    {"triangles", of<&Cell::triangles, &CountSummary::mean>, 0},
    {"prepare, s", of<&Cell::prepare_s>, 3},
    {"GPU, bytes", of<&Cell::gpu_bytes>, 0},
    {"RSS, bytes", of<&Cell::peak_rss_bytes>, 0},
    {"screen max, px", of<&Cell::screen_error_px, &ErrorFigures::max>, 3},
    {"pixel max, px", of<&Cell::pixel_error_px, &ErrorFigures::max>, 3},
    {"pixel P99.9, px", of<&Cell::pixel_error_px, &ErrorFigures::p999>, 3},
    {"at pace P99.9, px", of<&Cell::pixel_error_realtime_px, &ErrorFigures::p999>, 3},
    {"cracks, px", of<&Cell::crack_pixels, &TotalAndMax::total>, 0},
    {"popping P99.9, px", of<&Cell::popping_px, &PoppingFigures::p999>, 3},
    {"honesty", of<&Cell::bound_honesty>, 3},
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
        for (const results::ScenarioContext& scenario : folder.run.scenarios) {
            page.open_details(
                fmt::format("Scenario {}, as its file says; flown were {} frames of {} × {} pixels",
                            scenario.name, count_text(scenario.frames), count_text(scenario.width),
                            count_text(scenario.height)));
            page.raw("<pre tabindex=\"0\">" + escape(scenario.text) + "</pre>\n");
            page.close_details();
        }
        results::RunRecord run = folder.run;
        run.cells.clear();
        for (results::ScenarioContext& scenario : run.scenarios) scenario.text.clear();
        page.open_details("run.json");
        page.raw("<pre tabindex=\"0\">" + escape(results::to_text(encode(run), true)) + "</pre>\n");
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
        for (const results::CellRecord& cell : folder.cells) {
            std::string params;
            for (const auto& [name, value] : cell.params.values()) {
                params += fmt::format("{}{}={}", params.empty() ? "" : " ", name,
                                      results::value_text(value));
            }
            table.settings.push_back(setting_of(cell));
            std::vector<Field>& row = table.rows.emplace_back();
            row = {text_field(cell.cell), text_field(cell.scenario), text_field(params),
                   number_field(cell.repetition, 0), text_field(name_of(cell.status))};
            add_fields(row, kCellColumns, std::vector{&cell});
        }
        page.open_details(fmt::format("{} cells of {}", folder.cells.size(), folder.name));
        page.table(table, table.rows.size());
        page.close_details();
    }
}

}  // namespace lodbench::report::html
