#pragma once
// What a cell measured: on its way between processes, and as a line of cells.jsonl.

#include <json/value.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/method.h"
#include "measure/truth.h"

namespace lodbench::results {

/// Which cell of a campaign it is.
struct CellName {
    std::string id;  ///< file-name safe, unique in the campaign: "lindstrom__tau=1__demo__r0"
    std::string scenario, method;
    Params params;
    int repetition = 0;
    std::uint64_t seed = 1;
};

enum class CellStatus { ok, skipped, failed, crashed, timeout };

template <typename T>
struct Range {
    double mean = 0;
    T min{}, max{};
};

/// One row of frames/<cell>.csv. Counts and the truth come from the lockstep replay, times from the
/// timing replay.
struct FrameRecord {
    int frame = 0;
    double wall_ms = 0, select_ms = 0, submit_ms = 0, cpu_ms = 0;
    std::optional<double> gpu_ms;
    std::optional<std::uint64_t> triangles, draw_calls, uploaded_bytes, triangles_nondegenerate;
    measure::FrameTruth truth;
};

/// What a cell measured; every absent value is null in cells.jsonl.
struct CellResult {
    CellStatus status = CellStatus::failed;
    std::string reason;  ///< names plugin and call; empty when ok
    /// Not the method's failure: what the environment refused (no device, no disk) or what is wrong
    /// with the input (terrain, path), in words. The campaign ends there and can be resumed; both
    /// empty else.
    std::string environment_error, input_error;
    std::vector<FrameRecord> frames;
    double prepare_s = 0, prepare_cpu_s = 0, upload_s = 0;
    std::optional<std::uint64_t> gpu_bytes, peak_rss_bytes;
    /// What the method asked of the terrain, and what was read from disk for it, when the timing
    /// replay ended.
    std::uint64_t samples_served = 0, tiles_served = 0, terrain_bytes_read = 0;
    std::uint64_t samples_prepared = 0;  ///< of the samples served, those while it prepared
    std::vector<std::string> modules;    ///< of lodbench, that the cell's process loaded
    Counters counters;  ///< of the lockstep replay: means over its frames, of `..._so_far` the last
    std::string depth_hash;  ///< at the randomly chosen frame, lockstep
    std::string shots_hash;  ///< of the depth images at the frames of the pictures, lockstep
    std::string terrain_name, terrain_checksum;
    std::string plugin_checksum;  ///< of the plugin file: 16 hex digits
    std::optional<double> claimed_px;
    Json::Value truth;  ///< as truth_record gives it; null where the truth was not measured
    std::vector<std::string> warnings;
    std::vector<std::string> flight_warnings;  ///< of terrain and cameras: the same for every cell
    // Context as the child saw it.
    std::string gl_vendor, gl_renderer, gl_version, device_description;
    bool software = false;
    std::string timer_verdict;
    int warmup_frames = 0, frames_in_flight = 0;  ///< of the timing replay
};

[[nodiscard]] const char* name_of(CellStatus status);

/// What the child process gives back. Reading throws InputError for what is damaged.
[[nodiscard]] std::string write_result(const CellResult& result);
[[nodiscard]] CellResult read_result(std::string_view text, const std::string& where);

/// In words, that the frames' wall time is far above the time that was spent on them; "" where it
/// is not, cannot be told, or says nothing (flights under half a second).
[[nodiscard]] std::string noise_of(const CellResult& result);

/// The object of cells.jsonl; what was not measured is null.
[[nodiscard]] Json::Value cell_record(const CellName& name, const CellResult& result,
                                      double budget_ms);

[[nodiscard]] Json::Value to_json(const Params& params);

}  // namespace lodbench::results
