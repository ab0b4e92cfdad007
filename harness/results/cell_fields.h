#pragma once
// The field tables of a cell's record and of what nests in it; see results/field.h.

#include "results/cell.h"

namespace lodbench::results {

template <>
struct FieldTable<CountSummary> {
    using R = CountSummary;
    static constexpr std::tuple fields{Field{"mean", &R::mean, "", "of the frames that have it"},
                                       Field{"min", &R::min, "", "least of a frame"},
                                       Field{"max", &R::max, "", "most of a frame"}};
};

template <>
struct FieldTable<measure::TimeSummary> {
    using R = measure::TimeSummary;
    static constexpr std::tuple fields{
        Field{"mean", &R::mean, "ms", "of all frames"},
        Field{"median", &R::median, "ms", "the middle frame"},
        Field{"p90", &R::p90, "ms", "nearest rank; from 100 frames on"},
        Field{"p95", &R::p95, "ms", "from 200 frames on"},
        Field{"p99", &R::p99, "ms", "from 1,000 frames on"},
        Field{"p999", &R::p999, "ms", "from 10,000 frames on"},
        Field{"min", &R::min, "ms", "the fastest frame"},
        Field{"max", &R::max, "ms", "the slowest frame"},
        Field{"low1", &R::low1, "ms", "1 % low: mean of the slowest 1 %; from 100 frames on"},
        Field{"low1_time", &R::low1_time, "ms",
              "1 % low by time: mean of the fewest slowest frames that together make 1 % of the "
              "time; from 100 frames on"},
        Field{"low01", &R::low01, "ms",
              "0.1 % low: mean of the slowest 0.1 %; from 1,000 frames on"}};
};

template <>
struct FieldTable<measure::WorstPlace> {
    using R = measure::WorstPlace;
    static constexpr std::tuple fields{
        Field{"frame", &R::frame, "", "frame of the greatest error"},
        Field{"row", &R::row, "", "row of its sample or pixel"},
        Field{"column", &R::column, "", "column of its sample or pixel"}};
};

template <>
struct FieldTable<ErrorFigures> {
    using R = ErrorFigures;
    static constexpr std::tuple fields{
        Field{"count", &R::count, "", "errors, of all measured frames"},
        Field{"uncovered", &R::uncovered, "", "of them infinite: where no triangle covers"},
        Field{"max", &R::max, "px", "the greatest"},
        Field{"p999", &R::p999, "px", "nearest rank: all but one in a thousand are no greater"},
        Field{"p99", &R::p99, "px", "all but one in a hundred are no greater"},
        Field{"max_covered", &R::max_covered, "px", "greatest of the finite ones"},
        Field{"rms", &R::rms, "px", "root mean square of the finite ones"},
        Field{"mean", &R::mean, "px", "mean of the finite ones"},
        Field{"over_tau", &R::over_tau, "ratio", "share above the claimed bound"},
        Field{"worst", &R::worst, "", "where the greatest is: `frame`, `row` and `column`"}};
};

template <>
struct FieldTable<TotalAndMax> {
    using R = TotalAndMax;
    static constexpr std::tuple fields{Field{"total", &R::total, "", "of all measured frames"},
                                       Field{"max", &R::max, "", "most of a frame"}};
};

template <>
struct FieldTable<SilhouetteFigures> {
    using R = SilhouetteFigures;
    static constexpr std::tuple fields{
        Field{"max", &R::max, "px", "greatest offset of a column"},
        Field{"mean", &R::mean, "px", "mean offset of all columns"},
        Field{"pixels", &R::pixels, "",
              "where one of picture and truth shows sky and the other terrain"}};
};

template <>
struct FieldTable<PoppingFigures> {
    using R = PoppingFigures;
    static constexpr std::tuple fields{
        Field{"max", &R::max, "px", "the greatest"},
        Field{"p999", &R::p999, "px", "all but one in a thousand are no greater"},
        Field{"over_1px", &R::over_1px, "", "samples that move by more than a pixel"},
        Field{"covered_once", &R::covered_once, "",
              "samples that only one of the two frames covers"}};
};

template <>
struct FieldTable<HeightFigures> {
    using R = HeightFigures;
    static constexpr std::tuple fields{
        Field{"max", &R::max, "m", "of the worst frame"},
        Field{"mean", &R::mean, "m", "over the frames"},
        Field{"change_max", &R::change_max, "m", "greatest between a frame and the next"}};
};

template <>
struct FieldTable<WholeHeightFigures> {
    using R = WholeHeightFigures;
    static constexpr std::tuple fields{
        Field{"max", &R::max, "m", "of the worst frame; null unless every frame covers all"},
        Field{"mean", &R::mean, "m", "over the frames; likewise"},
        Field{"change_max", &R::change_max, "m",
              "greatest between a measured frame and the next one that is; likewise"},
        Field{"covered", &R::covered, "ratio",
              "samples of the terrain that a triangle covers, in the frame with the fewest"}};
};

template <>
struct FieldTable<PictureFigures> {
    using R = PictureFigures;
    static constexpr std::tuple fields{
        Field{"psnr_db", &R::psnr_db, "dB", "of the mean squared error of all frames"},
        Field{"psnr_min_db", &R::psnr_min_db, "dB", "of the worst frame"},
        Field{"ssim", &R::ssim, "", "mean over the frames"},
        Field{"ssim_min", &R::ssim_min, "", "of the worst frame"}};
};

template <>
struct FieldTable<FewestFigures> {
    using R = FewestFigures;
    static constexpr std::tuple fields{
        Field{"target_px", &R::target_px, "px", "error that the method's surface measured"},
        Field{"minimal_triangles", &R::minimal_triangles, "",
              "the fewer of the greedy insertion's and the full grid's"},
        Field{"greedy_triangles", &R::greedy_triangles, "",
              "of a greedy insertion for the samples in view, at no greater error"},
        Field{"greedy_px", &R::greedy_px, "px", "their error, measured like a method's"},
        Field{"ratio", &R::ratio, "ratio", "triangles drawn / minimal"}};
};

template <>
struct FieldTable<EconomyFrame> {
    using R = EconomyFrame;
    static constexpr std::tuple fields{
        Field{"frame", &R::frame, "", "which", true},
        Field{"triangles", &R::triangles, "", "drawn, those with an area"},
        Field{"full_triangles", &R::full_triangles, "",
              "of the full grid, those that reach into the frustum"},
        Field{"p999", &R::p999, "", "at the screen error's P99.9"},
        Field{"max", &R::max, "", "at its greatest"}};
};

template <>
struct FieldTable<SensorFigures> {
    using R = SensorFigures;
    static constexpr std::tuple fields{
        Field{"begin", &R::begin, "", "of the first, as the replay's warm-up frames began"},
        Field{"end", &R::end, "", "of the last, taken in the last fifth of its frames"},
        Field{"min", &R::min, "", "least of all samples"},
        Field{"max", &R::max, "", "greatest of all samples"},
        Field{"mean", &R::mean, "", "of all samples"}};
};

template <>
struct FieldTable<HealthFigures> {
    using R = HealthFigures;
    static constexpr std::tuple fields{
        Field{"samples", &R::samples, "",
              "how often the sensors were read while it drew: as it began, each second, and near "
              "its end"},
        Field{"seconds", &R::seconds, "s",
              "from the first sample until it was over: the time in which the figures below, from "
              "`cpu_throttles` on, are counted"},
        Field{"gpu_mhz", &R::gpu_mhz, "MHz", "clock of the GPU that drew"},
        Field{"gpu_c", &R::gpu_c, "°C", "its temperature"},
        Field{"gpu_w", &R::gpu_w, "W", "its power"},
        Field{"cpu_mhz", &R::cpu_mhz, "MHz", "clock of the fastest core that the cell may use"},
        Field{"load_average", &R::load_average, "",
              "processes that ran or waited to, mean of a minute: of the cell, of the cell before "
              "it, and of others"},
        Field{"gpu_fall", &R::gpu_fall, "ratio",
              "greatest fall of the GPU's clock from a sample to a later one, of the former"},
        Field{"gpu_limit_c", &R::gpu_limit_c, "°C",
              "temperature at which the GPU's maker slows it down"},
        Field{"gpu_throttle", &R::gpu_throttle, "",
              "why the GPU was held below its clock, in any of the samples; empty: it was not"},
        Field{"cpu_throttles", &R::cpu_throttles, "",
              "how often cores that the cell may use were slowed down for heat"},
        Field{
            "cgroup_held_s", &R::cgroup_held_s, "s",
            "for which CPU quotas of control groups held processes back, summed over their cores"},
        Field{"others_cores", &R::others_cores, "cores",
              "that other programs took, of those that the cell may use; from half a second on"},
        Field{"idle_cores", &R::idle_cores, "cores", "of these, that nobody used"},
        Field{"cores", &R::cores, "", "that the cell may use"}};
};

template <>
struct FieldTable<CellRecord> {
    using R = CellRecord;
    using enum Elsewhere;
    static constexpr std::tuple fields{
        Field{"cell", &R::cell, "", "its name, that of its files", true},
        Field{"method", &R::method, "", "id of the method", true},
        Field{"scenario", &R::scenario, "", "name of the scenario", true},
        Field{"params", &R::params, "", "all parameters of the method, by their names", true},
        Field{"repetition", &R::repetition, "", "from 0", true},
        Field{"seed", &R::seed, "", "of what is drawn by lot"}.repeats(never),
        Field{"status", &R::status, "", "ok, skipped, failed, crashed or timeout", true},
        Field{"reason", &R::reason, "",
              "why it is not ok, naming plugin and call. What a method throws is cut after 1000 "
              "bytes; of a process that died its last words are told"},

        Field{"frames", &R::frames, "", "frames timed"}.repeats(exactly),
        Field{"fps", &R::fps, "1/s", "1000 / mean frame time in ms"},
        Field{"jank_ms", &R::jank_ms, "ms",
              "sum over the frames of what goes over the scenario's budget"},
        Field{"frame_ms", &R::frame_ms, "", "wall time of a frame"}.sums(&FrameRecord::wall_ms),
        Field{"select_ms", &R::select_ms, "", "of it, selecting"}.sums(&FrameRecord::select_ms),
        Field{"submit_ms", &R::submit_ms, "", "of it, submitting"}.sums(&FrameRecord::submit_ms),
        Field{"gpu_ms", &R::gpu_ms, "", "GPU time of a frame"}.sums(&FrameRecord::gpu_ms),
        Field{"cpu_ms", &R::cpu_ms, "", "CPU time of a frame, all threads"}.sums(
            &FrameRecord::cpu_ms),
        Field{"triangles", &R::triangles, "",
              "what the GPU was asked to draw in a frame, degenerates included"}
            .repeats(exactly)
            .sums(&FrameRecord::triangles),
        Field{"triangles_nondegenerate", &R::triangles_nondegenerate, "",
              "of the captured triangles, those with an area, over the frames that are measured "
              "(each n-th, `measure.every`)"}
            .repeats(exactly)
            .sums(&FrameRecord::triangles_nondegenerate),
        Field{"draw_calls", &R::draw_calls, "", "of a frame"}.repeats(exactly).sums(
            &FrameRecord::draw_calls),
        Field{"uploaded_bytes", &R::uploaded_bytes, "bytes", "of a frame"}.repeats(exactly).sums(
            &FrameRecord::uploaded_bytes),

        Field{"truth_frames", &R::truth_frames, "", "frames measured"}.repeats(exactly),
        Field{"screen_error_px", &R::screen_error_px, "",
              "over the samples of which the true or the drawn point lies in view: distance on "
              "screen between the two. This is what a claimed bound is about"}
            .repeats(rounded),
        Field{"visible_error_px", &R::visible_error_px, "",
              "the same over the samples that the camera sees"}
            .repeats(rounded),
        Field{"pixel_error_px", &R::pixel_error_px, "",
              "over the pixels: of each drawn point against the true height there, and of each "
              "true point (a ray's) against the surface drawn there. What a viewer sees; cannot be "
              "diluted by distant samples, or flattered by drawing nothing"}
            .repeats(rounded),
        Field{"pixel_error_realtime_px", &R::pixel_error_realtime_px, "",
              "the same in the real-time replay; null for synchronous methods"},
        Field{"crack_pixels", &R::crack_pixels, "",
              "pixels that show what lies behind the surface: their ray passes below it, over "
              "covered ground, before the part of the surface or the sky that was drawn"}
            .repeats(exactly),
        Field{"skirt_pixels", &R::skirt_pixels, "",
              "pixels that show a skirt: their drawn point is in no pixel error"}
            .repeats(exactly),
        Field{"uncovered_samples", &R::uncovered_samples, "",
              "samples in view that no triangle covers"}
            .repeats(exactly),
        Field{"silhouette_px", &R::silhouette_px, "", "per column, offset of the first terrain row"}
            .repeats(rounded),
        Field{"popping_px", &R::popping_px, "",
              "how far drawn points in the later view move on screen from a frame to the next, the "
              "camera's own motion apart; over the samples that both frames have in view, for what "
              "a turn brings in was not seen to pop"}
            .repeats(rounded),
        Field{"height_rmse_m", &R::height_rmse_m, "",
              "root mean square of drawn minus true height over the samples in view"}
            .repeats(rounded),
        Field{"height_rmse_whole_m", &R::height_rmse_whole_m, "",
              "the same over all samples of the terrain, out of view too, flown once more with "
              "the method's parameter `culling` off; where `measure.whole` asks for it"}
            .repeats(rounded),
        Field{"image", &R::image, "",
              "shaded picture against the full grid's. A surface without error that splits the "
              "cells along other diagonals is shaded otherwise"}
            .repeats(rounded),
        Field{"bound_honesty", &R::bound_honesty, "ratio",
              "greatest screen error / claimed bound: above 1 the claim does not hold"}
            .repeats(rounded),
        Field{"clipped_segments", &R::clipped_segments, "", "errors cut at the near plane"}.repeats(
            exactly),
        Field{"unjudged_pixels", &R::unjudged_pixels, "",
              "pixels whose ray starts below the surface, so that a crack cannot be told"}
            .repeats(exactly),
        Field{"undecided_pixels", &R::undecided_pixels, "",
              "drawn pixels in no pixel error, for they show no point of the surface that was "
              "drawn, over ground so steep that their depth leaves their error uncertain by more "
              "than a pixel to either side"}
            .repeats(exactly),
        Field{"wall_triangles", &R::wall_triangles, "",
              "upright triangles that stand above the surface, like a fence (most in a frame): "
              "without extent in plan, so in no screen error, but in the picture, so in the pixel "
              "error and the silhouette"}
            .repeats(exactly),
        Field{"economy", &R::economy, "",
              "of each frame that `measure.economy` names, the triangles drawn beside those that "
              "would have done"}
            .repeats(rounded),

        Field{"prepare_s", &R::prepare_s, "s", "preprocessing, wall time"},
        Field{"prepare_cpu_s", &R::prepare_cpu_s, "s", "preprocessing, CPU time of all threads"},
        Field{"upload_s", &R::upload_s, "s", "start-up: GPU objects made"},
        Field{"first_frame_ms", &R::first_frame_ms, "ms",
              "wall time of the first frame that the method ever draws, after `upload_s` and until "
              "the GPU is done: of the warm-up where there is one, which is in no `frame_ms`"},
        Field{"samples_served", &R::samples_served, "",
              "height samples that the method asked for until its timing replay ended"},
        Field{"samples_prepared", &R::samples_prepared, "",
              "of these, those that it asked for while it prepared"}
            .repeats(exactly),
        Field{"tiles_served", &R::tiles_served, "", "tiles of which they came"},
        Field{"terrain_bytes_read", &R::terrain_bytes_read, "bytes",
              "read from the terrain's file for that; 0 for a terrain in memory"},
        Field{"gpu_bytes", &R::gpu_bytes, "bytes", "allocated on the GPU through the harness"},
        Field{"peak_rss_bytes", &R::peak_rss_bytes, "bytes",
              "resident memory of the method's process when its timing replay ended"},
        Field{"counters", &R::counters, "",
              "the method's own figures in the lockstep replay: means over its frames or, where "
              "the name ends in `_so_far`, the last"},
        Field{"claimed_px", &R::claimed_px, "px",
              "the error bound that its paper claims: a claim, neither measured nor warranted"}
            .repeats(exactly),

        Field{"cell_s", &R::cell_s, "s",
              "the whole cell, wall time: its process, the terrain, preprocessing, all replays and "
              "the truth. What `lodbench plan --from` expects times by"},
        Field{"began", &R::began, "",
              "when its process was started, UTC, to the millisecond: which of two runs' cells "
              "were flown in turn"},

        Field{"depth_hash", &R::depth_hash, "",
              "of the depth image at one frame, equal between replays"}
            .repeats(never),
        Field{"shots_hash", &R::shots_hash, "",
              "of the depth images at the frames of `shots` in lockstep: equal between "
              "repetitions, or the tables warn"}
            .repeats(exactly),
        Field{"terrain", &R::terrain, "", "its name"},
        Field{"terrain_checksum", &R::terrain_checksum, "", "of the grid as served: 16 hex digits"}
            .repeats(exactly),
        Field{"plugin_checksum", &R::plugin_checksum, "", "of the plugin's file: 16 hex digits"},
        Field{"device", &R::device, "",
              "what flew it: renderer and version of OpenGL, processor and cores. Times of two "
              "devices are never pooled"},
        Field{"timer_verdict", &R::timer_verdict, "",
              "whether the GPU's timer can be believed, and what was used instead"},
        Field{"warmup_frames", &R::warmup_frames, "", "frames flown before the timing replay"},
        Field{"frames_in_flight", &R::frames_in_flight, "",
              "how many the GPU may be behind: 1 where every frame ends with `glFinish`"},
        Field{"modules", &R::modules, "",
              "modules of lodbench that the cell's process loaded: what the scenario does not need "
              "is not there"},
        Field{"noise", &R::noise, "",
              "in words, that the wall time of the frames is over 1.5 times the CPU time (on a "
              "GPU: and GPU time, and half a millisecond a frame) spent on them; null where it is "
              "not, cannot be told, or the flight took less than half a second. `run.json` has "
              "`noise` of the machine: a CPU quota or a load average (`load_average`) above the "
              "cores"},
        Field{"health", &R::health, "",
              "what the sensors of GPU and CPU said while the timing replay was flown; null where "
              "it was over before they could be read"},
        Field{"warnings", &R::warnings, "",
              "what was noticed on the way: what a plugin left changed in its process or left "
              "running, what is doubtful about the terrain or the flight. The terrain's and the "
              "flight's are in `run.json` and `flights/NAME.json` too, and are printed once"},
        Field{"frames_checksum", &R::frames_checksum, "", "of the cell's file in `frames/`"}};
};

using CellFigure = Figure<CellRecord>;

/// For whoever names figures, with `using namespace results::figures`:
/// of<&Cell::frame_ms, &TimeSummary::median>.
namespace figures {

using Cell = CellRecord;
using measure::TimeSummary;
using results::CountSummary, results::ErrorFigures, results::TotalAndMax,
    results::SilhouetteFigures, results::PoppingFigures, results::HeightFigures,
    results::WholeHeightFigures, results::PictureFigures;

template <auto... Members>
inline constexpr CellFigure of = figure<CellRecord, Members...>();

}  // namespace figures

}  // namespace lodbench::results
