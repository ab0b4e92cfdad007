#pragma once
// The truth about a cell: what the frames of its lockstep replay really showed, frame by frame and
// pooled over the flight. See docs/measurement.md for what each figure means.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "measure/capture.h"
#include "measure/drawn_samples.h"
#include "measure/error_pool.h"
#include "measure/greedy_triangulation.h"
#include "measure/image_difference.h"
#include "measure/pixel_errors.h"
#include "measure/reference_terrain.h"
#include "measure/reference_view.h"
#include "measure/sample_errors.h"

namespace lodbench::measure {

/// What is measured of a frame.
enum class Extent {
    all,
    pixels,  ///< pixel error, cracks, skirts and silhouette: nothing of samples, popping and
             ///< pictures
};

/// A measured frame's row. Pixels and metres; +infinity where uncovered places reach into the
/// figure.
struct FrameTruth {
    std::optional<double> screen_max_px, screen_p999_px, screen_rms_px, visible_max_px,
        visible_p999_px, pixel_max_px, pixel_p999_px, pixel_rms_px;
    std::optional<std::uint64_t> uncovered_samples, crack_pixels, skirt_pixels, silhouette_pixels;
    std::optional<double> silhouette_max_px;
    std::optional<double> popping_max_px, popping_p999_px;  ///< to the next frame
    std::optional<double> height_rmse_m;
    std::optional<double> height_rmse_whole_m;  ///< see whole_heights.h; only where it is asked for
    std::optional<double> psnr_db, ssim;
};

/// The frame that looked worst: what is needed to show it.
struct WorstFrame {
    int frame = 0;
    Camera camera;
    std::vector<std::uint8_t> drawn_rgb, reference_rgb;  ///< row 0 at the top
    PixelErrors pixels;
    int map_rows = 0, map_columns = 0;
    std::vector<float> map_px;  ///< as map_of_errors; all NaN where only pixels are measured
    FrameTruth truth;
    std::optional<double> pixel_max_covered;  ///< greatest finite pixel error
};

/// Where an error was greatest: a sample's row and column, or a pixel's.
struct WorstPlace {
    int frame = 0, row = 0, column = 0;
};

/// The fewest triangles that are known to do for a frame at one error; see greedy_triangulation.h.
struct Fewest {
    double target_px = 0;      ///< what the method's own surface measured
    std::uint64_t greedy = 0;  ///< triangles that reach into the frustum
    double greedy_px = 0;      ///< their error, measured like a method's
};

/// A frame's triangles beside those that would have done at the same measured screen error.
struct Economy {
    int frame = 0;
    std::uint64_t triangles = 0;  ///< that the method drew, with an area
    std::uint64_t full = 0;       ///< of the full grid, that reach into the frustum
    Fewest max;                   ///< at its greatest error, uncovered samples apart
    std::optional<Fewest> p999;   ///< at its P99.9; nothing where uncovered samples reach into it
    /// Of the greedy ones and the full grid the fewer.
    [[nodiscard]] std::uint64_t minimal(const Fewest& fewest) const {
        return std::min(fewest.greedy, full);
    }
};

/// Over all measured frames. Counts are totals unless they say otherwise.
struct TruthSummary {
    int frames = 0;
    Extent extent = Extent::all;
    ErrorSummary screen, visible, pixel;
    std::optional<WorstPlace> screen_worst, visible_worst, pixel_worst;
    std::uint64_t crack_total = 0, crack_max = 0, skirt_total = 0, skirt_max = 0;
    std::uint64_t clipped = 0;   ///< segments from true to drawn points cut at near depth
    std::uint64_t unjudged = 0;  ///< pixels whose ray starts below l_f: cracks cannot be told there
    std::uint64_t undecided = 0;  ///< drawn pixels without a pixel error: see kJudgedPx
    std::uint64_t pixels = 0;     ///< of all measured frames
    std::uint64_t walls =
        0;  ///< upright triangles above l_f, in no screen error; greatest of a frame
    double silhouette_max = 0, silhouette_mean = 0;
    std::uint64_t silhouette_pixels = 0;
    std::optional<ErrorSummary> popping;  ///< absent where no frame had a successor
    std::uint64_t popping_over_1px = 0, popping_covered_once = 0;
    std::optional<double> height_rmse_max, height_rmse_mean;
    std::optional<double> height_rmse_change;  ///< greatest between a frame and the next
    std::optional<double> psnr,
        psnr_min;  ///< dB; of the mean squared error of all frames, of the worst
    std::optional<double> ssim, ssim_min;  ///< mean over the frames, and of the worst
    std::optional<double> bound_honesty;   ///< greatest screen error / claimed bound
    std::optional<ErrorSummary> pixel_realtime;
    std::optional<WorstPlace> pixel_realtime_worst;
    std::vector<Economy> economy;
};

class TruthMeter {
public:
    /// `heights` and `forget` as for ReferenceTerrain; `claimed`: the method's bound in pixels,
    /// where it has one.
    TruthMeter(std::span<const float> heights, const TerrainInfo& info,
               std::optional<double> claimed, Extent extent = Extent::all,
               std::function<void()> forget = {});

    /// What the method drew at `frame`. Where the frame before was measured, what popped between
    /// the two goes into `before`.
    void take(int frame, const Camera& camera, CapturedSurface&& surface, FrameTruth* before);

    /// Measures the frame that was taken last: its depth image (see measure_pixels) and shaded
    /// picture, RGB, row 0 at the top. `view` is of the same camera, its picture of the same size.
    [[nodiscard]] FrameTruth measure(std::span<const float> depth,
                                     std::vector<std::uint8_t> drawn_rgb,
                                     const ReferenceView& view);

    /// Of the frame that was measured last, of which the method drew `triangles` with an area.
    /// Takes seconds. Nothing where no sample in view is covered.
    void find_economy(std::uint64_t triangles);

    /// The same frame as the real-time replay drew it; `hits` as of reference_hits.
    void measure_realtime(int frame, const Camera& camera, CapturedSurface&& surface,
                          std::span<const ReferenceHit> hits, std::span<const float> depth);

    [[nodiscard]] TruthSummary summary() const;
    /// By P99.9 of the pixel error, then uncovered pixels, then RMS; nothing before the first
    /// frame.
    [[nodiscard]] const std::optional<WorstFrame>& worst_frame() const { return worst_; }
    [[nodiscard]] const ReferenceTerrain& terrain() const { return terrain_; }

private:
    [[nodiscard]] Fewest find_fewest(double target_px, ErrorBound bound) const;
    struct Taken {
        int frame = -1;
        Camera camera;
        std::optional<DrawnSamples> drawn;  ///< nothing where only pixels are measured
        bool measured = false;
        ErrorSummary screen;  ///< where samples were measured
        std::optional<double> height_rmse;
    };
    void measure_samples_into(FrameTruth& truth, const ReferenceView& view);
    void measure_picture_into(FrameTruth& truth, std::span<const std::uint8_t> drawn_rgb,
                              std::span<const std::uint8_t> reference_rgb);
    void keep_if_worst(const FrameTruth& truth, const ErrorSummary& pixel, PixelErrors&& pixels,
                       std::vector<std::uint8_t>&& drawn_rgb,
                       const std::vector<std::uint8_t>& reference_rgb);

    ReferenceTerrain terrain_;
    std::optional<double> claimed_;
    Extent extent_;
    double bound_;
    Taken now_, before_;
    std::shared_ptr<const DrawnSurface> surface_;  ///< of now_
    ErrorPool screen_, visible_, pixel_, popping_, realtime_;
    ErrorPool frame_, frame_visible_;  ///< of one frame; empty in between
    TruthSummary total_;
    double screen_worst_px_ = -1, visible_worst_px_ = -1, pixel_worst_px_ = -1,
           realtime_worst_px_ = -1;
    int popping_frames_ = 0;
    std::vector<double> rmse_, squared_errors_, ssim_;
    double silhouette_sum_ = 0;
    ErrorSummary worst_pixel_;
    std::optional<WorstFrame> worst_;
};

}  // namespace lodbench::measure
