#include "scenario/scenario.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <limits>

#include "api/error.h"
#include "base/isolated.h"
#include "base/printable.h"
#include "scenario/flight_section.h"
#include "scenario/recorded_path.h"
#include "scenario/toml_section.h"
#include "terrain/open_terrain.h"
#include "terrain/synthetic.h"
#include "terrain/toml_file.h"
#include "terrain/upsample.h"

namespace lodbench::scenario {
namespace {

constexpr std::int64_t kMaxSeed = std::numeric_limits<std::int64_t>::max();
constexpr int kMaxFrames = 1'000'000;
constexpr int kMaxPixels = 16384;  // a side; the least GL_MAX_VIEWPORT_DIMS of OpenGL 4.5
constexpr int kMaxSide = 65537;    // samples of a synthetic terrain
constexpr int kMaxRepetitions = 1000;
constexpr std::size_t kMaxNameBytes = 64;
constexpr std::size_t kMaxSweptValues = 1000;
constexpr double kRehearsalSeconds = 20;

bool is_name(std::string_view text, bool lower_case_only) {
    return !text.empty() && text.size() <= kMaxNameBytes &&
           std::all_of(text.begin(), text.end(), [lower_case_only](char c) {
               const bool lower = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
               return lower || (!lower_case_only && ((c >= 'A' && c <= 'Z') || c == '_'));
           });
}

/// Puts the value of a key into `target` where the key is there.
template <typename T, typename V>
void set(T& target, const std::optional<V>& value) {
    if (value) target = T(*value);
}

void read_name(Section& top, const std::filesystem::path& file, Scenario& scenario) {
    const auto name = top.text("name");
    scenario.name = name.value_or(file.stem().string());
    if (is_name(scenario.name, false)) return;
    const std::string remedy = fmt::format("names are 1 to {} of A-Z a-z 0-9 _ -", kMaxNameBytes);
    if (name) top.refuse("name", remedy);
    throw InputError(
        fmt::format("{}:1: the file's name {} cannot name the scenario ({}); write "
                    "name = \"...\" as its first line",
                    file.string(), base::printable(scenario.name), remedy));
}

void read_synthetic(Section& section, terrain::TerrainSource& source) {
    set(source.rows, section.integer("rows", 2, kMaxSide));
    set(source.columns, section.integer("columns", 2, kMaxSide));
    set(source.seed, section.integer("seed", 0, kMaxSeed));
    std::vector<std::string> forms;
    const terrain::SyntheticForm* form = nullptr;
    for (const terrain::SyntheticForm& known : terrain::synthetic_forms()) {
        forms.emplace_back(known.name);
        if (source.synthetic == known.name) form = &known;
    }
    if (form == nullptr) {
        section.refuse("synthetic",
                       "not a synthetic terrain; " + Section::known_names(source.synthetic, forms));
    }
    auto shape = section.section("shape");
    if (!shape) return;
    for (const terrain::ShapeParam& param : form->params) {
        if (const auto value = shape->number(param.name)) source.shape.emplace(param.name, *value);
    }
    shape->refuse_unknown();
}

void read_upsampling(Section& terrain, terrain::TerrainSource& source) {
    auto section = terrain.section("upsample");
    if (!section) return;
    const auto factor = section->integer("factor", 2, terrain::kGreatestFactor);
    if (!factor) section->require("factor", "write how many times as many samples, 2 to 64");
    terrain::Upsampling& upsampling = source.upsampling.emplace();
    upsampling.factor = int(*factor);
    set(upsampling.fractal_amplitude, section->number("fractal", {0, 1e5}));
    set(upsampling.seed, section->integer("seed", 0, kMaxSeed));
    section->refuse_unknown();
    try {
        terrain::check_upsampling(upsampling);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", section->where(), error.what()));
    }
}

void read_terrain(Section& top, const std::filesystem::path& folder, Scenario& scenario) {
    auto section = top.section("terrain");
    if (!section) {
        top.require("terrain",
                    "write a table [terrain] with file = \"...\" or synthetic = \"...\"");
    }
    terrain::TerrainSource& source = scenario.terrain;
    source.where = section->where();
    const auto file = section->text("file");
    const auto synthetic = section->text("synthetic");
    if (file.has_value() == synthetic.has_value()) {
        if (file) section->refuse("synthetic", "there is a file too; write only one of the two");
        section->require("file", "write file = \"...\" or synthetic = \"...\"");
    }
    if (file) {
        source.file = existing_file(*section, "file", *file, folder);
        source.where = section->where("file");
        source.no_data = section->number("no_data", {-1e300, 1e300});
        source.cold = section->boolean("cold").value_or(false);
        source.out_of_core = section->boolean("out_of_core").value_or(false);
    } else {
        source.synthetic = *synthetic;
        source.where = section->where("synthetic");
        read_synthetic(*section, source);
    }
    constexpr Limits kSpacing{1e-6, 1e7};
    const toml::node* spacing = section->node("spacing");
    if (spacing != nullptr && spacing->is_number()) {
        source.spacing_x = section->number("spacing", kSpacing);
        source.spacing_y = source.spacing_x;
    } else if (const auto both = section->numbers("spacing", 2, 2, kSpacing)) {
        source.spacing_x = (*both)[0];
        source.spacing_y = (*both)[1];
    }
    source.vertical_scale = section->number("vertical_scale", {-1e6, 1e6});
    if (source.vertical_scale == 0) {
        section->refuse("vertical_scale",
                        "a scale of 0 makes every height the same; write another");
    }
    source.vertical_offset = section->number("vertical_offset");
    if (const auto origin = section->numbers("origin", 2, 2)) {
        source.origin_x = (*origin)[0];
        source.origin_y = (*origin)[1];
    }
    read_upsampling(*section, source);
    section->refuse_unknown();
    try {
        terrain::check_source(source);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", source.where, error.what()));
    }
}

void read_camera(Section& top, Scenario& scenario) {
    if (auto camera = top.section("camera")) {
        if (const auto fov = camera->number("vertical_fov", {1e-3, 179.9})) {
            scenario.vertical_fov = glm::radians(*fov);
        }
        set(scenario.near_plane, camera->number("near", {1e-3, 1e6}));
        camera->refuse_unknown();
    }
    if (auto viewport = top.section("viewport")) {
        set(scenario.viewport.width, viewport->integer("width", 1, kMaxPixels));
        set(scenario.viewport.height, viewport->integer("height", 1, kMaxPixels));
        viewport->refuse_unknown();
    }
}

void read_flight(Section& top, const std::filesystem::path& folder,
                 const std::filesystem::path& kept, Scenario& scenario) {
    auto flight = top.section("flight");
    if (!flight) top.require("flight", "write a table [flight] with kind = \"...\"");
    const auto frames = flight->integer("frames", 1, kMaxFrames);
    set(scenario.frames, frames);
    set(scenario.rate_hz, flight->number("rate_hz", {1e-3, 1e6}));
    set(scenario.warmup_frames, flight->integer("warmup_frames", 0, kMaxFrames));
    set(scenario.warmup_flies, flight->boolean("warmup_flies"));
    scenario.path = read_path(*flight, folder, kept);
    flight->refuse_unknown();
    if (scenario.path.standing) {
        scenario.vertical_fov = scenario.path.standing->vertical_fov;
        scenario.near_plane = scenario.path.standing->near_plane;
    }
    if (scenario.path.kind != PathKind::recorded || frames) return;
    const std::size_t rows = load_recorded(scenario.path.recorded).size();
    const auto lead = std::size_t(scenario.warmup_flies ? scenario.warmup_frames : 0);
    if (rows <= lead) {
        flight->refuse("file", fmt::format("{} frames, and {} are flown for warm-up; write fewer "
                                           "warmup_frames",
                                           rows, lead));
    }
    if (rows - lead > std::size_t(kMaxFrames)) {
        flight->refuse("file", fmt::format("{} frames, at most {} are flown; write frames = ... to "
                                           "fly the first of them",
                                           rows - lead, kMaxFrames));
    }
    scenario.frames = int(rows - lead);
}

void read_measure_and_run(Section& top, Scenario& scenario) {
    if (auto measure = top.section("measure")) {
        set(scenario.measure.every, measure->integer("every", 1, kMaxFrames));
        set(scenario.measure.truth, measure->boolean("truth"));
        set(scenario.measure.pixels_only, measure->boolean("pixels_only"));
        set(scenario.measure.whole, measure->boolean("whole"));
        const auto frames = [&](const char* key, std::vector<int>& list) {
            auto given = measure->integers(key, 0, scenario.frames - 1);
            if (!given) return;
            std::ranges::sort(*given);
            given->erase(std::unique(given->begin(), given->end()), given->end());
            list = std::move(*given);
        };
        frames("shots", scenario.measure.shots);
        frames("economy", scenario.measure.economy);
        if (scenario.measure.pixels_only && !scenario.measure.economy.empty()) {
            measure->refuse("economy",
                            "it needs the errors of samples, which pixels_only leaves "
                            "out; write one of the two");
        }
        set(scenario.measure.budget_ms, measure->number("budget_ms", {0, 1e6}));
        measure->refuse_unknown();
    }
    if (auto run = top.section("run")) {
        set(scenario.repetitions, run->integer("repetitions", 1, kMaxRepetitions));
        set(scenario.seed, run->integer("seed", 0, kMaxSeed));
        set(scenario.cell_time_limit_s, run->number("cell_time_limit_s", {0.1, 1e7}));
        set(scenario.frame_time_limit_s, run->number("frame_time_limit_s", {0.1, 1e7}));
        if (const auto limit = run->integer("memory_limit_mib", 16, 1LL << 30U)) {
            scenario.memory_limit_bytes = std::uint64_t(*limit) << 20U;
        }
        run->refuse_unknown();
    }
}

/// A parameter's value as text; the plugin's own types decide later what it means.
std::string setting_text(const Section& method, std::string_view key, const toml::node& node) {
    if (const auto* text = node.as_string()) {
        if (text->get().empty() || text->get().size() > kMaxNameBytes ||
            describe(node) != '"' + text->get() + '"') {
            method.refuse(key,
                          fmt::format("values are 1 to {} bytes of plain text", kMaxNameBytes));
        }
        return text->get();
    }
    if (const auto* number = node.as_floating_point(); number != nullptr) {
        return fmt::format("{}", method.number_of(key, node, {-1e300, 1e300}));
    }
    if (node.is_integer() || node.is_boolean()) return describe(node);
    method.refuse(key, "write a number, true or false, text, or an array of these to sweep");
}

/// Why methods of `equal` show another error.
void read_off(Section& section, EqualError& equal) {
    auto off = section.section("off");
    if (!off) return;
    for (EqualError::Knob& knob : equal.knobs) {
        if (const auto reason = off->text(knob.method)) knob.off = *reason;
    }
    off->refuse_unknown();
}

void read_equal(Section& top, Scenario& scenario) {
    auto section = top.section("equal");
    if (!section) return;
    EqualError& equal = scenario.equal.emplace();
    const auto error = section->number("error_px", {1e-6, 1e6});
    if (!error) section->require("error_px", "write the P99.9 of the pixel error, in pixels");
    equal.error_px = *error;
    set(equal.tolerance, section->number("tolerance", {1e-4, 0.5}));
    auto knobs = section->section("knobs");
    if (!knobs) {
        section->require("knobs", "write [equal.knobs] with METHOD = VALUE, its quality knob's");
    }
    for (const auto& [key, node] : knobs->table()) {
        const std::string id(key.str());
        if (!is_name(id, true)) {
            knobs->refuse(id,
                          "not the id of a method; ids are of a-z 0-9 - as lodbench list shows");
        }
        if (node.is_array()) knobs->refuse(id, "write the one value that shows the error");
        equal.knobs.push_back({id, setting_text(*knobs, id, node), knobs->where(id), ""});
    }
    read_off(*section, equal);
    section->refuse_unknown();
}

MethodRequest read_method(Section& section) {
    MethodRequest request;
    request.where = section.where();
    const auto id = section.text("id");
    if (!id) section.require("id", "write the id of a method as lodbench list shows it");
    if (!is_name(*id, true)) {
        section.refuse("id", "not the id of a method; ids are of a-z 0-9 - as lodbench list shows");
    }
    request.id = *id;
    for (const auto& [key, node] : section.table()) {
        if (key.str() == "id") continue;
        std::vector<std::string> values;
        if (const toml::array* array = node.as_array()) {
            if (array->empty() || array->size() > kMaxSweptValues) {
                section.refuse(key.str(), fmt::format("{} values; write 1 to {} to sweep",
                                                      array->size(), kMaxSweptValues));
            }
            for (const toml::node& entry : *array) {
                std::string value = setting_text(section, key.str(), entry);
                if (std::find(values.begin(), values.end(), value) != values.end()) {
                    section.refuse(key.str(), fmt::format("{} is there twice; remove one",
                                                          base::printable(value)));
                }
                values.push_back(std::move(value));
            }
        } else {
            values.push_back(setting_text(section, key.str(), node));
        }
        request.settings.emplace_back(std::string(key.str()), std::move(values));
    }
    return request;
}

void read_methods(Section& top, Scenario& scenario) {
    for (Section& section : top.sections("method")) {
        MethodRequest request = read_method(section);
        for (const MethodRequest& other : scenario.methods) {
            if (other.id == request.id && other.settings == request.settings) {
                section.refuse("id", fmt::format("the same method with the same settings as at {}; "
                                                 "remove one",
                                                 other.where));
            }
        }
        scenario.methods.push_back(std::move(request));
    }
}

/// As an override of the frames at the same parts of a flight of `to` frames.
std::string moved_frames(std::vector<int> frames, int from, std::int64_t to) {
    for (int& frame : frames) {
        frame = from == 1 ? 0 : int(std::lround(double(frame) * double(to - 1) / (from - 1)));
    }
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    return fmt::format("[{}]", fmt::join(frames, ", "));
}

void put(const std::string& path, const Overrides::Value& value, toml::table& table) {
    toml::table parsed = terrain::parse_toml_value(value.toml, value.where);
    std::string_view rest = path;
    toml::table* at = &table;
    for (std::size_t dot = 0; (dot = rest.find('.')) != rest.npos; rest.remove_prefix(dot + 1)) {
        const std::string_view name = rest.substr(0, dot);
        toml::node* const inner = at->get(name);
        if (inner != nullptr && !inner->is_table()) {
            throw InputError(
                fmt::format("{}: {} is no table of the scenario; write the path to a "
                            "key, as flight.frames=25",
                            value.where, base::printable(name)));
        }
        at = inner != nullptr ? inner->as_table()
                              : at->insert_or_assign(name, toml::table()).first->second.as_table();
    }
    parsed.get("value")->visit([&](auto& node) { at->insert_or_assign(rest, std::move(node)); });
}

/// The frames that the file names, and no override does, to where they are in a flight of as many
/// frames as `frames` says. `as_written` reads the scenario, which may take a recorded flight's
/// time: where there is something to move.
template <typename Read>
void move_named_frames(toml::table& table, const Overrides& overrides,
                       const Overrides::Value& frames, const Read& as_written) {
    const auto to =
        terrain::parse_toml_value(frames.toml, frames.where)["value"].value<std::int64_t>();
    const bool named = table["measure"]["shots"] || table["measure"]["economy"];
    if (!to || !named) return;
    const Scenario written = as_written();
    const auto move = [&](const char* key, const std::vector<int>& list) {
        if (list.empty() || overrides.has(key)) return;
        put(key, {moved_frames(list, written.frames, *to), frames.where}, table);
    };
    move("measure.shots", written.measure.shots);
    move("measure.economy", written.measure.economy);
}

Scenario read_scenario(const toml::table& table, std::string_view text,
                       const std::filesystem::path& file, const std::filesystem::path& kept) {
    const std::filesystem::path folder = file.parent_path();
    Section top(table, file, "");
    Scenario scenario;
    scenario.text = text;
    // Unknown tables are told first: a mistyped [flight] must not read as a missing one.
    for (const char* key :
         {"name", "terrain", "camera", "viewport", "flight", "measure", "run", "equal", "method"}) {
        (void)top.node(key);
    }
    top.refuse_unknown();
    read_name(top, file, scenario);
    read_terrain(top, folder, scenario);
    read_camera(top, scenario);
    read_flight(top, folder, kept, scenario);
    read_measure_and_run(top, scenario);
    read_equal(top, scenario);
    read_methods(top, scenario);
    return scenario;
}

}  // namespace

Scenario parse_scenario(std::string_view text, const std::filesystem::path& file,
                        const std::filesystem::path& kept, const Overrides& overrides) {
    toml::table table = terrain::parse_toml(text, file);
    if (const auto frames = overrides.values().find("flight.frames");
        frames != overrides.values().end()) {
        move_named_frames(table, overrides, frames->second,
                          [&] { return read_scenario(table, text, file, kept); });
    }
    for (const auto& [path, value] : overrides.values()) put(path, value, table);
    Scenario scenario = read_scenario(table, text, file, kept);
    if (scenario.terrain.out_of_core && scenario.measure.truth &&
        !scenario.measure.economy.empty()) {
        throw InputError(fmt::format(
            "{}: out_of_core is set, but economy triangulates the whole terrain in memory; leave "
            "out_of_core out where it fits, or economy under [measure]",
            scenario.terrain.where));
    }
    return scenario;
}

std::filesystem::path place_of_kept_flight(const std::filesystem::path& file) {
    return std::filesystem::path(file).replace_extension(".flight.csv");
}

std::filesystem::path kept_flight(const std::filesystem::path& file) {
    const std::filesystem::path kept = place_of_kept_flight(file);
    std::error_code none;
    return std::filesystem::is_regular_file(kept, none) ? kept : std::filesystem::path();
}

Scenario load_scenario(const std::filesystem::path& file, const Overrides& overrides) {
    const std::filesystem::path kept = kept_flight(file);
    const std::string text = terrain::read_toml_text(file);
    // What ends a process cannot be caught: tried in a child first. A refusal is met again below,
    // in words.
    const base::Answer rehearsal = base::run_isolated(kRehearsalSeconds, [&] {
        (void)parse_scenario(text, file, kept, overrides);
        return std::string();
    });
    if (rehearsal.ending == base::Ending::died || rehearsal.ending == base::Ending::timed_out) {
        throw InputError(
            fmt::format("{}: the TOML parser {}; the file is damaged or too deeply "
                        "nested, simplify it",
                        file.string(), rehearsal.text));
    }
    return parse_scenario(text, file, kept, overrides);
}

}  // namespace lodbench::scenario
