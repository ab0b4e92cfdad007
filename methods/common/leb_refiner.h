#pragma once
// From a terrain to one strip a frame, on the CPU and without OpenGL: what `lindstrom` draws.

#include "common/leb_criterion.h"
#include "common/leb_strip.h"

namespace lodbench::common {

struct RefinerOptions {
    double tau = 1;  ///< pixels, > 0
    ErrorKind error = ErrorKind::midpoint;
    Metric metric = Metric::euclidean;
    bool culling = true;
};

/// Owns the grid with its criteria and the strip of the last frame.
class LebRefiner {
public:
    /// Reads and preprocesses the terrain; throws what LebGrid throws, ContractError for a tau that
    /// is not positive.
    LebRefiner(const Terrain& terrain, const RefinerOptions& options);

    /// Refines for this camera; the strip stays until the next call.
    const LebStrip& refine(const Camera& camera);

    [[nodiscard]] const LebGrid& grid() const { return grid_; }
    [[nodiscard]] const LebStrip& strip() const { return strip_; }
    [[nodiscard]] const RefinerOptions& options() const { return options_; }
    [[nodiscard]] LebView view(const Camera& camera) const {
        return {grid_, camera, options_.tau, options_.metric, leaf_edge_};
    }

private:
    LebGrid grid_;
    RefinerOptions options_;
    double leaf_edge_ = 0;
    LebStrip strip_;
};

}  // namespace lodbench::common
