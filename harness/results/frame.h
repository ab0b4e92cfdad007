#pragma once
// A frame's record: a row of frames/<cell>.csv, and an array on its way between processes.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "measure/truth.h"
#include "results/field.h"
#include "results/record_json.h"

namespace lodbench::results {

/// Counts and the truth come from the lockstep replay, times from the timing replay.
struct FrameRecord : measure::FrameTruth {
    int frame = 0;
    double wall_ms = 0, select_ms = 0, submit_ms = 0, cpu_ms = 0;
    std::optional<double> gpu_ms;
    std::optional<std::uint64_t> triangles, draw_calls, uploaded_bytes, triangles_nondegenerate;
};

template <>
struct FieldTable<FrameRecord> {
    using R = FrameRecord;
    using enum Elsewhere;
    static constexpr std::tuple fields{
        Field{"frame", &R::frame, "", "from 0"},
        Field{"wall_ms", &R::wall_ms, "ms", "wall time, submission included"},
        Field{"select_ms", &R::select_ms, "ms", "of it, selecting"},
        Field{"submit_ms", &R::submit_ms, "ms", "of it, submitting"},
        Field{"cpu_ms", &R::cpu_ms, "ms", "CPU time of all threads"},
        Field{"gpu_ms", &R::gpu_ms, "ms", "GPU time"},
        Field{"triangles", &R::triangles, "", "that the GPU was asked to draw"}.repeats(exactly),
        Field{"triangles_nondegenerate", &R::triangles_nondegenerate, "",
              "of the captured triangles, those with an area"}
            .repeats(exactly),
        Field{"draw_calls", &R::draw_calls, "", "issued"}.repeats(exactly),
        Field{"uploaded_bytes", &R::uploaded_bytes, "bytes", "sent to the GPU"}.repeats(exactly),
        Field{"screen_max_px", &R::screen_max_px, "px", "greatest screen error"}.repeats(rounded),
        Field{"screen_p999_px", &R::screen_p999_px, "px", "P99.9 of it"}.repeats(rounded),
        Field{"screen_rms_px", &R::screen_rms_px, "px", "root mean square of it"}.repeats(rounded),
        Field{"visible_max_px", &R::visible_max_px, "px",
              "greatest screen error of the samples that the camera sees"}
            .repeats(rounded),
        Field{"visible_p999_px", &R::visible_p999_px, "px", "P99.9 of it"}.repeats(rounded),
        Field{"pixel_max_px", &R::pixel_max_px, "px", "greatest pixel error"}.repeats(rounded),
        Field{"pixel_p999_px", &R::pixel_p999_px, "px", "P99.9 of it"}.repeats(rounded),
        Field{"pixel_rms_px", &R::pixel_rms_px, "px", "root mean square of it"}.repeats(rounded),
        Field{"uncovered_samples", &R::uncovered_samples, "",
              "samples in view that no triangle covers"}
            .repeats(exactly),
        Field{"crack_pixels", &R::crack_pixels, "", "pixels that show what lies behind the surface"}
            .repeats(exactly),
        Field{"skirt_pixels", &R::skirt_pixels, "", "pixels that show a skirt"}.repeats(exactly),
        Field{"silhouette_pixels", &R::silhouette_pixels, "",
              "where one of picture and truth shows sky and the other terrain"}
            .repeats(exactly),
        Field{"silhouette_max_px", &R::silhouette_max_px, "px",
              "greatest offset of a column's first terrain row"}
            .repeats(rounded),
        Field{"popping_max_px", &R::popping_max_px, "px", "greatest popping to the next frame"}
            .repeats(rounded),
        Field{"popping_p999_px", &R::popping_p999_px, "px", "P99.9 of it"}.repeats(rounded),
        Field{"height_rmse_m", &R::height_rmse_m, "m",
              "root mean square of drawn minus true height, samples in view"}
            .repeats(rounded),
        Field{"height_rmse_whole_m", &R::height_rmse_whole_m, "m",
              "the same over all samples of the terrain, flown with culling off"}
            .repeats(rounded),
        Field{"psnr_db", &R::psnr_db, "dB", "shaded picture against the full grid's"}.repeats(
            rounded),
        Field{"ssim", &R::ssim, "", "likewise"}.repeats(rounded)};
};

/// Not an object, for there are thousands: an array of numbers in the fields' order.
[[nodiscard]] Json::Value encode(const FrameRecord& frame);
void decode(const Json::Value& json, FrameRecord& frame, const Place& place);

/// frames/<cell>.csv: a header and a line for each frame; what was not measured is an empty field,
/// an infinite error the text inf.
[[nodiscard]] std::string frames_csv(const std::vector<FrameRecord>& frames);

}  // namespace lodbench::results
