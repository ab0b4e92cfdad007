#include "compare/baseline.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "api/error.h"
#include "base/files.h"
#include "results/deterministic.h"
#include "results/json.h"

namespace lodbench::compare {

namespace fs = std::filesystem;
using results::CellRecord;
using results::DeterministicField;
using results::Elsewhere;

namespace {

/// Depends on the last bits of the rasteriser's depths, which another processor may round
/// otherwise.
bool is_hash_of_pictures(const DeterministicField& field) {
    return std::string_view(field.name) == "shots_hash";
}

/// Which cell it is, and what does not change from flight to flight.
Json::Value kept_of(const CellRecord& cell) {
    const Json::Value all = to_json(cell);
    Json::Value kept;
    for (const char* name : {"cell", "method", "scenario", "params", "repetition", "status"}) {
        kept[name] = all[name];
    }
    for (const DeterministicField& field : results::deterministic_fields()) {
        if (field.elsewhere == Elsewhere::never || is_hash_of_pictures(field)) continue;
        kept[field.name] = all[field.name];
    }
    return kept;
}

results::RunRecord context_of(const results::RunRecord& run) {
    results::RunRecord context;
    context.tool_version = run.tool_version;
    context.commit = run.commit;
    context.build_type = run.build_type;
    context.compiler = run.compiler;
    context.os = run.os;
    context.cpu = run.cpu;
    context.seed = run.seed;
    context.overrides = run.overrides;
    if (run.gl) {
        context.gl.emplace();
        context.gl->vendor = run.gl->vendor;
        context.gl->renderer = run.gl->renderer;
        context.gl->version = run.gl->version;
    }
    for (const results::ScenarioContext& scenario : run.scenarios) {
        results::ScenarioContext& kept = context.scenarios.emplace_back();
        kept.name = scenario.name;
        kept.text = scenario.text;
        kept.frames = scenario.frames;
    }
    context.baseline_of = run.campaign;
    return context;
}

std::string frames_of(const results::FrameTable& table) {
    std::vector<const std::vector<double>*> columns;
    std::string text = "frame";
    for (const DeterministicField& column : results::deterministic_columns()) {
        const std::vector<double>* values = table.find(column.name);
        if (values == nullptr || column.elsewhere != Elsewhere::exactly) continue;
        columns.push_back(values);
        text += fmt::format(",{}", column.name);
    }
    text += "\n";
    for (std::size_t row = 0; row < table.rows; ++row) {
        text += fmt::format("{}", row);
        for (const std::vector<double>* column : columns) {
            const double value = (*column)[row];
            text += std::isnan(value) ? "," : fmt::format(",{}", value);
        }
        text += "\n";
    }
    return text;
}

/// The first repetition of each setting, in the order of their names.
std::vector<const CellRecord*> first_repetitions(const results::ResultFolder& run) {
    std::map<std::tuple<std::string, std::string, std::string>, const CellRecord*> first;
    for (const CellRecord& cell : run.cells) {
        if (cell.status != results::CellStatus::ok) {
            throw InputError(
                fmt::format("{}: cell '{}' is {}: {}; a baseline is made of cells that "
                            "are ok",
                            run.path.string(), cell.cell, name_of(cell.status), cell.reason));
        }
        const std::string params = results::to_text(to_json(cell)["params"]);
        const CellRecord*& known = first[{cell.scenario, cell.method, params}];
        if (known == nullptr || cell.repetition < known->repetition) known = &cell;
    }
    std::vector<const CellRecord*> cells;
    for (const auto& [key, cell] : first) cells.push_back(cell);
    return cells;
}

void refuse_other_folder(const fs::path& out) {
    if (!fs::exists(out) || fs::is_empty(out)) return;
    if (fs::is_regular_file(out / "run.json") && !results::read_run(out).baseline_of.empty())
        return;
    throw InputError(
        fmt::format("{}: this folder is not empty and no baseline; name another", out.string()));
}

/// Of a baseline's cells that are no more.
void remove_other_frames(const fs::path& frames, const std::set<std::string>& kept) {
    for (const auto& file : fs::directory_iterator(frames)) {
        if (file.path().extension() == ".csv" && !kept.contains(file.path().filename().string())) {
            fs::remove(file.path());
        }
    }
}

void write_files(const results::ResultFolder& run, const std::vector<const CellRecord*>& cells,
                 const fs::path& out) {
    std::string lines;
    std::set<std::string> files;
    fs::create_directories(out / "frames");
    for (const CellRecord* cell : cells) {
        const auto table = run.frames.find(cell->cell);
        if (table == run.frames.end()) {
            throw InputError(
                fmt::format("{}: there are no frames of cell '{}'; copy the folder "
                            "again, with its frames",
                            run.path.string(), cell->cell));
        }
        const std::string csv = frames_of(table->second);
        Json::Value kept = kept_of(*cell);
        kept["frames_checksum"] = results::checksum_of(csv);
        lines += results::seal(kept) + "\n";
        files.insert(cell->cell + ".csv");
        base::write_whole(out / "frames" / (cell->cell + ".csv"), csv);
    }
    base::write_whole(out / "cells.jsonl", lines);
    results::write_run(context_of(run.run), out);
    remove_other_frames(out / "frames", files);
}

}  // namespace

void write_baseline(const results::ResultFolder& run, const fs::path& out) {
    refuse_other_folder(out);
    if (!run.warnings.empty()) {
        throw InputError(fmt::format("{}: {}", run.path.string(), run.warnings.front()));
    }
    const auto cells = first_repetitions(run);  // refuses before anything is written
    try {
        write_files(run, cells, out);
    } catch (const fs::filesystem_error& error) {
        throw EnvironmentError(
            fmt::format("cannot write the baseline {}: {}", out.string(), error.what()));
    }
}

}  // namespace lodbench::compare
