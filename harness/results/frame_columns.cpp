#include "results/frame_columns.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <type_traits>

#include "api/error.h"
#include "results/json.h"

namespace lodbench::results {

namespace {

// A column of the CSV, and of the array that a frame is between the two processes: its name and the
// member behind it. All values go through double, which holds every count below 2^53.
struct Column {
    const char* name;
    double (*get)(const FrameRecord& frame);  ///< NaN: absent
    void (*set)(FrameRecord& frame, double value);
};

template <auto Member>
constexpr Column column(const char* name) {
    return {name, [](const FrameRecord& frame) { return double(frame.*Member); },
            [](FrameRecord& frame, double value) {
                frame.*Member = std::remove_cvref_t<decltype(frame.*Member)>(value);
            }};
}

template <typename Owner, typename Optional>
double value_or_nan(const Owner& owner, Optional Owner::*member) {
    return owner.*member ? double(*(owner.*member)) : NAN;
}

template <typename Owner, typename T>
void set_optional(Owner& owner, std::optional<T> Owner::*member, double value) {
    if (!std::isnan(value)) owner.*member = T(value);
}

template <auto Member>
constexpr Column optional_column(const char* name) {
    return {name, [](const FrameRecord& frame) { return value_or_nan(frame, Member); },
            [](FrameRecord& frame, double value) { set_optional(frame, Member, value); }};
}

template <auto Member>
constexpr Column truth_column(const char* name) {
    return {name, [](const FrameRecord& frame) { return value_or_nan(frame.truth, Member); },
            [](FrameRecord& frame, double value) { set_optional(frame.truth, Member, value); }};
}

using measure::FrameTruth;
constexpr std::array kColumns = {
    column<&FrameRecord::frame>("frame"),
    column<&FrameRecord::wall_ms>("wall_ms"),
    column<&FrameRecord::select_ms>("select_ms"),
    column<&FrameRecord::submit_ms>("submit_ms"),
    column<&FrameRecord::cpu_ms>("cpu_ms"),
    optional_column<&FrameRecord::gpu_ms>("gpu_ms"),
    optional_column<&FrameRecord::triangles>("triangles"),
    optional_column<&FrameRecord::triangles_nondegenerate>("triangles_nondegenerate"),
    optional_column<&FrameRecord::draw_calls>("draw_calls"),
    optional_column<&FrameRecord::uploaded_bytes>("uploaded_bytes"),
    truth_column<&FrameTruth::screen_max_px>("screen_max_px"),
    truth_column<&FrameTruth::screen_p999_px>("screen_p999_px"),
    truth_column<&FrameTruth::screen_rms_px>("screen_rms_px"),
    truth_column<&FrameTruth::visible_max_px>("visible_max_px"),
    truth_column<&FrameTruth::visible_p999_px>("visible_p999_px"),
    truth_column<&FrameTruth::pixel_max_px>("pixel_max_px"),
    truth_column<&FrameTruth::pixel_p999_px>("pixel_p999_px"),
    truth_column<&FrameTruth::pixel_rms_px>("pixel_rms_px"),
    truth_column<&FrameTruth::uncovered_samples>("uncovered_samples"),
    truth_column<&FrameTruth::crack_pixels>("crack_pixels"),
    truth_column<&FrameTruth::skirt_pixels>("skirt_pixels"),
    truth_column<&FrameTruth::silhouette_pixels>("silhouette_pixels"),
    truth_column<&FrameTruth::silhouette_max_px>("silhouette_max_px"),
    truth_column<&FrameTruth::popping_max_px>("popping_max_px"),
    truth_column<&FrameTruth::popping_p999_px>("popping_p999_px"),
    truth_column<&FrameTruth::height_rmse_m>("height_rmse_m"),
    truth_column<&FrameTruth::psnr_db>("psnr_db"),
    truth_column<&FrameTruth::ssim>("ssim"),
};

}  // namespace

Json::Value to_json(const FrameRecord& frame) {
    Json::Value row = Json::arrayValue;
    for (const Column& column : kColumns) {
        row.append(results::number_or_inf(column.get(frame)));
    }
    return row;
}

FrameRecord read_frame(const Json::Value& row, const std::string& where) {
    if (!row.isArray() || row.size() != kColumns.size()) {
        throw InputError(
            fmt::format("{}: a frame does not have {} columns", where, kColumns.size()));
    }
    FrameRecord frame;
    for (Json::ArrayIndex i = 0; i < row.size(); ++i) {
        const std::optional<double> value = results::read_number_or_inf(row[i]);
        if (!value && !row[i].isNull()) {
            throw InputError(
                fmt::format("{}: column {} of a frame is no number", where, kColumns[i].name));
        }
        kColumns[i].set(frame, value.value_or(NAN));
    }
    return frame;
}

std::string frames_csv(const std::vector<FrameRecord>& frames) {
    std::string csv;
    for (const Column& column : kColumns) {
        csv += fmt::format("{}{}", csv.empty() ? "" : ",", column.name);
    }
    for (const FrameRecord& frame : frames) {
        csv += '\n';
        for (std::size_t i = 0; i < kColumns.size(); ++i) {
            const double value = kColumns[i].get(frame);
            if (i > 0) csv += ',';
            if (!std::isnan(value)) csv += fmt::format("{}", value);
        }
    }
    return csv + '\n';
}

}  // namespace lodbench::results
