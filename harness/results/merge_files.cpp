#include "results/merge_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

#include "api/error.h"
#include "base/files.h"
#include "results/folder.h"
#include "results/json.h"

namespace lodbench::results {

namespace fs = std::filesystem;
using Keep = base::Keep;

namespace {

/// The longest name of which a file is one: NAME.* or NAME__*.
const Taken* owner_of(const std::string& file, const std::map<std::string, const Taken*>& names) {
    for (std::size_t end = file.size(); end > 0; --end) {
        if (end < file.size() && file[end] != '.' && file.compare(end, 2, "__") != 0) continue;
        const auto found = names.find(file.substr(0, end));
        if (found != names.end()) return found->second;
    }
    return nullptr;
}

void copy_new(const fs::path& from, const fs::path& to) {
    std::error_code error;
    if (fs::exists(to) || fs::copy_file(from, to, error)) return;
    throw EnvironmentError(
        fmt::format("cannot copy {} to {}: {}", from.string(), to.string(), error.message()));
}

std::vector<fs::path> plain_files(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
        if (!entry.is_symlink() && entry.is_regular_file()) files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

}  // namespace

void copy_files_of_cells(const MergeInput& input, const std::vector<const Taken*>& taken,
                         const fs::path& out) {
    std::map<std::string, const Taken*> names;
    for (const Taken* cell : taken) names.emplace(cell->cell->record.cell, cell);
    for (const char* part : {"shots", "logs"}) {
        for (const fs::path& file : plain_files(input.path / part)) {
            const std::string name = file.filename().string();
            const Taken* cell = owner_of(name, names);
            if (cell == nullptr) continue;
            const std::string rest = name.substr(cell->cell->record.cell.size());
            copy_new(file, out / part / (cell->name + rest));
        }
    }
}

std::string write_cell(const Taken& taken, const fs::path& out) {
    const CellRecord& record = taken.cell->record;
    if (!record.frames_checksum.empty() || record.status == CellStatus::ok) {
        const fs::path file = taken.input->path / "frames" / (record.cell + ".csv");
        expect_plain_file(file);
        if (!fs::exists(file)) {
            throw InputError(
                fmt::format("{}: there is no such file, and {} names its cell: copy the folder "
                            "again, with its frames",
                            file.string(), taken.cell->where));
        }
        const std::string csv = base::read_text(file);
        expect_frames(record, csv, file.string());
        base::write_whole(out / "frames" / (taken.name + ".csv"), csv, Keep::for_now);
    }
    if (taken.name == record.cell) return taken.cell->line + "\n";
    Json::Value json = parse_sealed(taken.cell->line, taken.cell->where);
    json["cell"] = taken.name;
    return seal(json) + "\n";
}

void copy_scenarios(const std::vector<MergeInput>& inputs, const fs::path& out) {
    std::map<std::string, fs::path> known;
    for (const MergeInput& input : inputs) {
        for (const ScenarioContext& scenario : input.run.scenarios) {
            const std::string file = scenario.name + ".toml";
            const fs::path here = input.path / "scenarios" / file;
            expect_plain_file(here);
            if (fs::exists(here) && base::read_text(here) != scenario.text) {
                throw InputError(fmt::format("{}: this is not the text of {}; {}", here.string(),
                                             input.where(), kCopyAgain));
            }
            base::write_whole(out / "scenarios" / file, scenario.text, Keep::for_now);
        }
        for (const fs::path& file : plain_files(input.path / "scenarios")) {
            if (file.extension() == ".toml" || file.extension() == ".tmp") continue;
            const auto [first, is_new] = known.try_emplace(file.filename().string(), file);
            if (is_new) {
                copy_new(file, out / "scenarios" / file.filename());
            } else if (base::read_text(first->second) != base::read_text(file)) {
                throw InputError(fmt::format("{} and {} differ; {}", first->second.string(),
                                             file.string(), kCopyAgain));
            }
        }
    }
}

void copy_flights(const std::vector<MergeInput>& inputs, const fs::path& out,
                  std::vector<std::string>& warnings) {
    std::map<std::string, std::pair<fs::path, std::string>> known;  // with its text's checksum
    for (const MergeInput& input : inputs) {
        for (const fs::path& file : plain_files(input.path / "flights")) {
            const std::string name = file.filename().string();
            if (name.starts_with('.')) continue;
            const std::string text = base::read_text(file);
            if (file.extension() == ".json") (void)parse_sealed(text, file.string());
            const auto [first, is_new] = known.try_emplace(name, file, checksum_of(text));
            if (is_new) {
                copy_new(file, out / "flights" / name);
            } else if (first->second.second != checksum_of(text)) {
                warnings.push_back(fmt::format("{} and {} differ; the first is kept",
                                               first->second.first.string(), file.string()));
            }
        }
    }
}

}  // namespace lodbench::results
