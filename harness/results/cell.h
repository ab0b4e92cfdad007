#pragma once
// A cell's record: a line of cells.jsonl. And what a cell's process gives back, of which it is
// made.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/method.h"
#include "measure/statistics.h"
#include "measure/truth.h"
#include "measure/whole_heights.h"
#include "results/field.h"
#include "results/frame.h"
#include "results/record_json.h"

namespace lodbench::results {

enum class CellStatus { ok, skipped, failed, crashed, timeout };
[[nodiscard]] const char* name_of(CellStatus status);
[[nodiscard]] Json::Value encode(CellStatus status);
void decode(const Json::Value& json, CellStatus& status, const Place& place);

/// A count over those frames that have it.
struct CountSummary {
    std::optional<double> mean;
    std::optional<std::uint64_t> min, max;
};

/// Pixels, or samples, over the frames measured.
struct TotalAndMax {
    std::optional<std::uint64_t> total;
    std::optional<std::uint64_t> max;  ///< of a frame
};

struct ErrorFigures : measure::ErrorSummary {
    std::optional<measure::WorstPlace> worst;
};

struct SilhouetteFigures {
    std::optional<double> max, mean;
    std::optional<std::uint64_t> pixels;
};

struct PoppingFigures {
    std::optional<double> max, p999;
    std::optional<std::uint64_t> over_1px, covered_once;
};

struct HeightFigures {
    std::optional<double> max, mean, change_max;
};

/// Over all samples of the terrain.
struct WholeHeightFigures {
    std::optional<double> max, mean, change_max, covered;
};

struct PictureFigures {
    std::optional<double> psnr_db, psnr_min_db, ssim, ssim_min;
};

/// How few triangles would have done at an error, beside those that were drawn.
struct FewestFigures {
    std::optional<double> target_px, greedy_px, ratio;
    std::optional<std::uint64_t> minimal_triangles, greedy_triangles;
};

struct EconomyFrame {
    int frame = 0;
    std::optional<std::uint64_t> triangles, full_triangles;
    std::optional<FewestFigures> p999, max;
};

/// A sensor over the samples of a cell's timing replay.
struct SensorFigures {
    std::optional<double> begin, end, min, max, mean;
};

/// What the machine's sensors said while a cell was timed.
struct HealthFigures {
    std::optional<int> samples;
    std::optional<double> seconds;
    std::optional<SensorFigures> gpu_mhz, gpu_c, gpu_w, cpu_mhz, load_average;
    std::optional<double> gpu_fall, gpu_limit_c;
    std::optional<std::vector<std::string>> gpu_throttle;  ///< empty: none was seen
    std::optional<std::uint64_t> cpu_throttles;
    std::optional<double> cgroup_held_s;
    std::optional<double> others_cores, idle_cores;
    std::optional<int> cores;
};

/// Which cell of a campaign it is.
struct CellName {
    std::string cell;  ///< file-name safe, unique in the campaign: "lindstrom__tau=1__demo__r0"
    std::string scenario, method;
    Params params;
    int repetition = 0;
    std::uint64_t seed = 1;
};

/// What is absent, here and in what nests in it, was not measured. Members have the names of the
/// fields; the table says what they mean.
struct CellRecord : CellName {
    CellStatus status = CellStatus::failed;
    std::string reason;  ///< empty when ok

    // Times and counts, summed up from the frames.
    std::optional<std::uint64_t> frames;
    std::optional<double> fps, jank_ms;
    std::optional<measure::TimeSummary> frame_ms, select_ms, submit_ms, gpu_ms, cpu_ms;
    std::optional<CountSummary> triangles, triangles_nondegenerate, draw_calls, uploaded_bytes;

    // The truth.
    std::optional<int> truth_frames;
    std::optional<ErrorFigures> screen_error_px, visible_error_px, pixel_error_px,
        pixel_error_realtime_px;
    std::optional<TotalAndMax> crack_pixels, skirt_pixels;
    std::optional<std::uint64_t> uncovered_samples;
    std::optional<SilhouetteFigures> silhouette_px;
    std::optional<PoppingFigures> popping_px;
    std::optional<HeightFigures> height_rmse_m;
    std::optional<WholeHeightFigures> height_rmse_whole_m;
    std::optional<PictureFigures> image;
    std::optional<double> bound_honesty;
    std::optional<std::uint64_t> clipped_segments, unjudged_pixels, undecided_pixels,
        wall_triangles;
    std::optional<std::vector<EconomyFrame>> economy;

    // What it took, and what it asked of the terrain until the timing replay ended.
    std::optional<double> prepare_s, prepare_cpu_s, upload_s, first_frame_ms;
    std::optional<std::uint64_t> samples_served, samples_prepared, tiles_served, terrain_bytes_read;
    std::optional<std::uint64_t> gpu_bytes, peak_rss_bytes;
    Counters counters;
    std::optional<double> claimed_px;
    std::optional<double> cell_s;
    std::string began;

    // Under which conditions.
    std::string depth_hash, shots_hash;
    std::string terrain, terrain_checksum, plugin_checksum;
    std::string device;
    std::string timer_verdict;
    int warmup_frames = 0, frames_in_flight = 0;
    std::vector<std::string> modules;
    std::string noise;
    std::optional<HealthFigures> health;
    std::vector<std::string> warnings;
    std::string frames_checksum;
};

/// What a cell's process gives back.
struct CellResult {
    CellRecord cell;  ///< its parameters, and what finish_cell sums up, left out
    std::vector<FrameRecord> frames;
    /// Not the method's failure: what the environment refused (no device, no disk) or what is wrong
    /// with the input (terrain, path), in words. The campaign ends there and can be resumed; both
    /// empty else.
    std::string environment_error, input_error;
    std::vector<std::string> flight_warnings;  ///< of terrain and cameras: the same for every cell
    // Context as the process saw it.
    std::string gl_vendor, gl_renderer, gl_version, device_description;
    bool software = false;
};

/// Of a cell that did not come to its end: its frames, its times and what it was served say
/// nothing.
void forget_measured(CellResult& result);

/// What the child process gives back. Reading throws InputError for what is damaged.
[[nodiscard]] std::string write_result(const CellResult& result);
[[nodiscard]] CellResult read_result(std::string_view text, const std::string& where);

/// In words, that the frames' wall time is far above the time that was spent on them; "" where it
/// is not, cannot be told, or says nothing (flights under half a second).
[[nodiscard]] std::string noise_of(const CellResult& result);

/// Into a record without the truth's figures.
void add_truth(CellRecord& cell, const measure::TruthSummary& truth);

/// Nothing where no frame was measured.
[[nodiscard]] std::optional<WholeHeightFigures> figures_of(
    const measure::WholeHeightSummary& whole);

/// The record of a cell, its times and counts summed up from the frames, whose budget is
/// `budget_ms`.
[[nodiscard]] CellRecord finish_cell(const CellName& name, const CellResult& result,
                                     double budget_ms);

/// A line of cells.jsonl, parsed. Throws InputError with `where`, the member and the remedy for
/// what is not one.
[[nodiscard]] CellRecord read_cell(const Json::Value& json, const std::string& where);
[[nodiscard]] Json::Value to_json(const CellRecord& cell);

}  // namespace lodbench::results

// The tables belong to the records.
#include "results/cell_fields.h"
