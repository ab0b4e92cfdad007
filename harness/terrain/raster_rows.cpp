#include "terrain/raster_rows.h"

#include <fmt/format.h>

#include <optional>

#include "api/error.h"
#include "terrain/height_rule.h"
#include "terrain/world_file.h"

namespace lodbench::terrain {
namespace {

template <typename T>
std::optional<T> first_of(const std::optional<T>& one, const std::optional<T>& other) {
    return one ? one : other;
}

}  // namespace

RasterRows::RasterRows(const TerrainSource& source) {
    const Sidecar sidecar = read_sidecar(source.file);
    reader_ = open_raster(source.file, sidecar);
    const RasterDescription description = with_world_file(source.file, reader_->description());
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
        provenance_.spacing_assumed = true;
    }
    const glm::dvec2 file_spacing = description.spacing.value_or(glm::dvec2(1));
    info_.spacing = {spacing_x.value_or(file_spacing.x), spacing_y.value_or(file_spacing.y)};
    const glm::dvec2 file_origin = description.origin.value_or(glm::dvec2(0));
    info_.origin = {first_of(source.origin_x, sidecar.origin_x).value_or(file_origin.x),
                    first_of(source.origin_y, sidecar.origin_y).value_or(file_origin.y)};
    info_.void_count = sidecar.voids_filled.value_or(0);
    rule_ = std::make_unique<HeightRule>(source, sidecar, description);
    provenance_.kind = description.kind;
    provenance_.reference = description.reference;
    for (const std::string& text : description.warnings) {
        provenance_.warnings.push_back(fmt::format("{}: {}", source.file.string(), text));
    }
    samples_.resize(std::size_t(info_.columns));
}

RasterRows::~RasterRows() = default;

int RasterRows::next(std::span<float> heights) {
    reader_->read_row(row_, samples_);
    return rule_->apply(row_++, samples_, heights);
}

Provenance RasterRows::provenance() const {
    Provenance provenance = provenance_;
    const std::vector<std::string> more = rule_->warnings();
    provenance.warnings.insert(provenance.warnings.end(), more.begin(), more.end());
    return provenance;
}

std::string RasterRows::all_void() const {
    return rule_->all_void();
}

}  // namespace lodbench::terrain
