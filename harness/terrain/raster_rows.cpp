#include "terrain/raster_rows.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "api/error.h"

namespace lodbench::terrain {
namespace {

template <typename T>
std::optional<T> first_of(const std::optional<T>& one, const std::optional<T>& other) {
    return one ? one : other;
}

}  // namespace

/// From the file's numbers to heights; voids become NaN.
class HeightRule {
public:
    HeightRule(const TerrainSource& source, const Sidecar& sidecar,
               const RasterDescription& description)
        : file_(source.file.string()),
          scale_(first_of(source.vertical_scale, sidecar.vertical_scale)
                     .value_or(description.vertical_scale)),
          offset_(first_of(source.vertical_offset, sidecar.vertical_offset)
                      .value_or(description.vertical_offset)),
          no_data_(first_of(first_of(source.no_data, sidecar.no_data), description.no_data)) {
        if (!description.unit_hint.empty() && !source.vertical_scale && !sidecar.vertical_scale) {
            throw InputError(fmt::format("{}: {}; give the vertical scale (metres per unit)", file_,
                                         description.unit_hint));
        }
        if (!std::isfinite(scale_) || !std::isfinite(offset_)) {
            throw InputError(fmt::format("{}: vertical scale {}, offset {}; both must be finite",
                                         file_, scale_, offset_));
        }
        if (no_data_ && description.float32) no_data_ = double(float(*no_data_));
    }

    int apply(int row, std::span<const double> samples, std::span<float> heights) const {
        int voids = 0;
        for (std::size_t column = 0; column < samples.size(); ++column) {
            const double sample = samples[column];
            if (is_void(sample)) {
                heights[column] = std::numeric_limits<float>::quiet_NaN();
                ++voids;
                continue;
            }
            heights[column] = float(sample * scale_ + offset_);
            if (!std::isfinite(heights[column])) {
                throw InputError(
                    fmt::format("{}: the height at row {}, column {} is {}; every height must be "
                                "finite, or its "
                                "value given as no-data",
                                file_, row, column, sample * scale_ + offset_));
            }
        }
        return voids;
    }

    [[nodiscard]] std::string all_void() const {
        return fmt::format("{}: every sample is no-data ({}); check the no-data value", file_,
                           no_data_.value_or(0));
    }

private:
    [[nodiscard]] bool is_void(double sample) const {
        return no_data_ && (sample == *no_data_ || (std::isnan(sample) && std::isnan(*no_data_)));
    }
    std::string file_;
    double scale_;
    double offset_;
    std::optional<double> no_data_;
};

RasterRows::RasterRows(const TerrainSource& source) {
    const Sidecar sidecar = read_sidecar(source.file);
    reader_ = open_raster(source.file, sidecar);
    const RasterDescription& description = reader_->description();
    info_.name = sidecar.name.value_or(source.file.stem().string());
    info_.rows = description.rows;
    info_.columns = description.columns;
    const auto spacing_x = first_of(source.spacing_x, sidecar.spacing_x);
    const auto spacing_y = first_of(source.spacing_y, sidecar.spacing_y);
    if (!description.spacing && !(spacing_x && spacing_y)) {
        if (!description.spacing_hint.empty()) {
            throw InputError(fmt::format("{}: {}; give the spacing in metres", source.file.string(),
                                         description.spacing_hint));
        }
        spacing_assumed_ = true;
    }
    const glm::dvec2 file_spacing = description.spacing.value_or(glm::dvec2(1));
    info_.spacing = {spacing_x.value_or(file_spacing.x), spacing_y.value_or(file_spacing.y)};
    const glm::dvec2 file_origin = description.origin.value_or(glm::dvec2(0));
    info_.origin = {first_of(source.origin_x, sidecar.origin_x).value_or(file_origin.x),
                    first_of(source.origin_y, sidecar.origin_y).value_or(file_origin.y)};
    info_.void_count = sidecar.voids_filled.value_or(0);
    rule_ = std::make_unique<HeightRule>(source, sidecar, description);
    samples_.resize(std::size_t(info_.columns));
}

RasterRows::~RasterRows() = default;

int RasterRows::next(std::span<float> heights) {
    reader_->read_row(row_, samples_);
    return rule_->apply(row_++, samples_, heights);
}

std::string RasterRows::all_void() const {
    return rule_->all_void();
}

}  // namespace lodbench::terrain
