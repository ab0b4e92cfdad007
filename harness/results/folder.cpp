#include "results/folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>

#include "api/error.h"
#include "base/files.h"
#include "results/json.h"

namespace lodbench::results {

namespace fs = std::filesystem;

namespace {

constexpr std::array<std::string_view, 5> kKeptColumns = {"frame", "wall_ms", "triangles",
                                                          "pixel_p999_px", "popping_p999_px"};

std::string read_input(const fs::path& file, const char* remedy) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) {
        throw InputError(fmt::format("{}: there is no such file; {}", file.string(), remedy));
    }
    return base::read_text(file);
}

/// The fields of a line that has no quotes.
void split(std::string_view line, std::vector<std::string_view>& fields) {
    fields.clear();
    while (true) {
        const std::size_t comma = line.find(',');
        fields.push_back(line.substr(0, comma));
        if (comma == line.npos) return;
        line.remove_prefix(comma + 1);
    }
}

double parse_field(std::string_view text, std::string_view column, const std::string& where,
                   std::size_t line) {
    if (text.empty()) return NAN;
    double value = NAN;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    if (read.ec != std::errc() || read.ptr != text.data() + text.size() || std::isnan(value)) {
        throw InputError(fmt::format("{}:{}: '{}' in column {} is no number; {}", where, line, text,
                                     column, kCopyAgain));
    }
    return value;
}

void read_cells(ResultFolder& folder) {
    const fs::path file = folder.path / "cells.jsonl";
    const std::string text = read_input(file,
                                        "no cell of the run is finished; finish it with "
                                        "`lodbench run --resume --out DIR`");
    std::set<std::string> ids;
    std::size_t line = 1;
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = text.find('\n', begin)) != text.npos; begin = end + 1) {
        const std::string where = fmt::format("{}:{}", file.string(), line++);
        CellRecord cell = read_cell(
            parse_sealed(std::string_view(text).substr(begin, end - begin), where), where);
        if (!ids.insert(cell.cell).second) {
            throw InputError(fmt::format("{}: cell '{}' is there twice; remove one of its lines",
                                         where, cell.cell));
        }
        folder.cells.push_back(std::move(cell));
    }
    if (begin != text.size()) {
        folder.warnings.push_back(
            "the last line of cells.jsonl is incomplete (its writer was stopped) and left out");
    }
    const std::size_t planned = folder.run.cells.size();
    if (planned > folder.cells.size()) {
        folder.warnings.push_back(fmt::format(
            "{} of the {} cells that were planned are not flown; finish them with --resume",
            planned - folder.cells.size(), planned));
    }
}

glm::dvec3 read_vector(const Json::Value& value, const std::string& where) {
    glm::dvec3 result{0.0};
    for (Json::ArrayIndex i = 0; i < 3; ++i) {
        if (!value.isArray() || value.size() != 3 || !value[i].isNumeric()) {
            throw InputError(fmt::format("{}: expected three numbers; {}", where, kCopyAgain));
        }
        result[int(i)] = value[i].asDouble();
    }
    return result;
}

std::vector<NeededTiles> read_needed(const Json::Value& flight, const std::string& file) {
    std::vector<NeededTiles> needed;
    if (!flight.isMember("needed")) return needed;
    const std::string where = file + ": needed";
    for (const Json::Value& json : get_array(flight, "needed", file)) {
        NeededTiles entry;
        entry.target_px = get_number(json, "target_px", where);
        expect_field(entry.target_px > (needed.empty() ? 0 : needed.back().target_px), where,
                     "target_px", "positive and rising");
        entry.tiles = get_number(json, "tiles", where);
        entry.samples = get_number(json, "samples", where);
        entry.most_tiles_in_a_frame = get_number(json, "most_tiles_in_a_frame", where);
        expect_field(entry.tiles >= 0 && entry.samples >= 0 && entry.most_tiles_in_a_frame >= 0,
                     where, "tiles, samples, most_tiles_in_a_frame", "at least 0");
        needed.push_back(entry);
    }
    return needed;
}

FlightRecord read_flight(const fs::path& file, const fs::path& picture) {
    const std::string where = file.string();
    const Json::Value json = parse_sealed(base::read_text(file), where);
    check_schema(json, file);
    const auto pair = [&](const char* key) {
        const Json::Value& value = get_array(json, key, where);
        if (value.size() != 2 || !value[0].isNumeric() || !value[1].isNumeric()) {
            throw InputError(
                fmt::format("{}: '{}': expected two numbers; {}", where, key, kCopyAgain));
        }
        return glm::dvec2(value[0].asDouble(), value[1].asDouble());
    };
    FlightRecord flight;
    flight.low = pair("south_west");
    flight.high = pair("north_east");
    flight.spacing = pair("spacing");
    if (!(flight.high.x > flight.low.x) || !(flight.high.y > flight.low.y)) {
        throw InputError(fmt::format("{}: the terrain has no extent; {}", where, kCopyAgain));
    }
    flight.rows = int(get_number(json, "rows", where));
    flight.columns = int(get_number(json, "columns", where));
    flight.min_height = get_number(json, "min_height", where);
    flight.max_height = get_number(json, "max_height", where);
    for (const Json::Value& value : get_array(json, "positions", where)) {
        flight.positions.push_back(read_vector(value, where + ": positions"));
    }
    for (const Json::Value& value : get_array(json, "directions", where)) {
        flight.directions.push_back(read_vector(value, where + ": directions"));
    }
    if (flight.positions.size() != flight.directions.size()) {
        throw InputError(fmt::format("{}: {} positions and {} directions; {}", where,
                                     flight.positions.size(), flight.directions.size(),
                                     kCopyAgain));
    }
    flight.needed = read_needed(json, where);
    if (fs::is_regular_file(picture)) flight.hillshade = picture;
    return flight;
}

void read_flights(ResultFolder& folder) {
    for (const CellRecord& cell : folder.cells) {
        const std::string& name = cell.scenario;
        if (!is_file_name(name) || folder.flights.contains(name)) continue;
        const fs::path file = folder.path / "flights" / (name + ".json");
        std::error_code absent;
        if (!fs::is_regular_file(file, absent)) continue;
        folder.flights.emplace(
            name, read_flight(file, folder.path / "flights" / (name + "__hillshade.png")));
    }
}

void read_search(ResultFolder& folder) {
    const fs::path file = folder.path / "match.json";
    std::error_code absent;
    if (!fs::is_regular_file(file, absent)) return;
    const Json::Value json = parse_sealed(base::read_text(file), file.string());
    check_schema(json, file);
    folder.match = read_match(json, file.string());
}

}  // namespace

void expect_plain_file(const fs::path& file) {
    std::error_code ignored;
    const fs::file_type type = fs::symlink_status(file, ignored).type();
    if (type == fs::file_type::not_found || type == fs::file_type::regular) return;
    throw InputError(
        fmt::format("{}: this is no plain file (but a link, pipe, folder or device); "
                    "put the file itself there",
                    file.string()));
}

const std::vector<double>* FrameTable::find(std::string_view column) const {
    const auto found = columns.find(column);
    return found == columns.end() ? nullptr : &found->second;
}

FramesWanted frames_of_report() {
    return {.columns = kKeptColumns};
}

FrameTable parse_frame_table(std::string_view csv, const std::string& where,
                             const FramesWanted& wanted) {
    FrameTable table;
    std::vector<std::string_view> names;
    std::vector<std::string_view> fields;
    std::vector<std::vector<double>*> columns;  // nullptr: not kept
    for (std::size_t line = 1; !csv.empty(); ++line) {
        const std::size_t end = csv.find('\n');
        if (end == csv.npos) {
            throw InputError(
                fmt::format("{}:{}: the line has no end; {}", where, line, kCopyAgain));
        }
        split(csv.substr(0, end), fields);
        csv.remove_prefix(end + 1);
        if (names.empty()) {
            names = fields;
            for (const std::string_view name : names) {
                const bool kept = std::ranges::find(wanted.columns, name) != wanted.columns.end();
                columns.push_back(kept ? &table.columns[std::string(name)] : nullptr);
            }
            continue;
        }
        if (fields.size() != names.size()) {
            throw InputError(fmt::format("{}:{}: {} fields, expected {}; {}", where, line,
                                         fields.size(), names.size(), kCopyAgain));
        }
        for (std::size_t i = 0; i < fields.size(); ++i) {
            const double value = parse_field(fields[i], names[i], where, line);
            if (columns[i] != nullptr) columns[i]->push_back(value);
        }
        ++table.rows;
    }
    for (const std::string_view name : {"frame", "wall_ms"}) {
        if (std::ranges::find(wanted.columns, name) != wanted.columns.end() &&
            !table.columns.contains(name)) {
            throw InputError(
                fmt::format("{}:1: there is no column '{}'; {}", where, name, kCopyAgain));
        }
    }
    std::erase_if(table.columns, [](const auto& column) {
        return std::ranges::all_of(column.second, [](double value) { return std::isnan(value); });
    });
    return table;
}

void expect_frames(const CellRecord& cell, std::string_view csv, const std::string& where) {
    const std::string& written = cell.frames_checksum;
    if (written.empty()) return;  // of an older version
    const std::string found = checksum_of(csv);
    if (written == found) return;
    throw InputError(fmt::format("{}: its checksum is {}, and cells.jsonl says {}; {}", where,
                                 found, written, kCopyAgain));
}

ResultFolder read_result_folder(const fs::path& path, const FramesWanted& wanted) {
    ResultFolder folder;
    folder.path = path;
    folder.name = fs::absolute(path).lexically_normal().filename().string();
    if (folder.name.empty()) {  // a slash at the end
        folder.name = fs::absolute(path).lexically_normal().parent_path().filename().string();
    }
    folder.run = read_run(path);
    read_cells(folder);
    for (const CellRecord& cell : folder.cells) {
        if (cell.status != CellStatus::ok) continue;
        const fs::path file = path / "frames" / (cell.cell + ".csv");
        if (!wanted.required && !fs::exists(file)) continue;
        const std::string csv =
            read_input(file, "cells.jsonl names its cell: copy the folder again, with its frames");
        expect_frames(cell, csv, file.string());
        folder.frames.emplace(cell.cell, parse_frame_table(csv, file.string(), wanted));
    }
    read_flights(folder);
    read_search(folder);
    return folder;
}

}  // namespace lodbench::results
