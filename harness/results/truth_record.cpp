#include "results/truth_record.h"

#include <array>

#include "results/json.h"

namespace lodbench::results {

namespace {

constexpr std::array kFields = {"truth_frames",     "screen_error_px",         "visible_error_px",
                                "pixel_error_px",   "pixel_error_realtime_px", "crack_pixels",
                                "skirt_pixels",     "uncovered_samples",       "silhouette_px",
                                "popping_px",       "height_rmse_m",           "image",
                                "bound_honesty",    "clipped_segments",        "unjudged_pixels",
                                "undecided_pixels", "wall_triangles",          "economy"};

Json::Value count(std::uint64_t value) {
    return Json::UInt64(value);
}

Json::Value errors(const measure::ErrorSummary& summary,
                   const std::optional<measure::WorstPlace>& worst) {
    if (summary.count == 0) return Json::Value::null;
    Json::Value json;
    json["count"] = count(summary.count);
    json["uncovered"] = count(summary.uncovered);
    json["max"] = number_or_inf(summary.max);
    json["p999"] = number_or_inf(summary.p999);
    json["p99"] = number_or_inf(summary.p99);
    json["max_covered"] = number(summary.max_covered);
    json["rms"] = number(summary.rms);
    json["mean"] = number(summary.mean);
    json["over_tau"] = number(summary.over_tau);
    json["worst"] = Json::Value::null;
    if (worst) {
        json["worst"]["frame"] = worst->frame;
        json["worst"]["row"] = worst->row;
        json["worst"]["column"] = worst->column;
    }
    return json;
}

Json::Value fewest(const measure::Economy& economy, const measure::Fewest& fewest) {
    const std::uint64_t minimal = economy.minimal(fewest);
    Json::Value json;
    json["target_px"] = number(fewest.target_px);
    json["minimal_triangles"] = count(minimal);
    json["greedy_triangles"] = count(fewest.greedy);
    json["greedy_px"] = number_or_inf(fewest.greedy_px);
    json["ratio"] =
        minimal > 0 ? number(double(economy.triangles) / double(minimal)) : Json::Value::null;
    return json;
}

Json::Value total_and_max(std::uint64_t total, std::uint64_t max) {
    Json::Value json;
    json["total"] = count(total);
    json["max"] = count(max);
    return json;
}

}  // namespace

std::span<const char* const> truth_fields() {
    return kFields;
}

Json::Value truth_record(const measure::TruthSummary& truth) {
    Json::Value json = Json::objectValue;
    json["truth_frames"] = truth.frames;
    json["screen_error_px"] = errors(truth.screen, truth.screen_worst);
    json["visible_error_px"] = errors(truth.visible, truth.visible_worst);
    json["pixel_error_px"] = errors(truth.pixel, truth.pixel_worst);
    json["pixel_error_realtime_px"] =
        truth.pixel_realtime ? errors(*truth.pixel_realtime, truth.pixel_realtime_worst)
                             : Json::Value::null;
    json["crack_pixels"] = truth.unjudged < truth.pixels
                               ? total_and_max(truth.crack_total, truth.crack_max)
                               : Json::Value::null;
    json["skirt_pixels"] = total_and_max(truth.skirt_total, truth.skirt_max);
    json["uncovered_samples"] =
        truth.extent == measure::Extent::all ? count(truth.screen.uncovered) : Json::Value::null;
    if (!truth.economy.empty()) json["economy"] = Json::arrayValue;
    for (const measure::Economy& frame : truth.economy) {
        Json::Value figures;
        figures["frame"] = frame.frame;
        figures["triangles"] = count(frame.triangles);
        figures["full_triangles"] = count(frame.full);
        figures["p999"] = frame.p999 ? fewest(frame, *frame.p999) : Json::Value::null;
        figures["max"] = fewest(frame, frame.max);
        json["economy"].append(figures);
    }
    Json::Value& silhouette = json["silhouette_px"];
    silhouette["max"] = number(truth.silhouette_max);
    silhouette["mean"] = number(truth.silhouette_mean);
    silhouette["pixels"] = count(truth.silhouette_pixels);
    Json::Value& popping = json["popping_px"];
    if (truth.popping) {
        popping["max"] = number(truth.popping->max);
        popping["p999"] = number(truth.popping->p999);
        popping["over_1px"] = count(truth.popping_over_1px);
        popping["covered_once"] = count(truth.popping_covered_once);
    }
    Json::Value& heights = json["height_rmse_m"];
    if (truth.height_rmse_max) {
        heights["max"] = number(truth.height_rmse_max);
        heights["mean"] = number(truth.height_rmse_mean);
        heights["change_max"] = number(truth.height_rmse_change);
    }
    Json::Value& image = json["image"];
    image["psnr_db"] = number_or_inf(truth.psnr);
    image["psnr_min_db"] = number_or_inf(truth.psnr_min);
    image["ssim"] = number(truth.ssim);
    image["ssim_min"] = number(truth.ssim_min);
    json["bound_honesty"] = number_or_inf(truth.bound_honesty);
    json["clipped_segments"] = count(truth.clipped);
    json["unjudged_pixels"] = count(truth.unjudged);
    json["undecided_pixels"] = count(truth.undecided);
    json["wall_triangles"] = count(truth.walls);
    return json;
}

}  // namespace lodbench::results
