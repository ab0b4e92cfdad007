#include "common/leb_refiner.h"

#include <string>

#include "api/error.h"

namespace lodbench::common {
namespace {

template <Metric metric>
void build(const LebGrid& grid, const LebView& view, unsigned planes, LebStrip& strip,
           std::optional<LebMorph>& morph) {
    const LebCriterion<metric> criterion(view);
    LebStripBuilder(grid, criterion, strip).build(planes);
    if (morph) morph->place<metric>(view, strip.indices());
}

}  // namespace

LebRefiner::LebRefiner(const Terrain& terrain, const RefinerOptions& options)
    : grid_(terrain), options_(options) {
    if (!(options.tau > 0)) {
        throw ContractError("LebRefiner: expected tau > 0, got " + std::to_string(options.tau));
    }
    if (!(options.morph >= 1)) {
        throw ContractError("LebRefiner: expected morph >= 1, got " +
                            std::to_string(options.morph));
    }
    compute_errors_by_level(grid_, options.error);
    if (options.morph > 1) morph_.emplace(grid_, options.morph);
    if (options.culling) leaf_edge_ = longest_leaf_edge(grid_);
}

LebView LebRefiner::view(const Camera& camera) const {
    double tau = options_.tau / morph_reserve(options_.morph);
    if (options_.lambda == LambdaForm::angle) {
        // LebView takes the tangent's form.
        tau *= camera.lambda() / (camera.viewport.height / camera.vertical_fov);
    }
    return {grid_, camera, tau, options_.metric, leaf_edge_};
}

const LebStrip& LebRefiner::refine(const Camera& camera) {
    const LebView current = view(camera);
    const unsigned planes = options_.culling ? kAllPlanes : 0;
    if (options_.metric == Metric::planar) {
        build<Metric::planar>(grid_, current, planes, strip_, morph_);
    } else {
        build<Metric::euclidean>(grid_, current, planes, strip_, morph_);
    }
    return strip_;
}

}  // namespace lodbench::common
