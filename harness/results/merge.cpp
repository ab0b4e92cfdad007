#include "results/merge.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <set>
#include <system_error>
#include <tuple>

#include "api/error.h"
#include "base/child_process.h"
#include "base/files.h"
#include "base/interrupts.h"
#include "results/alike.h"
#include "results/folder.h"
#include "results/json.h"
#include "results/merge_files.h"
#include "results/merge_input.h"

namespace lodbench::results {

namespace fs = std::filesystem;

namespace {

/// The folder beside `out` in which everything is written, and which takes its place at the end.
class Draft {
public:
    explicit Draft(fs::path out) : out_(std::move(out)) {
        std::error_code error;
        fs::create_directories(out_.parent_path(), error);
        std::string pattern =
            (out_.parent_path() / ("." + out_.filename().string() + ".merging-XXXXXX")).string();
        if (error || mkdtemp(pattern.data()) == nullptr) refuse(error ? error.value() : errno);
        path_ = pattern;
        fs::permissions(path_, fs::perms(0755), error);  // mkdtemp lets nobody else read it
    }
    ~Draft() {
        std::error_code ignored;
        if (!path_.empty()) fs::remove_all(path_, ignored);
    }
    Draft(const Draft&) = delete;
    Draft& operator=(const Draft&) = delete;

    [[nodiscard]] const fs::path& path() const { return path_; }

    /// Once all is written, and on the disk.
    void finish() {
        const base::FileDescriptor folder(open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
        if (!folder || syncfs(folder.number()) != 0) refuse(errno);
        std::error_code error;
        fs::remove(out_, error);  // an empty folder, or none
        fs::rename(path_, out_, error);
        if (error) refuse(error.value());
        path_.clear();
    }

private:
    [[noreturn]] void refuse(int error) const {
        throw EnvironmentError(
            fmt::format("cannot make the folder {}: {}; choose another with --out", out_.string(),
                        std::generic_category().message(error)));
    }
    fs::path out_, path_;
};

void heed_interrupt() {
    if (base::interrupted()) throw EnvironmentError("interrupted; nothing was written");
}

std::vector<MergeInput> read_inputs(const std::vector<fs::path>& folders) {
    std::vector<MergeInput> inputs;
    for (const fs::path& folder : folders) {
        heed_interrupt();
        inputs.push_back(read_merge_input(folder));
    }
    // What is taken from the first that has it does not depend on the order of the arguments.
    std::ranges::sort(inputs, {}, [](const MergeInput& input) {
        return std::tuple(input.shard(), input.checksum, input.path);
    });
    return inputs;
}

/// Names the first member in which two records differ.
[[noreturn]] void refuse_unlike(const MergeInput::Cell& a, const MergeInput::Cell& b) {
    const Json::Value left = to_json(a.record);
    const Json::Value right = to_json(b.record);
    for (const std::string& name : left.getMemberNames()) {
        if (name == "cell" || left[name] == right[name]) continue;
        throw InputError(fmt::format(
            "{} and {}: cell '{}' was flown twice on one device, and '{}' is {} and {}; a cell is "
            "measured once: leave one of the folders out",
            a.where, b.where, a.name, name, to_text(left[name]), to_text(right[name])));
    }
    throw InputError(
        fmt::format("{} and {}: cell '{}' has unlike frames; leave one of the folders "
                    "out",
                    a.where, b.where, a.name));
}

bool is_equal(const MergeInput::Cell& a, const MergeInput::Cell& b) {
    CellRecord left = a.record;
    CellRecord right = b.record;
    left.cell = right.cell = a.name;
    return to_json(left) == to_json(right);
}

template <typename T>
bool same(const T& a, const T& b) {
    return encode(a) == encode(b);
}

/// Every cell of every device once.
std::vector<Taken> unite(const std::vector<MergeInput>& inputs) {
    std::map<std::string, std::map<std::string, Taken>> cells;  // by name and device
    for (const MergeInput& input : inputs) {
        for (const MergeInput::Cell& cell : input.cells) {
            const auto [taken, is_new] =
                cells[cell.name].try_emplace(cell.record.device, Taken{&input, &cell, cell.name});
            if (is_new) continue;
            const MergeInput::Cell& known = *taken->second.cell;
            if (!is_equal(known, cell)) refuse_unlike(known, cell);
        }
    }
    std::vector<Taken> result;
    for (auto& [name, devices] : cells) {
        for (auto& [device, taken] : devices) {
            if (devices.size() > 1) taken.name = name_on_device(name, device);
            result.push_back(taken);
        }
    }
    std::ranges::stable_sort(result, {}, [](const Taken& taken) {
        const PlannedRecord& planned = taken.input->planned.at(taken.cell->record.cell);
        return std::tuple(planned.place.value(), taken.name);
    });
    return result;
}

/// The cells of the merged run.json: what is finished, under its name there, and what no folder has
/// finished.
std::vector<PlannedRecord> unite_planned(const std::vector<MergeInput>& inputs,
                                         const std::vector<Taken>& taken, std::size_t& missing) {
    std::map<std::tuple<std::uint64_t, std::string>, PlannedRecord> planned;
    std::set<std::string> finished;
    const auto add = [&](PlannedRecord cell, const std::string& name) {
        cell.id = name;
        planned.emplace(std::tuple(cell.place.value(), name), std::move(cell));
    };
    for (const Taken& cell : taken) {
        finished.insert(cell.cell->name);
        add(cell.input->planned.at(cell.cell->record.cell), cell.name);
    }
    const std::size_t done = planned.size();
    for (const MergeInput& input : inputs) {
        std::set<std::string> own;  // names that its finished cells bear
        for (const MergeInput::Cell& cell : input.cells) own.insert(cell.record.cell);
        for (const auto& [name, cell] : input.planned) {
            if (!own.contains(name) && !finished.contains(name)) add(cell, name);
        }
    }
    missing = planned.size() - done;
    std::vector<PlannedRecord> cells;
    for (auto& [key, cell] : planned) cells.push_back(std::move(cell));
    return cells;
}

/// What a merged run.json keeps of each folder's: machine, driver, command, shard. Of a folder that
/// was itself merged, what it kept.
std::vector<RunRecord> contexts_of(const std::vector<MergeInput>& inputs) {
    std::vector<RunRecord> contexts;
    const auto add = [&](const RunRecord& context) {  // a copy of a folder says nothing new
        if (std::ranges::none_of(contexts, [&](const auto& other) { return same(other, context); }))
            contexts.push_back(context);
    };
    for (const MergeInput& input : inputs) {
        for (const RunRecord& context : input.run.shards) add(context);
        if (!input.run.shards.empty()) continue;
        RunRecord context = input.run;
        context.scenarios.clear();
        context.plugins.clear();
        context.overrides.clear();
        add(context);
    }
    return contexts;
}

template <typename T>
void add_once(std::vector<T>& list, const T& value) {
    if (std::ranges::none_of(list, [&](const T& other) { return same(other, value); })) {
        list.push_back(value);
    }
}

/// What disturbed times on a device, one text for what its folders say with other numbers.
std::vector<std::string> unite_noise(const std::vector<RunRecord>& contexts) {
    std::map<std::string, std::vector<std::string>> devices;
    for (const RunRecord& context : contexts) {
        std::string device = fmt::format("{}, {} cores", value_text(encode(context.cpu)),
                                         value_text(encode(context.cores)));
        if (context.gl) device = fmt::format("{}; {}", context.gl->renderer, device);
        std::vector<std::string>& texts = devices[device];
        texts.insert(texts.end(), context.noise.begin(), context.noise.end());
    }
    std::vector<std::string> noise;
    for (const auto& [device, texts] : devices) {
        for (const std::string& words : fold_alike(texts)) {
            noise.push_back(devices.size() == 1 ? words : fmt::format("on {}: {}", device, words));
        }
    }
    return noise;
}

/// What all have alike stands as in any run.json; what differs is null, and stands in "shards".
RunRecord unite_runs(const std::vector<MergeInput>& inputs) {
    RunRecord run = inputs.front().run;
    for (const MergeInput& input : inputs) {
        each_field<RunRecord>([&](const auto& field) {
            auto& value = run.*field.member;
            if (!same(value, input.run.*field.member)) value = {};
        });
    }
    for (const MergeInput& input : inputs) {  // texts that sort as times do
        const std::string& started = input.run.started;
        if (run.started.empty() || started < run.started) run.started = started;
    }
    run.shard.reset();
    run.warnings.clear();
    run.plugins.clear();
    run.scenarios.clear();
    for (const MergeInput& input : inputs) {
        for (const std::string& words : input.run.warnings) add_once(run.warnings, words);
        for (const PluginContext& plugin : input.run.plugins) add_once(run.plugins, plugin);
        for (const ScenarioContext& scenario : input.run.scenarios) {
            if (run.scenario(scenario.name) == nullptr) run.scenarios.push_back(scenario);
        }
    }
    run.shards = contexts_of(inputs);
    run.noise = unite_noise(run.shards);
    return run;
}

/// That parts of the campaign are in none of the folders; "" where they all are. `absent` counts
/// their cells.
std::string words_on_absent(const RunRecord& run, std::size_t& absent) {
    std::set<std::uint64_t> places;  // a cell that two devices flew has one
    for (const PlannedRecord& cell : run.cells) places.insert(cell.place.value());
    const std::uint64_t all = run.campaign_cells.value();
    if (places.size() >= all) return {};
    absent = std::size_t(all) - places.size();
    std::map<int, std::set<int>> seen;  // by the number of shards
    for (const RunRecord& context : run.shards) {
        if (context.shard) seen[context.shard->count].insert(context.shard->number);
    }
    std::string shards;
    if (seen.size() == 1) {  // else there is no one list of them
        const auto& [count, numbers] = *seen.begin();
        for (int number = 1; number <= count; ++number) {
            if (numbers.contains(number)) continue;
            shards += fmt::format("{}{}/{}", shards.empty() ? "" : ", ", number, count);
        }
    }
    return fmt::format("{} of the campaign's {} cells are in none of the merged folders{}", absent,
                       all, shards.empty() ? "" : ": shards " + shards + " are not among them");
}

fs::path canonical_folder(const fs::path& folder) {
    const fs::path path = fs::weakly_canonical(fs::absolute(folder));
    return path.has_filename() ? path : path.parent_path();  // without a slash at the end
}

/// The place of the result. Throws InputError where it is taken, or lies in a folder to be merged.
fs::path place_of(const fs::path& out, const std::vector<fs::path>& folders) {
    const fs::path place = canonical_folder(out);
    for (const fs::path& folder : folders) {
        const fs::path input = canonical_folder(folder);
        const auto [end, ignored] =
            std::mismatch(input.begin(), input.end(), place.begin(), place.end());
        if (end != input.end()) continue;
        throw InputError(
            fmt::format("--out {}: this is or lies in {}, which is only read; name "
                        "another folder",
                        out.string(), folder.string()));
    }
    const fs::file_status status = fs::symlink_status(out);
    if (!fs::exists(status) || (fs::is_directory(status) && fs::is_empty(out))) return place;
    throw InputError(fmt::format(
        "--out {}: there is something already; name a new or an empty folder", out.string()));
}

}  // namespace

MergedRun merge_folders(const std::vector<fs::path>& folders, const fs::path& out,
                        const std::function<std::string(const MergedRun&)>& summary) {
    if (folders.empty()) throw InputError("there is no folder to merge; name some");
    const fs::path place = place_of(out, folders);
    const std::vector<MergeInput> inputs = read_inputs(folders);
    expect_one_protocol(inputs);
    const std::vector<Taken> taken = unite(inputs);

    MergedRun merged;
    merged.run = unite_runs(inputs);
    merged.run.cells = unite_planned(inputs, taken, merged.missing);
    for (const MergeInput& input : inputs) {
        merged.warnings.insert(merged.warnings.end(), input.warnings.begin(), input.warnings.end());
    }
    std::size_t absent = 0;
    if (const std::string words = words_on_absent(merged.run, absent); !words.empty()) {
        merged.warnings.push_back(words);
        merged.missing += absent;
    }

    Draft draft(place);
    for (const char* part : {"scenarios", "frames", "flights", "logs", "shots"}) {
        fs::create_directory(draft.path() / part);
    }
    copy_scenarios(inputs, draft.path());
    copy_flights(inputs, draft.path(), merged.warnings);
    std::string lines;
    std::map<const MergeInput*, std::vector<const Taken*>> by_input;
    for (const Taken& cell : taken) {
        heed_interrupt();
        lines += write_cell(cell, draft.path());
        by_input[cell.input].push_back(&cell);
        merged.cells.push_back(cell.cell->record);
        merged.cells.back().cell = cell.name;
    }
    for (const auto& [input, cells] : by_input) copy_files_of_cells(*input, cells, draft.path());
    base::write_whole(draft.path() / "cells.jsonl", lines, base::Keep::for_now);
    for (const std::string& warning : merged.warnings) add_once(merged.run.warnings, warning);
    write_run(merged.run, draft.path(), base::Keep::for_now);
    base::write_whole(draft.path() / "summary.md", summary(merged), base::Keep::for_now);
    draft.finish();
    return merged;
}

}  // namespace lodbench::results
