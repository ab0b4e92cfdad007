#include "measure/truth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "api/error.h"
#include "measure/map_size.h"

namespace lodbench::measure {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::optional<double> rmse(const HeightSums& heights) {
    if (heights.count == 0) return std::nullopt;
    return std::sqrt(heights.sum_of_squares / double(heights.count));
}

std::optional<double> mean_of(const std::vector<double>& values) {
    if (values.empty()) return std::nullopt;
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / double(values.size());
}

template <typename Compare>
std::optional<double> extreme(const std::vector<double>& values, Compare compare) {
    if (values.empty()) return std::nullopt;
    return *std::min_element(values.begin(), values.end(), compare);
}

/// The pixel of greatest error, of equals the first; both directions.
WorstSample worst_pixel(const PixelErrors& errors, int width) {
    WorstSample worst;
    for (std::size_t i = 0; i < errors.marks.size(); ++i) {
        for (const float px : {errors.drawn_px[i], errors.reference_px[i]}) {
            if (!(px > worst.px)) continue;
            worst = {px, int(i / std::size_t(width)), int(i % std::size_t(width))};
        }
    }
    return worst;
}

void keep_worst(const WorstSample& candidate, int frame, double& px,
                std::optional<WorstPlace>& place) {
    if (!(candidate.px > px)) return;
    px = candidate.px;
    place = {frame, candidate.row, candidate.column};
}

}  // namespace

TruthMeter::TruthMeter(std::span<const float> heights, const TerrainInfo& info,
                       std::optional<double> claimed, Extent extent, std::function<void()> forget)
    : terrain_(heights, info, std::move(forget)),
      claimed_(claimed),
      extent_(extent),
      bound_(claimed.value_or(kInfinity)) {
    total_.extent = extent;
}

void TruthMeter::take(int frame, const Camera& camera, CapturedSurface&& surface,
                      FrameTruth* before) {
    std::swap(now_, before_);
    now_.frame = frame;
    now_.camera = camera;
    now_.measured = false;
    now_.height_rmse.reset();
    const bool pops = before_.measured && before_.frame + 1 == frame;
    // The old ones' memory first.
    now_.drawn.reset();
    if (!pops) before_.drawn.reset();
    surface_.reset();
    surface_ = std::make_shared<const DrawnSurface>(std::move(surface), terrain_.info());
    if (extent_ == Extent::pixels) return;
    now_.drawn.emplace(surface_, terrain_);
    if (!pops) return;

    const Popping popping = measure_popping(terrain_, {before_.camera, *before_.drawn},
                                            {now_.camera, *now_.drawn}, frame_);
    const ErrorSummary summary = frame_.summary(false);
    popping_.take(frame_);
    ++popping_frames_;
    total_.popping_over_1px += popping.over_1px;
    total_.popping_covered_once += popping.covered_once;
    now_.height_rmse = rmse(popping.heights);
    if (now_.height_rmse && before_.height_rmse) {
        total_.height_rmse_change = std::max(total_.height_rmse_change.value_or(0),
                                             std::abs(*now_.height_rmse - *before_.height_rmse));
    }
    if (before == nullptr) return;
    before->popping_max_px = summary.max;
    before->popping_p999_px = summary.p999;
}

FrameTruth TruthMeter::measure(std::span<const float> depth, std::vector<std::uint8_t> drawn_rgb,
                               const ReferenceView& view) {
    if (!surface_) throw ContractError("TruthMeter::measure: no frame was taken");
    FrameTruth truth;
    PixelErrors pixels =
        measure_pixels(terrain_, *surface_, now_.camera, view.hits, depth, bound_, frame_);
    const ErrorSummary pixel = frame_.summary(false);
    truth.pixel_max_px = pixel.max;
    truth.pixel_p999_px = pixel.p999;
    truth.pixel_rms_px = pixel.rms;
    truth.crack_pixels = pixels.crack_pixels;
    truth.skirt_pixels = pixels.skirt_pixels;
    truth.silhouette_pixels = pixels.silhouette_pixels;
    truth.silhouette_max_px = pixels.silhouette_max;
    pixel_.take(frame_);
    keep_worst(worst_pixel(pixels, now_.camera.viewport.width), now_.frame, pixel_worst_px_,
               total_.pixel_worst);
    ++total_.frames;
    total_.crack_total += pixels.crack_pixels;
    total_.crack_max = std::max(total_.crack_max, pixels.crack_pixels);
    total_.skirt_total += pixels.skirt_pixels;
    total_.skirt_max = std::max(total_.skirt_max, pixels.skirt_pixels);
    total_.clipped += pixels.clipped;
    total_.unjudged += pixels.unjudged_pixels;
    total_.undecided += pixels.undecided_pixels;
    total_.pixels += depth.size();
    total_.walls = std::max(total_.walls, surface_->wall_triangle_count());
    total_.silhouette_max = std::max(total_.silhouette_max, pixels.silhouette_max);
    total_.silhouette_pixels += pixels.silhouette_pixels;
    silhouette_sum_ += pixels.silhouette_mean;
    if (extent_ == Extent::all) {
        measure_samples_into(truth, view);
        measure_picture_into(truth, drawn_rgb, view.picture);
    }
    now_.measured = true;
    now_.height_rmse = truth.height_rmse_m;
    keep_if_worst(truth, pixel, std::move(pixels), std::move(drawn_rgb), view.picture);
    return truth;
}

void TruthMeter::measure_samples_into(FrameTruth& truth, const ReferenceView& view) {
    const SampleErrors samples = measure_samples(terrain_, now_.camera, *now_.drawn, bound_, frame_,
                                                 VisibleErrors{view, frame_visible_});
    const ErrorSummary screen = frame_.summary(false);
    now_.screen = screen;
    const ErrorSummary visible = frame_visible_.summary(false);
    truth.screen_max_px = screen.max;
    truth.screen_p999_px = screen.p999;
    truth.screen_rms_px = screen.rms;
    truth.visible_max_px = visible.max;
    truth.visible_p999_px = visible.p999;
    truth.uncovered_samples = screen.uncovered;
    truth.height_rmse_m = rmse(samples.heights);
    screen_.take(frame_);
    visible_.take(frame_visible_);
    keep_worst(samples.worst, now_.frame, screen_worst_px_, total_.screen_worst);
    keep_worst(samples.worst_visible, now_.frame, visible_worst_px_, total_.visible_worst);
    total_.clipped += samples.clipped;
    if (truth.height_rmse_m) rmse_.push_back(*truth.height_rmse_m);
}

void TruthMeter::measure_picture_into(FrameTruth& truth, std::span<const std::uint8_t> drawn_rgb,
                                      std::span<const std::uint8_t> reference_rgb) {
    const Viewport& size = now_.camera.viewport;
    const ImageDifference image = image_difference({drawn_rgb, size.width, size.height},
                                                   {reference_rgb, size.width, size.height});
    truth.psnr_db = psnr_db(image.mean_squared_error);
    truth.ssim = image.ssim;
    squared_errors_.push_back(image.mean_squared_error);
    if (image.ssim) ssim_.push_back(*image.ssim);
}

void TruthMeter::keep_if_worst(const FrameTruth& truth, const ErrorSummary& pixel,
                               PixelErrors&& pixels, std::vector<std::uint8_t>&& drawn_rgb,
                               const std::vector<std::uint8_t>& reference_rgb) {
    const auto rank = [](const ErrorSummary& errors) {
        return std::tuple(errors.p999.value_or(-1), errors.uncovered, errors.rms.value_or(-1));
    };
    if (worst_ && !(rank(pixel) > rank(worst_pixel_))) return;
    worst_pixel_ = pixel;
    worst_.emplace();
    worst_->frame = now_.frame;
    worst_->camera = now_.camera;
    worst_->drawn_rgb = std::move(drawn_rgb);
    worst_->reference_rgb = reference_rgb;
    worst_->pixels = std::move(pixels);
    worst_->truth = truth;
    worst_->pixel_max_covered = pixel.max_covered;
    const MapSize map(terrain_.info());
    worst_->map_rows = map.rows;
    worst_->map_columns = map.columns;
    if (extent_ == Extent::pixels) {
        worst_->map_px.assign(std::size_t(worst_->map_rows) * std::size_t(worst_->map_columns),
                              std::numeric_limits<float>::quiet_NaN());
        return;
    }
    worst_->map_px =
        map_of_errors(terrain_, now_.camera, *now_.drawn, worst_->map_rows, worst_->map_columns);
}

Fewest TruthMeter::find_fewest(double target_px, ErrorBound bound) const {
    const GreedyTriangulation greedy =
        greedy_triangulation(terrain_, now_.camera, target_px, bound);
    const DrawnSamples drawn(std::make_shared<const DrawnSurface>(
                                 surface_of(greedy, terrain_, now_.camera), terrain_.info()),
                             terrain_);
    ErrorPool all;
    (void)measure_samples(terrain_, now_.camera, drawn, kInfinity, all);
    const ErrorSummary errors = all.summary(false);
    const auto measured = bound == ErrorBound::max ? errors.max : errors.p999;
    return {target_px, greedy.in_view, measured.value_or(0)};
}

void TruthMeter::find_economy(std::uint64_t triangles) {
    if (!now_.measured || extent_ != Extent::all) {
        throw ContractError("TruthMeter::find_economy: no frame's samples were measured");
    }
    const ErrorSummary& errors = now_.screen;
    if (!errors.max_covered) return;
    Economy& economy = total_.economy.emplace_back();
    economy.frame = now_.frame;
    economy.triangles = triangles;
    economy.full = full_grid_in_view(terrain_, now_.camera);
    economy.max = find_fewest(*errors.max_covered, ErrorBound::max);
    if (std::isfinite(*errors.p999)) {
        economy.p999 = find_fewest(*errors.p999, ErrorBound::p999);
    }
}

void TruthMeter::measure_realtime(int frame, const Camera& camera, CapturedSurface&& surface,
                                  std::span<const ReferenceHit> hits,
                                  std::span<const float> depth) {
    const DrawnSurface drawn(std::move(surface), terrain_.info());
    const PixelErrors pixels =
        measure_pixels(terrain_, drawn, camera, hits, depth, bound_, realtime_);
    keep_worst(worst_pixel(pixels, camera.viewport.width), frame, realtime_worst_px_,
               total_.pixel_realtime_worst);
}

TruthSummary TruthMeter::summary() const {
    TruthSummary summary = total_;
    const bool bounded = claimed_.has_value();
    summary.screen = screen_.summary(bounded);
    summary.visible = visible_.summary(bounded);
    summary.pixel = pixel_.summary(bounded);
    if (popping_frames_ > 0) summary.popping = popping_.summary(false);
    if (realtime_.sums().count > 0) summary.pixel_realtime = realtime_.summary(bounded);
    if (total_.frames > 0) summary.silhouette_mean = silhouette_sum_ / total_.frames;
    summary.height_rmse_max = extreme(rmse_, std::greater<>());
    summary.height_rmse_mean = mean_of(rmse_);
    if (const auto worst = extreme(squared_errors_, std::greater<>())) {
        summary.psnr_min = psnr_db(*worst);
        summary.psnr = psnr_db(*mean_of(squared_errors_));
    }
    summary.ssim_min = extreme(ssim_, std::less<>());
    summary.ssim = mean_of(ssim_);
    if (claimed_ && summary.screen.max) summary.bound_honesty = *summary.screen.max / *claimed_;
    return summary;
}

}  // namespace lodbench::measure
