#include "measure/drawn_samples.h"

#include <algorithm>
#include <utility>

namespace lodbench::measure {

DrawnSamples::DrawnSamples(std::shared_ptr<const DrawnSurface> surface,
                           const ReferenceTerrain& terrain) {
    if (surface->bytes() <= terrain.heights().size_bytes()) {
        surface_ = std::move(surface);
        return;
    }
    displacements_.resize(terrain.heights().size());
    surface->displacements(terrain.heights(), displacements_);
}

std::optional<HeightInterval> DrawnSamples::bounds() const {
    if (!surface_) return std::nullopt;
    return surface_->bounds();
}

void DrawnSamples::copy(const ReferenceTerrain& terrain, const SampleRect& rect,
                        std::span<float> result) const {
    if (surface_) {
        surface_->displacements(terrain.heights(), rect, result);
        return;
    }
    const std::size_t columns = std::size_t(terrain.info().columns);
    for (int row = 0; row < rect.rows; ++row) {
        const std::size_t first = std::size_t(rect.row + row) * columns + std::size_t(rect.column);
        std::copy_n(&displacements_[first], rect.columns,
                    result.begin() + std::ptrdiff_t(row) * rect.columns);
    }
}

}  // namespace lodbench::measure
