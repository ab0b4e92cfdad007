#pragma once
// run.json: what the numbers of a campaign depend on. A result without its context is no result.

#include <json/value.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/files.h"
#include "results/field.h"
#include "results/record_json.h"

namespace lodbench::results {

/// The program, and the machine on which it runs.
struct MachineContext {
    std::string tool_version, commit, build_type, compiler, abi_tag;
    std::string os, kernel, cpu;
    std::optional<int> cores;
    std::optional<double> cpu_quota_cores;
    std::optional<double> load_average;
};

/// What a cell's process saw of OpenGL.
struct GlContext {
    std::string vendor, renderer, version, device, timer_verdict;
    std::optional<bool> software;
};

/// What does not change of a GPU.
struct GpuFacts {
    std::string name;    ///< "NVIDIA H200"; of sysfs its driver and PCI identity
    std::string source;  ///< "NVML 580.82", "amdgpu in sysfs"
    std::string pci;     ///< "0000:3b:00.0"; "" where it is not known
    std::optional<double> max_mhz, limit_c;
};

/// The sensors that are read while cells fly.
struct HealthContext {
    std::string cpu_governor;
    std::optional<double> cpu_max_mhz;
    std::optional<GpuFacts> gpu;
    std::string gpu_absent;
};

/// The error at which methods fly over a scenario, by the knob values that it keeps ([equal]).
struct EqualContext {
    double error_px = 0, tolerance = 0;
    bool as_kept = false;
    TextMap off;
};

struct ScenarioContext {
    std::string name, file, text;
    std::optional<int> frames, warmup_frames, width, height, repetitions;
    std::optional<double> rate_hz;
    std::string flight_file, flight_checksum;
    std::optional<EqualContext> equal;
};

struct MethodContext {
    std::string id, version, title, citation, quality_knob, compiled;
};

struct PluginContext {
    std::string path, refusal;
    std::vector<MethodContext> methods;
    std::vector<std::string> left_out;
};

/// The part of a campaign that a folder holds.
struct ShardContext {
    int number = 0, count = 0;
};

/// A cell that is to be flown.
struct PlannedRecord {
    std::string id;
    std::optional<std::uint64_t> place;  ///< in the order of flight of the whole campaign
    Json::Value task;                    ///< all of it, an object: for the process that flies it
};
[[nodiscard]] Json::Value encode(const PlannedRecord& planned);
void decode(const Json::Value& json, PlannedRecord& planned, const Place& place);

struct RunRecord : MachineContext {
    int schema_version = kSchemaVersion;
    std::string started, command_line, device_asked;
    std::uint64_t seed = 1;
    std::optional<double> cool_down_s;
    TextMap overrides;
    std::optional<GlContext> gl;
    std::optional<HealthContext> health;
    std::vector<ScenarioContext> scenarios;
    std::vector<PluginContext> plugins;
    std::vector<std::string> noise, warnings;
    std::vector<PlannedRecord> cells;
    std::string campaign;
    std::optional<std::uint64_t> campaign_cells;
    std::optional<ShardContext> shard;
    std::vector<RunRecord> shards;
    std::string baseline_of;

    /// nullptr where it has none of this name.
    [[nodiscard]] const ScenarioContext* scenario(const std::string& name) const;
};

/// run.json of a folder. What an older version did not write is absent. Throws InputError with
/// file, member and remedy where it is missing, damaged, or of another schema version.
[[nodiscard]] RunRecord read_run(const std::filesystem::path& folder);

void write_run(const RunRecord& run, const std::filesystem::path& folder,
               base::Keep keep = base::Keep::safely);

/// Throws InputError naming the file unless the document is an object of this schema version.
void check_schema(const Json::Value& json, const std::filesystem::path& file);

}  // namespace lodbench::results

#include "results/run_fields.h"
