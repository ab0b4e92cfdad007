#include "results/merge_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "api/error.h"
#include "base/files.h"
#include "results/folder.h"
#include "results/json.h"

namespace lodbench::results {

namespace fs = std::filesystem;

namespace {

/// Of run.json: by which program and from what the cells come.
constexpr std::string_view kProgram[] = {"schema_version", "tool_version", "commit",
                                         "build_type",     "compiler",     "abi_tag",
                                         "seed",           "overrides",    "campaign_cells"};
/// Of a scenario: where its files lay says nothing of it.
constexpr std::string_view kPlaces[] = {"file", "flight_file"};

[[noreturn]] void refuse(const std::string& first, const std::string& second,
                         const std::string& field, const std::string& a, const std::string& b) {
    throw InputError(
        fmt::format("{} and {} were not flown by one protocol: '{}' is {} and {}; merge only what "
                    "was flown by the same command with the same lodbench and files",
                    first, second, field, a, b));
}

/// The first line in which two texts differ, of either.
std::pair<std::string, std::string> first_difference(std::string_view a, std::string_view b) {
    while (true) {
        const std::string_view left = a.substr(0, a.find('\n'));
        const std::string_view right = b.substr(0, b.find('\n'));
        if (left != right || left.size() == a.size() || right.size() == b.size()) {
            return {fmt::format("'{}'", left), fmt::format("'{}'", right)};
        }
        a.remove_prefix(left.size() + 1);
        b.remove_prefix(right.size() + 1);
    }
}

void expect_same(const MergeInput& first, const MergeInput& other, const Json::Value& a,
                 const Json::Value& b, const std::string& field) {
    if (a == b) return;
    if (a.isString() && b.isString()) {
        const auto [left, right] = first_difference(a.asString(), b.asString());
        refuse(first.where(), other.where(), field, left, right);
    }
    refuse(first.where(), other.where(), field, to_text(a), to_text(b));
}

/// Of the first cell that has it: its value, and where.
struct Origin {
    std::string value, where;
};

void expect_one(std::map<std::string, Origin>& known, const std::string& key,
                const std::string& value, const MergeInput::Cell& cell, const char* field) {
    if (value.empty()) return;  // it failed before it was known
    const auto [origin, is_new] = known.try_emplace(key, Origin{value, cell.where});
    if (is_new || origin->second.value == value) return;
    refuse(origin->second.where, cell.where, fmt::format("{} of {}", field, key),
           origin->second.value, value);
}

/// Of run.json, and of what a merged one keeps of others.
void check_shard(const RunRecord& run, const std::string& where) {
    expect_field(!run.shard || (run.shard->number > 0 && run.shard->count > 0), where, "shard",
                 "an object with 'number' and 'count' above 0");
}

void read_finished(MergeInput& input) {
    const fs::path file = input.path / "cells.jsonl";
    expect_plain_file(file);
    if (!fs::exists(file)) return;  // none is finished yet
    const std::string text = base::read_text(file);
    std::set<std::string> names;
    std::size_t line = 1;
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = text.find('\n', begin)) != text.npos; begin = end + 1) {
        MergeInput::Cell cell;
        cell.where = fmt::format("{}:{}", file.string(), line++);
        cell.line = text.substr(begin, end - begin);
        cell.record = read_cell(parse_sealed(cell.line, cell.where), cell.where);
        cell.name = name_without_device(cell.record);
        const std::string& name = cell.record.cell;
        if (!names.insert(name).second) {
            throw InputError(fmt::format("{}: cell '{}' is there twice; remove one of its lines",
                                         cell.where, name));
        }
        if (!input.planned.contains(name)) {
            throw InputError(fmt::format("{}: cell '{}' is not among the 'cells' of {}; {}",
                                         cell.where, name, input.where(), kCopyAgain));
        }
        input.cells.push_back(std::move(cell));
    }
    if (begin != text.size()) {
        input.warnings.push_back(
            fmt::format("{}:{}: the line is incomplete (its writer was stopped) and left out",
                        file.string(), line));
    }
}

}  // namespace

std::string name_on_device(const std::string& name, const std::string& device) {
    return fmt::format("{}__on-{}", name, checksum_of(device).substr(0, 8));
}

std::string name_without_device(const CellRecord& cell) {
    const std::string ending = name_on_device("", cell.device);
    return cell.cell.ends_with(ending) ? cell.cell.substr(0, cell.cell.size() - ending.size())
                                       : cell.cell;
}

int MergeInput::shard() const {
    return run.shard ? run.shard->number : 0;
}

MergeInput read_merge_input(const fs::path& folder) {
    MergeInput input;
    input.path = folder;
    expect_plain_file(folder / "run.json");
    expect_plain_file(folder / "match.json");
    if (fs::exists(folder / "match.json")) {
        throw InputError(fmt::format(
            "{}: a search is not flown in parts, and its folder cannot be merged; leave it out",
            (folder / "match.json").string()));
    }
    input.run = read_run(folder);
    check_shard(input.run, input.where());
    for (const RunRecord& part : input.run.shards) check_shard(part, input.where());
    expect_field(input.run.campaign_cells.has_value(), input.where(), "campaign_cells",
                 "a whole number (run.json of an older version has none: merge with that one)");
    input.checksum = checksum_of(to_text(encode(input.run)));
    for (PlannedRecord& cell : std::exchange(input.run.cells, {})) {
        const std::string name = cell.id;
        expect_file_name(name, "cell", input.where());
        expect_field(cell.place.has_value(), input.where(), "cells.place", "a whole number");
        if (!input.planned.emplace(name, std::move(cell)).second) {
            throw InputError(fmt::format("{}: cell '{}' is among its 'cells' twice; {}",
                                         input.where(), name, kCopyAgain));
        }
    }
    for (const ScenarioContext& scenario : input.run.scenarios) {
        expect_file_name(scenario.name, "scenario", input.where());
    }
    read_finished(input);
    return input;
}

void expect_one_protocol(const std::vector<MergeInput>& inputs) {
    std::map<std::string, std::pair<const ScenarioContext*, const MergeInput*>> scenarios;
    std::map<std::string, Origin> terrains;
    std::map<std::string, Origin> plugins;
    for (const MergeInput& input : inputs) {
        const MergeInput& first = inputs.front();
        each_field<RunRecord>([&](const auto& field) {
            if (std::ranges::count(kProgram, field.name) == 0) return;
            expect_same(first, input, encode(first.run.*field.member),
                        encode(input.run.*field.member), field.name);
        });
        for (const ScenarioContext& scenario : input.run.scenarios) {
            const auto [known, is_new] = scenarios.try_emplace(scenario.name, &scenario, &input);
            const auto& [other, origin] = known->second;
            each_field<ScenarioContext>([&, other = other, origin = origin](const auto& field) {
                if (std::ranges::count(kPlaces, field.name) > 0) return;
                expect_same(*origin, input, encode(other->*field.member),
                            encode(scenario.*field.member),
                            fmt::format("scenarios.{}.{}", scenario.name, field.name));
            });
        }
        expect_same(first, input, first.run.campaign, input.run.campaign,
                    "campaign, the checksum of its list of cells");
        for (const MergeInput::Cell& cell : input.cells) {
            const CellRecord& record = cell.record;
            expect_one(terrains, record.scenario, record.terrain_checksum, cell,
                       "terrain_checksum");
            expect_one(plugins, record.method, record.plugin_checksum, cell, "plugin_checksum");
        }
    }
}

}  // namespace lodbench::results
