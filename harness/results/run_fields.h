#pragma once
// The field tables of run.json and of what nests in it; see results/field.h.

#include "results/run_record.h"

namespace lodbench::results {

template <>
struct FieldTable<MachineContext> {
    using R = MachineContext;
    static constexpr std::tuple fields{
        Field{"tool_version", &R::tool_version, "", "version of lodbench"},
        Field{"commit", &R::commit, "", "of its source, with `-dirty` where it was changed"},
        Field{"build_type", &R::build_type, "", "Release, RelWithDebInfo, …"},
        Field{"compiler", &R::compiler, "", "that built it, with its version"},
        Field{"abi_tag", &R::abi_tag, "",
              "of compiler, library and interface: a plugin's must be the same"},
        Field{"os", &R::os, "", "name of the system"},
        Field{"kernel", &R::kernel, "", "name, release and architecture"},
        Field{"cpu", &R::cpu, "", "name of the processor"},
        Field{"cores", &R::cores, "", "that the process may use"},
        Field{"cpu_quota_cores", &R::cpu_quota_cores, "cores",
              "processor time that its control groups leave it; null: no limit"},
        Field{"load_average", &R::load_average, "",
              "processes that ran or waited to in the minute before the command began"}};
};

template <>
struct FieldTable<GlContext> {
    using R = GlContext;
    static constexpr std::tuple fields{
        Field{"vendor", &R::vendor, "", "as OpenGL says it"},
        Field{"renderer", &R::renderer, "", "as OpenGL says it"},
        Field{"version", &R::version, "", "as OpenGL says it"},
        Field{"device", &R::device, "", "by which way and number it was opened"},
        Field{"software", &R::software, "", "whether it draws on the processor"},
        Field{"timer_verdict", &R::timer_verdict, "", "whether its timer queries can be believed"}};
};

template <>
struct FieldTable<GpuFacts> {
    using R = GpuFacts;
    static constexpr std::tuple fields{
        Field{"name", &R::name, "", "as its driver says it"},
        Field{"source", &R::source, "", "what reads its sensors"},
        Field{"pci", &R::pci, "", "its address"},
        Field{"max_mhz", &R::max_mhz, "MHz", "its highest clock"},
        Field{"limit_c", &R::limit_c, "°C", "temperature at which it is slowed down"}};
};

template <>
struct FieldTable<HealthContext> {
    using R = HealthContext;
    static constexpr std::tuple fields{
        Field{"cpu_governor", &R::cpu_governor, "", "of the processor's clock"},
        Field{"cpu_max_mhz", &R::cpu_max_mhz, "MHz", "the processor's highest clock"},
        Field{"gpu", &R::gpu, "", "the GPU whose sensors are read"},
        Field{"gpu_absent", &R::gpu_absent, "", "why none is"}};
};

template <>
struct FieldTable<EqualContext> {
    using R = EqualContext;
    static constexpr std::tuple fields{
        Field{"error_px", &R::error_px, "px", "P99.9 of the pixel error that all are to show",
              true},
        Field{"tolerance", &R::tolerance, "ratio", "how near is equal", true},
        Field{"as_kept", &R::as_kept, "",
              "whether the flight is that for which the knob values were found"},
        Field{"off", &R::off, "", "by method, why it cannot show this error"}};
};

template <>
struct FieldTable<ScenarioContext> {
    using R = ScenarioContext;
    static constexpr std::tuple fields{
        Field{"name", &R::name, "", "its name, by which cells call it", true},
        Field{"file", &R::file, "", "where it was read"},
        Field{"text", &R::text, "", "all of the file"},
        Field{"frames", &R::frames, "", "timed, overrides applied"},
        Field{"warmup_frames", &R::warmup_frames, "", "flown before"},
        Field{"width", &R::width, "px", "of the viewport"},
        Field{"height", &R::height, "px", "of the viewport"},
        Field{"rate_hz", &R::rate_hz, "Hz", "simulated frames a second"},
        Field{"repetitions", &R::repetitions, "", "of each cell"},
        Field{"flight_file", &R::flight_file, "", "the recorded flight; null: it has none"},
        Field{"flight_checksum", &R::flight_checksum, "", "of that file"},
        Field{"equal", &R::equal, "", "null where methods fly at other knob values"}};
};

template <>
struct FieldTable<MethodContext> {
    using R = MethodContext;
    static constexpr std::tuple fields{
        Field{"id", &R::id, "", "by which cells call it", true},
        Field{"version", &R::version, "", "changes whenever results may change"},
        Field{"title", &R::title, "", "one line"},
        Field{"citation", &R::citation, "", "authors, year, title"},
        Field{"quality_knob", &R::quality_knob, "", "its parameter that trades speed for accuracy"},
        Field{"compiled", &R::compiled, "", "options of the compiler that decide about times"}};
};

template <>
struct FieldTable<PluginContext> {
    using R = PluginContext;
    static constexpr std::tuple fields{
        Field{"path", &R::path, "", "its file"},
        Field{"refusal", &R::refusal, "", "why it was not used; null: it was"},
        Field{"methods", &R::methods, "", "that it holds"},
        Field{"left_out", &R::left_out, "", "which of its methods were not used, and why"}};
};

template <>
struct FieldTable<ShardContext> {
    using R = ShardContext;
    static constexpr std::tuple fields{Field{"number", &R::number, "", "from 1", true},
                                       Field{"count", &R::count, "", "parts in all", true}};
};

template <>
struct FieldTable<RunRecord> {
    using R = RunRecord;
    static constexpr std::tuple fields = std::tuple_cat(
        FieldTable<MachineContext>::fields,
        std::tuple{
            Field{"schema_version", &R::schema_version, "", "of every file of the folder"},
            Field{"started", &R::started, "UTC", "2025-01-31T12:34:56Z"},
            Field{"command_line", &R::command_line, "", "as it was given"},
            Field{"device_asked", &R::device_asked, "", "with `--device`"},
            Field{"seed", &R::seed, "", "of the order of cells, and of all that is drawn by lot"},
            Field{"cool_down_s", &R::cool_down_s, "s", "pause before each cell but the first"},
            Field{"overrides", &R::overrides, "", "keys of scenarios, and their values in TOML"},
            Field{"gl", &R::gl, "", "what the first cell saw; null until it was flown"},
            Field{"health", &R::health, "", "the sensors; null until a cell was flown"},
            Field{"scenarios", &R::scenarios, "", "that are flown"},
            Field{"plugins", &R::plugins, "", "that were found"},
            Field{"noise", &R::noise, "", "what on the machine disturbs times, in words"},
            Field{"warnings", &R::warnings, "", "of the run; a cell has its own"},
            Field{"cells", &R::cells, "", "the plan: what each cell's process is given"},
            Field{"campaign", &R::campaign, "", "checksum of the whole campaign's list of cells"},
            Field{"campaign_cells", &R::campaign_cells, "", "their number"},
            Field{"shard", &R::shard, "", "the part that this folder holds; null: all of it"},
            Field{"shards", &R::shards, "",
                  "of a merged folder: run.json of each part, without what all have alike"},
            Field{"baseline_of", &R::baseline_of, "",
                  "of a baseline: the campaign that it was made of"}});
};

}  // namespace lodbench::results
