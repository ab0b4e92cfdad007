#include "results/cell.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "measure/statistics.h"
#include "results/frame_columns.h"
#include "results/json.h"
#include "results/truth_record.h"

namespace lodbench::results {

namespace {

Json::Value to_json(const measure::TimeSummary& summary) {
    Json::Value json;
    json["mean"] = number(summary.mean);
    json["median"] = number(summary.median);
    json["p90"] = number(summary.p90);
    json["p95"] = number(summary.p95);
    json["p99"] = number(summary.p99);
    json["p999"] = number(summary.p999);
    json["min"] = number(summary.min);
    json["max"] = number(summary.max);
    json["low1"] = number(summary.low1);
    return json;
}

/// Summary of one column of the frames; null unless every frame has it.
template <typename Get>
Json::Value time_summary(const std::vector<FrameRecord>& frames, Get get) {
    std::vector<double> values;
    for (const FrameRecord& frame : frames) {
        const std::optional<double> value = get(frame);
        if (!value) return Json::Value::null;
        values.push_back(*value);
    }
    if (values.empty()) return Json::Value::null;
    return to_json(measure::summarize_times(values));
}

/// Mean, least and greatest of a count over those frames that have it; null when none has.
Json::Value count_summary(const std::vector<FrameRecord>& frames,
                          std::optional<std::uint64_t> FrameRecord::*count) {
    double sum = 0;
    std::size_t present = 0;
    std::uint64_t least = UINT64_MAX;
    std::uint64_t greatest = 0;
    for (const FrameRecord& frame : frames) {
        if (!(frame.*count)) continue;
        const std::uint64_t value = *(frame.*count);
        sum += double(value);
        least = std::min(least, value);
        greatest = std::max(greatest, value);
        ++present;
    }
    if (present == 0) return Json::Value::null;
    Json::Value json;
    json["mean"] = sum / double(present);
    json["min"] = Json::UInt64(least);
    json["max"] = Json::UInt64(greatest);
    return json;
}

Json::Value count(std::optional<std::uint64_t> value) {
    return value ? Json::Value(Json::UInt64(*value)) : Json::Value::null;
}

Json::Value texts(const std::vector<std::string>& values) {
    Json::Value json = Json::arrayValue;
    for (const std::string& value : values) json.append(value);
    return json;
}

/// Null for what the child never came to say.
Json::Value text_or_null(const std::string& text) {
    return text.empty() ? Json::Value::null : Json::Value(text);
}

std::optional<std::uint64_t> read_count(const Json::Value& value) {
    return value.isNull() ? std::nullopt : std::optional<std::uint64_t>(value.asUInt64());
}

std::optional<double> read_number(const Json::Value& value) {
    return value.isNull() ? std::nullopt : std::optional(value.asDouble());
}

constexpr std::array kStatusNames = {"ok", "skipped", "failed", "crashed", "timeout"};

/// JsonCpp throws its own errors for wrong types.
template <typename Body>
auto checked(const std::string& where, Body body) {
    try {
        return body();
    } catch (const Json::Exception& error) {
        throw InputError(fmt::format("{}: {}", where, error.what()));
    }
}

}  // namespace

const char* name_of(CellStatus status) {
    return kStatusNames.at(std::size_t(status));
}

Json::Value to_json(const Params& params) {
    Json::Value json = Json::objectValue;
    for (const auto& [name, value] : params.values()) {
        if (const bool* flag = std::get_if<bool>(&value)) json[name] = *flag;
        if (const auto* integer = std::get_if<std::int64_t>(&value))
            json[name] = Json::Int64(*integer);
        if (const double* real = std::get_if<double>(&value)) json[name] = number(*real);
        if (const auto* choice = std::get_if<std::string>(&value)) json[name] = *choice;
    }
    return json;
}

std::string write_result(const CellResult& result) {
    Json::Value json;
    json["status"] = name_of(result.status);
    json["reason"] = result.reason;
    json["frames"] = Json::arrayValue;
    for (const FrameRecord& frame : result.frames) json["frames"].append(to_json(frame));
    json["prepare_s"] = result.prepare_s;
    json["prepare_cpu_s"] = result.prepare_cpu_s;
    json["upload_s"] = result.upload_s;
    json["gpu_bytes"] = count(result.gpu_bytes);
    json["peak_rss_bytes"] = count(result.peak_rss_bytes);
    json["samples_served"] = Json::UInt64(result.samples_served);
    json["samples_prepared"] = Json::UInt64(result.samples_prepared);
    json["tiles_served"] = Json::UInt64(result.tiles_served);
    json["terrain_bytes_read"] = Json::UInt64(result.terrain_bytes_read);
    json["counters"] = Json::arrayValue;
    for (const auto& [name, value] : result.counters) {
        Json::Value pair = Json::arrayValue;
        pair.append(name);
        pair.append(number(value));
        json["counters"].append(pair);
    }
    json["depth_hash"] = result.depth_hash;
    json["shots_hash"] = result.shots_hash;
    json["terrain_name"] = result.terrain_name;
    json["terrain_checksum"] = result.terrain_checksum;
    json["plugin_checksum"] = result.plugin_checksum;
    json["claimed_px"] = number(result.claimed_px);
    json["truth"] = result.truth;
    json["modules"] = texts(result.modules);
    json["warnings"] = texts(result.warnings);
    json["flight_warnings"] = texts(result.flight_warnings);
    json["gl_vendor"] = result.gl_vendor;
    json["gl_renderer"] = result.gl_renderer;
    json["gl_version"] = result.gl_version;
    json["device_description"] = result.device_description;
    json["software"] = result.software;
    json["timer_verdict"] = result.timer_verdict;
    json["warmup_frames"] = result.warmup_frames;
    json["frames_in_flight"] = result.frames_in_flight;
    json["environment_error"] = result.environment_error;
    json["input_error"] = result.input_error;
    return to_text(json);
}

CellResult read_result(std::string_view text, const std::string& where) {
    return checked(where, [&] {
        const Json::Value json = parse_json(text, where);
        CellResult result;
        const std::string status = get_string(json, "status", where);
        const auto* const name = std::ranges::find(kStatusNames, status);
        if (name == kStatusNames.end()) {
            throw InputError(fmt::format("{}: unknown status '{}'", where, status));
        }
        result.status = CellStatus(name - kStatusNames.begin());
        result.reason = get_string(json, "reason", where);
        for (const Json::Value& row : get_array(json, "frames", where)) {
            result.frames.push_back(read_frame(row, where));
        }
        result.prepare_s = get_number(json, "prepare_s", where);
        result.prepare_cpu_s = get_number(json, "prepare_cpu_s", where);
        result.upload_s = get_number(json, "upload_s", where);
        result.gpu_bytes = read_count(json["gpu_bytes"]);
        result.peak_rss_bytes = read_count(json["peak_rss_bytes"]);
        result.samples_served = json["samples_served"].asUInt64();
        result.samples_prepared = json["samples_prepared"].asUInt64();
        result.tiles_served = json["tiles_served"].asUInt64();
        result.terrain_bytes_read = json["terrain_bytes_read"].asUInt64();
        for (const Json::Value& pair : get_array(json, "counters", where)) {
            // A figure that is not finite has no number in JSON.
            result.counters.emplace_back(pair[0].asString(),
                                         pair[1].isNull() ? NAN : pair[1].asDouble());
        }
        result.depth_hash = get_string(json, "depth_hash", where);
        result.shots_hash = get_string(json, "shots_hash", where);
        result.terrain_name = get_string(json, "terrain_name", where);
        result.terrain_checksum = get_string(json, "terrain_checksum", where);
        result.plugin_checksum = get_string(json, "plugin_checksum", where);
        result.claimed_px = read_number(json["claimed_px"]);
        result.truth = json["truth"];
        if (!result.truth.isNull() && !result.truth.isObject()) {
            throw InputError(where + ": 'truth' is neither null nor an object");
        }
        for (const Json::Value& module : get_array(json, "modules", where)) {
            result.modules.push_back(module.asString());
        }
        for (const Json::Value& warning : get_array(json, "warnings", where)) {
            result.warnings.push_back(warning.asString());
        }
        for (const Json::Value& warning : get_array(json, "flight_warnings", where)) {
            result.flight_warnings.push_back(warning.asString());
        }
        result.gl_vendor = get_string(json, "gl_vendor", where);
        result.gl_renderer = get_string(json, "gl_renderer", where);
        result.gl_version = get_string(json, "gl_version", where);
        result.device_description = get_string(json, "device_description", where);
        result.software = json["software"].asBool();
        result.timer_verdict = get_string(json, "timer_verdict", where);
        result.warmup_frames = int(get_number(json, "warmup_frames", where));
        result.frames_in_flight = int(get_number(json, "frames_in_flight", where));
        result.environment_error = get_string(json, "environment_error", where);
        result.input_error = get_string(json, "input_error", where);
        return result;
    });
}

std::string noise_of(const CellResult& result) {
    constexpr double kFar = 1.5;
    constexpr double kLong_ms = 500;  // a shorter flight is held up by any trifle
    double wall_ms = 0, cpu_ms = 0, gpu_ms = 0;
    bool knows_gpu = true;
    for (const FrameRecord& frame : result.frames) {
        wall_ms += frame.wall_ms;
        cpu_ms += frame.cpu_ms;
        gpu_ms += frame.gpu_ms.value_or(0);
        knows_gpu = knows_gpu && frame.gpu_ms;
    }
    // Where a GPU draws and its timer is not believed, the wait for it cannot be told from another.
    if (!result.software && !knows_gpu) return {};
    if (wall_ms < kLong_ms || wall_ms <= kFar * (cpu_ms + gpu_ms)) return {};
    // Being woken when the GPU is done takes a while too, which counts where frames are short.
    constexpr double kWaking_ms = 0.5;
    const double idle_ms = (wall_ms - cpu_ms - gpu_ms) / double(result.frames.size());
    if (!result.software && idle_ms < kWaking_ms) return {};
    return fmt::format(
        "its frames took {:.0f} ms, and {:.0f} ms of CPU{} time were spent on them: it waited for "
        "other programs, a quota or the disk, and its times say how long",
        wall_ms, cpu_ms + gpu_ms, result.software ? "" : " and GPU");
}

Json::Value cell_record(const CellName& cell, const CellResult& result, double budget_ms) {
    Json::Value json;
    json["cell"] = cell.id;
    json["method"] = cell.method;
    json["scenario"] = cell.scenario;
    json["params"] = to_json(cell.params);
    json["repetition"] = cell.repetition;
    json["seed"] = Json::UInt64(cell.seed);
    json["status"] = name_of(result.status);
    json["reason"] = text_or_null(result.reason);
    for (const char* name : truth_fields()) {
        json[name] = result.truth.isObject() ? result.truth[name] : Json::Value::null;
    }

    const std::vector<FrameRecord>& frames = result.frames;
    std::vector<double> wall;
    for (const FrameRecord& frame : frames) wall.push_back(frame.wall_ms);
    json["frames"] = frames.empty() ? Json::Value::null : Json::Value(Json::UInt64(frames.size()));
    json["fps"] = number(measure::frames_per_second(wall));
    json["jank_ms"] = wall.empty() ? Json::Value::null : number(measure::jank_sum(wall, budget_ms));
    using Frame = const FrameRecord&;
    using Value = std::optional<double>;
    json["frame_ms"] = time_summary(frames, [](Frame f) { return Value(f.wall_ms); });
    json["select_ms"] = time_summary(frames, [](Frame f) { return Value(f.select_ms); });
    json["submit_ms"] = time_summary(frames, [](Frame f) { return Value(f.submit_ms); });
    json["gpu_ms"] = time_summary(frames, [](Frame f) { return f.gpu_ms; });
    json["cpu_ms"] = time_summary(frames, [](Frame f) { return Value(f.cpu_ms); });
    json["triangles"] = count_summary(frames, &FrameRecord::triangles);
    json["triangles_nondegenerate"] = count_summary(frames, &FrameRecord::triangles_nondegenerate);
    json["draw_calls"] = count_summary(frames, &FrameRecord::draw_calls);
    json["uploaded_bytes"] = count_summary(frames, &FrameRecord::uploaded_bytes);

    // A cell that did not come to its end has no times of its steps either.
    const bool measured = result.status == CellStatus::ok;
    json["prepare_s"] = measured ? number(result.prepare_s) : Json::Value::null;
    json["prepare_cpu_s"] = measured ? number(result.prepare_cpu_s) : Json::Value::null;
    json["prepare_cached"] = measured ? Json::Value(false) : Json::Value::null;
    json["upload_s"] = measured ? number(result.upload_s) : Json::Value::null;
    const auto served = [&](std::uint64_t value) {
        return measured ? Json::Value(Json::UInt64(value)) : Json::Value::null;
    };
    json["samples_served"] = served(result.samples_served);
    json["samples_prepared"] = served(result.samples_prepared);
    json["tiles_served"] = served(result.tiles_served);
    json["terrain_bytes_read"] = served(result.terrain_bytes_read);
    json["gpu_bytes"] = count(result.gpu_bytes);
    json["peak_rss_bytes"] = count(result.peak_rss_bytes);
    json["counters"] = Json::objectValue;
    for (const auto& [name, value] : result.counters) json["counters"][name] = number(value);
    json["claimed_px"] = number(result.claimed_px);
    json["depth_hash"] = text_or_null(result.depth_hash);
    json["shots_hash"] = text_or_null(result.shots_hash);
    json["terrain"] = text_or_null(result.terrain_name);
    json["terrain_checksum"] = text_or_null(result.terrain_checksum);
    json["plugin_checksum"] = text_or_null(result.plugin_checksum);
    json["timer_verdict"] = text_or_null(result.timer_verdict);
    json["warmup_frames"] = result.warmup_frames;
    json["frames_in_flight"] = result.frames_in_flight;
    json["modules"] = texts(result.modules);
    json["noise"] = text_or_null(noise_of(result));
    json["warnings"] = texts(result.flight_warnings);
    for (const std::string& warning : result.warnings) json["warnings"].append(warning);
    return json;
}

}  // namespace lodbench::results
