#include "terrain/provenance.h"

#include <fmt/format.h>

namespace lodbench::terrain {

std::string void_warning(const TerrainInfo& info) {
    constexpr double kLargeShare = 0.1;
    const double share = double(info.void_count) / (double(info.rows) * info.columns);
    if (share < kLargeShare) return {};
    return fmt::format(
        "terrain '{}': {:.3g} % of its samples ({}) had no data and were filled from their "
        "neighbours: "
        "much of the surface is made up",
        info.name, 100 * share, info.void_count);
}

}  // namespace lodbench::terrain
