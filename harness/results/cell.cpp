#include "results/cell.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace lodbench::results {

namespace {

constexpr std::array kStatusNames = {"ok", "skipped", "failed", "crashed", "timeout"};

using Frames = std::vector<FrameRecord>;

/// Summary of one column of the frames; nothing unless every frame has it.
template <typename Value>
void sum_up(const Frames& frames, Value FrameRecord::*column,
            std::optional<measure::TimeSummary>& summary) {
    std::vector<double> values;
    for (const FrameRecord& frame : frames) {
        const std::optional<double> value = frame.*column;
        if (!value) return;
        values.push_back(*value);
    }
    if (!values.empty()) summary = measure::summarize_times(values);
}

/// Of a count over those frames that have it; nothing when none has.
template <typename Part>
void sum_up(const Frames& frames, std::optional<std::uint64_t> Part::*column,
            std::optional<CountSummary>& summary) {
    double sum = 0;
    std::size_t present = 0;
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t most = 0;
    for (const FrameRecord& frame : frames) {
        if (!(frame.*column)) continue;
        const std::uint64_t value = *(frame.*column);
        sum += double(value);
        least = std::min(least, value);
        most = std::max(most, value);
        ++present;
    }
    if (present > 0) summary = {sum / double(present), least, most};
}

std::optional<ErrorFigures> figures_of(const measure::ErrorSummary& summary,
                                       const std::optional<measure::WorstPlace>& worst) {
    if (summary.count == 0) return std::nullopt;
    return ErrorFigures{summary, worst};
}

FewestFigures figures_of(const measure::Economy& economy, const measure::Fewest& fewest) {
    const std::uint64_t minimal = economy.minimal(fewest);
    FewestFigures figures;
    figures.target_px = fewest.target_px;
    figures.greedy_px = fewest.greedy_px;
    if (minimal > 0) figures.ratio = double(economy.triangles) / double(minimal);
    figures.minimal_triangles = minimal;
    figures.greedy_triangles = fewest.greedy;
    return figures;
}

}  // namespace

template <>
struct FieldTable<CellResult> {
    using R = CellResult;
    static constexpr std::tuple fields{Field{"cell", &R::cell, "", "", true},
                                       Field{"frames", &R::frames, "", "", true},
                                       Field{"environment_error", &R::environment_error, "", ""},
                                       Field{"input_error", &R::input_error, "", ""},
                                       Field{"flight_warnings", &R::flight_warnings, "", ""},
                                       Field{"gl_vendor", &R::gl_vendor, "", ""},
                                       Field{"gl_renderer", &R::gl_renderer, "", ""},
                                       Field{"gl_version", &R::gl_version, "", ""},
                                       Field{"device_description", &R::device_description, "", ""},
                                       Field{"software", &R::software, "", ""}};
};

const char* name_of(CellStatus status) {
    return kStatusNames.at(std::size_t(status));
}

Json::Value encode(CellStatus status) {
    return name_of(status);
}

void decode(const Json::Value& json, CellStatus& status, const Place& place) {
    const auto* const name =
        json.isString() ? std::ranges::find(kStatusNames, json.asString()) : kStatusNames.end();
    place.expect(name != kStatusNames.end(), "ok, skipped, failed, crashed or timeout");
    status = CellStatus(name - kStatusNames.begin());
}

void forget_measured(CellResult& result) {
    result.frames.clear();
    CellRecord& cell = result.cell;
    for (auto* time :
         {&cell.prepare_s, &cell.prepare_cpu_s, &cell.upload_s, &cell.first_frame_ms}) {
        time->reset();
    }
    for (auto* count : {&cell.samples_served, &cell.samples_prepared, &cell.tiles_served,
                        &cell.terrain_bytes_read}) {
        count->reset();
    }
}

std::string write_result(const CellResult& result) {
    return to_text(encode(result));
}

CellResult read_result(std::string_view text, const std::string& where) {
    return read_record<CellResult>(parse_json(text, where), where);
}

Json::Value to_json(const CellRecord& cell) {
    return encode(cell);
}

CellRecord read_cell(const Json::Value& json, const std::string& where) {
    CellRecord cell = read_record<CellRecord>(json, where);
    expect_file_name(cell.cell, "cell", where);
    return cell;
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

void add_truth(CellRecord& cell, const measure::TruthSummary& truth) {
    cell.truth_frames = truth.frames;
    cell.screen_error_px = figures_of(truth.screen, truth.screen_worst);
    cell.visible_error_px = figures_of(truth.visible, truth.visible_worst);
    cell.pixel_error_px = figures_of(truth.pixel, truth.pixel_worst);
    if (truth.pixel_realtime) {
        cell.pixel_error_realtime_px =
            figures_of(*truth.pixel_realtime, truth.pixel_realtime_worst);
    }
    if (truth.unjudged < truth.pixels) {
        cell.crack_pixels = TotalAndMax{truth.crack_total, truth.crack_max};
    }
    cell.skirt_pixels = TotalAndMax{truth.skirt_total, truth.skirt_max};
    if (truth.extent == measure::Extent::all) cell.uncovered_samples = truth.screen.uncovered;
    cell.silhouette_px = {truth.silhouette_max, truth.silhouette_mean, truth.silhouette_pixels};
    if (const auto& popping = truth.popping) {
        cell.popping_px = {popping->max, popping->p999, truth.popping_over_1px,
                           truth.popping_covered_once};
    }
    if (truth.height_rmse_max) {
        cell.height_rmse_m = {truth.height_rmse_max, truth.height_rmse_mean,
                              truth.height_rmse_change};
    }
    cell.image = {truth.psnr, truth.psnr_min, truth.ssim, truth.ssim_min};
    cell.bound_honesty = truth.bound_honesty;
    cell.clipped_segments = truth.clipped;
    cell.unjudged_pixels = truth.unjudged;
    cell.undecided_pixels = truth.undecided;
    cell.wall_triangles = truth.walls;
    if (truth.economy.empty()) return;
    std::vector<EconomyFrame>& frames = cell.economy.emplace();
    for (const measure::Economy& economy : truth.economy) {
        EconomyFrame& frame = frames.emplace_back(
            EconomyFrame{economy.frame, economy.triangles, economy.full, {}, {}});
        if (economy.p999) frame.p999 = figures_of(economy, *economy.p999);
        frame.max = figures_of(economy, economy.max);
    }
}

std::optional<WholeHeightFigures> figures_of(const measure::WholeHeightSummary& whole) {
    if (whole.frames == 0) return std::nullopt;
    return WholeHeightFigures{whole.rmse_max, whole.rmse_mean, whole.rmse_change_max,
                              whole.covered_least};
}

CellRecord finish_cell(const CellName& name, const CellResult& result, double budget_ms) {
    CellRecord cell = result.cell;
    static_cast<CellName&>(cell) = name;
    cell.noise = noise_of(result);
    cell.warnings.insert(cell.warnings.begin(), result.flight_warnings.begin(),
                         result.flight_warnings.end());

    const Frames& frames = result.frames;
    if (frames.empty()) return cell;
    std::vector<double> wall;
    for (const FrameRecord& frame : frames) wall.push_back(frame.wall_ms);
    cell.frames = frames.size();
    cell.fps = measure::frames_per_second(wall);
    cell.jank_ms = measure::jank_sum(wall, budget_ms);
    each_field<CellRecord>([&](const auto& field) {
        if constexpr (requires { field.source; }) {
            sum_up(frames, field.source, cell.*field.member);
        }
    });
    return cell;
}

}  // namespace lodbench::results
