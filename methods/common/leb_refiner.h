#pragma once
// From a terrain to one strip a frame, on the CPU and without OpenGL: what `lindstrom` draws.

#include <optional>

#include "common/leb_criterion.h"
#include "common/leb_morph.h"
#include "common/leb_strip.h"

namespace lodbench::common {

/// Pixels that an object of length 1 at distance 1 takes, h being the picture's height and phi its
/// field of view, both upright.
enum class LambdaForm {
    tangent,  ///< h / (2 tan(phi / 2)): exact at the centre of a flat picture
    angle,    ///< h / phi: pixels of an equal angle each; larger, so that more is refined
};

struct RefinerOptions {
    double tau = 1;  ///< pixels, > 0
    ErrorKind error = ErrorKind::midpoint;
    Metric metric = Metric::euclidean;
    bool culling = true;
    LambdaForm lambda = LambdaForm::tangent;
    double morph = 1;  ///< upper threshold over lower one, >= 1; 1: nothing morphs
};

/// Owns the grid with its criteria and the strip of the last frame.
class LebRefiner {
public:
    /// Reads and preprocesses the terrain; throws what LebGrid throws, ContractError for a tau that
    /// is not positive or a morph below 1.
    LebRefiner(const Terrain& terrain, const RefinerOptions& options);

    /// Refines for this camera; the strip stays until the next call.
    const LebStrip& refine(const Camera& camera);

    [[nodiscard]] const LebGrid& grid() const { return grid_; }
    [[nodiscard]] const LebStrip& strip() const { return strip_; }
    [[nodiscard]] const RefinerOptions& options() const { return options_; }
    /// Heights of the strip's vertices as of `refine`; nothing where nothing morphs.
    [[nodiscard]] const std::optional<LebMorph>& morph() const { return morph_; }
    /// By which `refine` decides; where vertices morph, tau is the lower threshold.
    [[nodiscard]] LebView view(const Camera& camera) const;

private:
    LebGrid grid_;
    RefinerOptions options_;
    double leaf_edge_ = 0;
    LebStrip strip_;
    std::optional<LebMorph> morph_;
};

}  // namespace lodbench::common
