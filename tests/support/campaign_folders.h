#pragma once
// Results folders of a campaign that nobody flew: whole, or any part of it.

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "results/cell.h"
#include "results/json.h"

namespace lodbench::test {

struct FakeCampaign {
    int scenarios = 2, methods = 3, repetitions = 4, frames = 3;
    std::string device = "renderer A, OpenGL 4.5; processor, 8 cores";

    struct Cell {
        results::CellRecord record;
        std::string csv;
        std::size_t place = 0;
    };

    /// In the order of flight. Times depend on `run`: another flight of the same cells.
    [[nodiscard]] std::vector<Cell> cells(int run = 0) const {
        std::vector<Cell> cells;
        for (int r = 0; r < repetitions; ++r) {
            for (int s = 0; s < scenarios; ++s) {
                for (int m = 0; m < methods; ++m) cells.push_back(cell(r, s, m, run, cells.size()));
            }
        }
        return cells;
    }

    [[nodiscard]] Json::Value run_json(const std::vector<Cell>& planned, int number,
                                       int count) const {
        Json::Value run;
        run["schema_version"] = results::kSchemaVersion;
        run["tool_version"] = "1.0";
        run["commit"] = "0123456";
        run["seed"] = 7;
        run["cpu"] = "processor";
        run["cores"] = 8;
        run["command_line"] = fmt::format("lodbench run --shard {}/{}", number, count);
        run["started"] = fmt::format("2026-01-01T00:00:{:02}Z", number % 60);
        run["overrides"] = Json::objectValue;
        run["gl"]["renderer"] = device.substr(0, device.find(','));
        run["campaign"] = "0000000000000001";
        run["campaign_cells"] = scenarios * methods * repetitions;
        run["shard"]["number"] = number;
        run["shard"]["count"] = count;
        run["warnings"] = Json::arrayValue;
        run["noise"] = Json::arrayValue;
        run["plugins"] = Json::arrayValue;
        run["scenarios"] = Json::arrayValue;
        for (int s = 0; s < scenarios; ++s) {
            Json::Value scenario;
            scenario["name"] = fmt::format("s{}", s);
            scenario["file"] = fmt::format("/home/{}/s{}.toml", number, s);
            scenario["text"] = fmt::format("name = \"s{}\"\n[run]\nseed = 7\n", s);
            scenario["frames"] = frames;
            run["scenarios"].append(scenario);
        }
        run["cells"] = Json::arrayValue;
        for (const Cell& cell : planned) {
            Json::Value json;
            json["id"] = cell.record.cell;
            json["scenario"] = cell.record.scenario;
            json["method"] = cell.record.method;
            json["repetition"] = cell.record.repetition;
            json["place"] = Json::UInt64(cell.place);
            run["cells"].append(json);
        }
        return run;
    }

    /// `planned` stands in its run.json; of them `finished` are flown.
    void write(const std::filesystem::path& folder, const std::vector<Cell>& planned,
               const std::vector<Cell>& finished, int number, int count) const {
        namespace fs = std::filesystem;
        for (const char* part : {"frames", "scenarios", "flights", "shots", "logs"}) {
            fs::create_directories(folder / part);
        }
        const Json::Value run = run_json(planned, number, count);
        put(folder / "run.json", results::to_text(run, true) + "\n");
        for (const Json::Value& scenario : run["scenarios"]) {
            put(folder / "scenarios" / (scenario["name"].asString() + ".toml"),
                scenario["text"].asString());
        }
        std::string lines;
        for (const Cell& cell : finished) {
            lines += results::seal(to_json(cell.record)) + "\n";
            put(folder / "frames" / (cell.record.cell + ".csv"), cell.csv);
            put(folder / "shots" / (cell.record.cell + "__f00000.png"), "picture of " + cell.csv);
            put(folder / "logs" / (cell.record.cell + ".log"), "");
        }
        if (!finished.empty()) put(folder / "cells.jsonl", lines);
    }

    static void put(const std::filesystem::path& file, const std::string& text) {
        std::ofstream(file, std::ios::binary) << text;
    }

private:
    [[nodiscard]] Cell cell(int r, int s, int m, int run, std::size_t place) const {
        Cell cell;
        cell.place = place;
        std::vector<results::FrameRecord> flown;
        for (int f = 0; f < frames; ++f) {
            results::FrameRecord& frame = flown.emplace_back();
            frame.frame = f;
            frame.wall_ms = 10 + m + 0.25 * r + run;
            frame.triangles = std::uint64_t(1000 * m + f);
            frame.draw_calls = 1;
        }
        results::CellResult result;
        result.frames = flown;
        result.cell.status = results::CellStatus::ok;
        result.cell.terrain_checksum = fmt::format("000000000000000{}", s);
        result.cell.plugin_checksum = fmt::format("{:016x}", m);
        result.cell.shots_hash = fmt::format("{:016x}", 100 * s + m);
        result.cell.device = device;
        const std::string name = fmt::format("m{}__s{}__r{}", m, s, r);
        results::CellName id{name, fmt::format("s{}", s), fmt::format("m{}", m), {},
                             r,    1000 + place};
        cell.record = results::finish_cell(id, result, 16.67);
        cell.csv = results::frames_csv(flown);
        cell.record.frames_checksum = results::checksum_of(cell.csv);
        return cell;
    }
};

}  // namespace lodbench::test
