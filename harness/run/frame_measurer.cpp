#include "run/frame_measurer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "picture/heights_picture.h"
#include "picture/png.h"
#include "picture/truth_picture.h"

namespace lodbench::run {

const ParamInfo* culling_param(const MethodInfo& method) {
    const auto found = std::ranges::find_if(method.params, [](const ParamInfo& param) {
        return param.name == "culling" && param.type == ParamType::boolean;
    });
    return found == method.params.end() ? nullptr : &*found;
}

FrameMeasurer::FrameMeasurer(Stage& stage, std::optional<double> claimed,
                             std::shared_ptr<const terrain::WholeTerrain> truth, ViewCache views,
                             measure::Extent extent)
    : stage_(&stage), truth_(std::move(truth)), views_(std::move(views)), extent_(extent) {
    if (!truth_) return;
    meter_.emplace(truth_->samples(), truth_->info(), claimed, extent,
                   [whole = truth_.get()] { whole->forget(); });
}

measure::CapturedSurface FrameMeasurer::capture() {
    measure::CapturedSurface surface = stage_->capture();
    const auto broken = measure::nonfinite_count(surface);
    if (broken > 0) {
        throw MethodFailure(
            fmt::format("draw of plugin {} sent {} of {} vertices that are not finite",
                        stage_->plugin_name(), broken, surface.vertices.size()));
    }
    return surface;
}

void FrameMeasurer::take(int frame, const results::FrameRecord& record,
                         results::FrameRecord* before) {
    measure::CapturedSurface surface = capture();
    if (surface.triangle_count() != record.triangles) {
        throw MethodFailure(fmt::format(
            "draw of plugin {} generated {} triangles, of which {} went through "
            "gl::Device: draw calls must go through it",
            stage_->plugin_name(), record.triangles.value_or(0), surface.triangle_count()));
    }
    nondegenerate_ = measure::nondegenerate_count(surface);
    frame_ = frame;
    if (!meter_) return;
    meter_->take(frame, stage_->camera(), std::move(surface), before == nullptr ? nullptr : before);
}

void FrameMeasurer::measure(results::FrameRecord& record) {
    record.triangles_nondegenerate = nondegenerate_;
    if (!meter_) return;
    stage_->draw_picture();
    const std::vector<float> depth = stage_->read_depth();
    std::vector<std::uint8_t> drawn = stage_->read_color();
    static_cast<measure::FrameTruth&>(record) =
        meter_->measure(depth, std::move(drawn), reference_view());
}

measure::ReferenceView FrameMeasurer::reference_view() {
    const Camera& camera = stage_->camera();
    if (auto kept = views_.find(frame_, camera)) return std::move(*kept);
    const measure::HiddenGround hidden(meter_->terrain(), camera);
    stage_->draw_reference_picture(truth_, &hidden);
    // Where only pixels are measured, what is seen is for others.
    std::vector<std::uint64_t> seen;
    if (extent_ == measure::Extent::all || views_.keeps()) {
        seen = measure::seen_samples(meter_->terrain(), camera, hidden);
    }
    measure::ReferenceView view{std::move(seen), measure::reference_hits(meter_->terrain(), camera),
                                stage_->read_color()};
    views_.keep(frame_, camera, view);
    return view;
}

void FrameMeasurer::find_economy() {
    if (meter_) meter_->find_economy(nondegenerate_);
}

void FrameMeasurer::measure_realtime(int frame) {
    if (!meter_) return;
    measure::CapturedSurface surface = capture();
    stage_->draw_picture();
    const Camera& camera = stage_->camera();
    auto kept = views_.find(frame, camera);
    const std::vector<measure::ReferenceHit> hits =
        kept ? std::move(kept->hits) : measure::reference_hits(meter_->terrain(), camera);
    meter_->measure_realtime(frame, camera, std::move(surface), hits, stage_->read_depth());
}

void FrameMeasurer::measure_whole(results::FrameRecord& record) {
    whole_camera_ = stage_->camera();
    const measure::DrawnSurface drawn(capture(), meter_->terrain().info());
    if (!whole_.empty()) whole_.back().map_m = {};  // a megabyte a frame
    whole_.push_back(measure::measure_whole_heights(meter_->terrain(), drawn));
    record.height_rmse_whole_m = whole_.back().rmse();
}

void FrameMeasurer::warn_of_the_whole(results::CellRecord& cell) const {
    if (!cell.height_rmse_whole_m || cell.height_rmse_whole_m->mean) return;
    cell.warnings.push_back(fmt::format(
        "covers {:.4g} % of the terrain's samples in the frame with the fewest, {}: there is no "
        "height error of the whole",
        100 * cell.height_rmse_whole_m->covered.value_or(0),
        culling_param(stage_->method()) ? "with culling off"
                                        : "and has no parameter `culling` to turn off"));
}

void FrameMeasurer::finish(results::CellRecord& cell) const {
    if (!meter_) return;
    const measure::TruthSummary summary = meter_->summary();
    results::add_truth(cell, summary);
    cell.height_rmse_whole_m = results::figures_of(measure::summarize(whole_));
    warn_of_the_whole(cell);
    if (summary.walls > 0) {
        cell.warnings.push_back(fmt::format(
            "up to {} upright triangles of a frame stand above the surface, where no error is "
            "measured on them: skirts hang down",
            summary.walls));
    }
    if (summary.unjudged > 0) {
        cell.warnings.push_back(
            fmt::format("{} of {} measured pixels look from below the surface: whether they show a "
                        "crack cannot "
                        "be told",
                        summary.unjudged, summary.pixels));
    }
    if (summary.undecided > 0) {
        cell.warnings.push_back(fmt::format(
            "{} of {} measured pixels show no point of the surface that was drawn, over ground so "
            "steep that their depth cannot tell their error: they are left out of the pixel error",
            summary.undecided, summary.pixels));
    }
}

std::vector<float> FrameMeasurer::map_heights(int rows, int columns) const {
    const measure::ReferenceTerrain& terrain = meter_->terrain();
    const auto middle = [](int cell, int cells, int samples) {
        return int((2 * std::int64_t(cell) + 1) * samples / (2 * std::int64_t(cells)));
    };
    std::vector<float> heights;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            heights.push_back(
                float(terrain.height(middle(row, rows, terrain.info().rows),
                                     middle(column, columns, terrain.info().columns))));
        }
        terrain.forget();
    }
    return heights;
}

void FrameMeasurer::write_heights(const std::filesystem::path& path,
                                  const std::string& title) const {
    const measure::WholeHeights& whole = whole_.back();
    picture::HeightsPicture picture{.camera = whole_camera_,
                                    .terrain = meter_->terrain().info(),
                                    .map_rows = whole.map.rows,
                                    .map_columns = whole.map.columns,
                                    .map_height = map_heights(whole.map.rows, whole.map.columns),
                                    .map_error_m = whole.map_m,
                                    .title = title,
                                    .caption = {}};
    float greatest = 0;
    for (const float error : whole.map_m) {
        if (std::isfinite(error)) greatest = std::max(greatest, error);
    }
    picture.scale_m = picture::nice_scale(double(greatest));
    const std::optional<double> rmse = whole.rmse();
    picture.caption = {
        rmse ? fmt::format("root mean square {:.4g} m over {} samples, greatest {:.4g} m", *rmse,
                           whole.samples, greatest)
             : fmt::format(
                   "{} of {} samples are covered; of them the greatest difference is {:.4g} m",
                   whole.covered, whole.samples, greatest)};
    const picture::Image image = picture::draw(picture);
    picture::write_png(path, image.width, image.height, image.rgb);
}

void FrameMeasurer::write_picture(const std::filesystem::path& path,
                                  const std::string& title) const {
    if (!meter_ || !meter_->worst_frame()) return;
    const measure::WorstFrame& worst = *meter_->worst_frame();
    const measure::ReferenceTerrain& terrain = meter_->terrain();
    picture::TruthPicture picture;
    picture.camera = worst.camera;
    picture.terrain = terrain.info();
    picture.drawn_rgb = worst.drawn_rgb;
    picture.reference_rgb = worst.reference_rgb;
    picture.marks = worst.pixels.marks;
    for (std::size_t i = 0; i < worst.pixels.marks.size(); ++i) {
        // fmax passes over a NaN: nothing to compare in one direction.
        picture.error_px.push_back(
            std::fmax(worst.pixels.drawn_px[i], worst.pixels.reference_px[i]));
    }
    picture.map_rows = worst.map_rows;
    picture.map_columns = worst.map_columns;
    picture.map_error_px = worst.map_px;
    picture.map_height = map_heights(worst.map_rows, worst.map_columns);
    // A scale to P99.9, so that one pixel does not darken all others; uncovered places have a
    // colour of their own.
    const double p999 = worst.truth.pixel_p999_px.value_or(0);
    const double greatest = worst.pixel_max_covered.value_or(0);
    picture.scale_px = picture::nice_scale(std::isfinite(p999) && p999 > 0 ? p999 : greatest);
    const auto px = [](const std::optional<double>& value) {
        return value ? fmt::format("{:.3g} px", *value) : std::string("-");
    };
    picture.title = fmt::format("{}, frame {}: the worst of those measured", title, worst.frame);
    picture.caption = {
        fmt::format("pixel error P99.9 {}, max {}; screen error P99.9 {}, max {}",
                    px(worst.truth.pixel_p999_px), px(worst.truth.pixel_max_px),
                    px(worst.truth.screen_p999_px), px(worst.truth.screen_max_px)),
        fmt::format("crack pixels {}, sky against terrain {}, uncovered samples {}",
                    worst.truth.crack_pixels.value_or(0), worst.truth.silhouette_pixels.value_or(0),
                    worst.truth.uncovered_samples.value_or(0))};
    const picture::Image image = picture::draw(picture);
    picture::write_png(path, image.width, image.height, image.rgb);
}

}  // namespace lodbench::run
