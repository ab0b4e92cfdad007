#include "common/leb_refiner.h"

#include <string>

#include "api/error.h"

namespace lodbench::common {
namespace {

template <Metric metric>
void build(const LebGrid& grid, const LebView& view, unsigned planes, LebStrip& strip) {
    const LebCriterion<metric> criterion(view);
    LebStripBuilder(grid, criterion, strip).build(planes);
}

}  // namespace

LebRefiner::LebRefiner(const Terrain& terrain, const RefinerOptions& options)
    : grid_(terrain), options_(options) {
    if (!(options.tau > 0)) {
        throw ContractError("LebRefiner: expected tau > 0, got " + std::to_string(options.tau));
    }
    compute_errors_by_level(grid_, options.error);
    if (options.culling) leaf_edge_ = longest_leaf_edge(grid_);
}

const LebStrip& LebRefiner::refine(const Camera& camera) {
    const LebView current = view(camera);
    const unsigned planes = options_.culling ? kAllPlanes : 0;
    if (options_.metric == Metric::planar) {
        build<Metric::planar>(grid_, current, planes, strip_);
    } else {
        build<Metric::euclidean>(grid_, current, planes, strip_);
    }
    return strip_;
}

}  // namespace lodbench::common
