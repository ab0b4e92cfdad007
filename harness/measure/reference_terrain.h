#pragma once
// The true surface, and rays through it: the samples as served to the methods and, between them,
// the interval spanned by the two diagonals of the cell. Double precision, no GL, no code shared
// with any method: what methods are measured against.

#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "api/terrain.h"
#include "measure/height_pyramid.h"

namespace lodbench::measure {

/// Heights in metres, low <= high.
struct HeightInterval {
    double low = 0;
    double high = 0;
};

/// Where a ray meets the true surface, as multiples of its direction; infinity where it does not.
struct ReferenceHit {
    double possible;  ///< meets the nearer envelope: whichever the diagonals, nothing before it
    double certain;   ///< meets the farther envelope: whichever the diagonals, met by here
};

struct GridLine;

/// Immutable: every function may be called from several threads at once, with equal results.
class ReferenceTerrain {
public:
    /// `heights`: info.rows * info.columns finite samples in metres, row by row, row 0 the north
    /// edge; they are not copied and must outlive this object. Builds a pyramid of the least and
    /// greatest height of blocks of cells, in parallel, in a sixth of the samples' bytes. Throws
    /// ContractError where the heights are of another number. `forget` is called by what works
    /// through the samples, from several threads, after each part of them: heights that are mapped
    /// from a file may let the part go.
    ReferenceTerrain(std::span<const float> heights, const TerrainInfo& info,
                     std::function<void()> forget = {});

    [[nodiscard]] const TerrainInfo& info() const { return info_; }
    [[nodiscard]] std::span<const float> heights() const { return heights_; }
    void forget() const {
        if (forget_) forget_();
    }
    [[nodiscard]] double height(int row, int column) const;
    /// Position of a sample in the world.
    [[nodiscard]] glm::dvec3 sample(int row, int column) const;

    /// The true height at a world position (x, y), which is clamped to the extent.
    [[nodiscard]] HeightInterval interval(const glm::dvec2& position) const;

    /// Bounds of the true heights within `radius` metres in plan of a position, which is clamped to
    /// the extent: conservative, and where the ground around is even no wider than its slope times
    /// the diameter.
    [[nodiscard]] HeightInterval interval_within(const glm::dvec2& position, double radius) const;

    /// Least and greatest height of the samples of a rectangle (clamped to the grid), or an
    /// interval around it: conservative.
    [[nodiscard]] HeightInterval range(const SampleRect& samples) const;

    /// The first meeting at or after `from` (>= 0, a multiple of `direction`) of a ray with the
    /// true surface. Exact in the cells: the envelopes are piecewise linear along a ray. The
    /// surface is seen from both sides and has neither bottom nor walls: a ray that is below it
    /// where it starts, or where it enters the extent from the side, meets it from below, and the
    /// two envelopes change their roles; one that starts between them possibly meets it there, and
    /// certainly where it reaches the lower one. `direction` is not zero; its length is arbitrary.
    /// Infinity too where a coordinate is not finite or 2^50 cells away.
    [[nodiscard]] ReferenceHit cast(const glm::dvec3& origin, const glm::dvec3& direction,
                                    double from) const;

    /// Whether the segment from `eye` (finite) to the sample, its first part `from` (0..1)
    /// excepted, stays above the lower envelope or touches it, to rounding, in every cell (borders
    /// included) that does not touch the sample. So the rim that the sample's own cells share with
    /// their neighbours is asked, but not where it is the border of the extent.
    [[nodiscard]] bool sees(const glm::dvec3& eye, double from, int row, int column) const;

private:
    /// Columns east and rows south of sample (0, 0), in cells.
    [[nodiscard]] glm::dvec2 in_grid(const glm::dvec2& position) const;
    [[nodiscard]] HeightInterval interval_in_grid(double u, double v) const;
    [[nodiscard]] ReferenceHit cast_vertically(const GridLine& line, double begin,
                                               const HeightInterval& ground) const;
    template <bool kFromBelow>
    [[nodiscard]] ReferenceHit search(GridLine line, double begin, double end, bool met) const;

    std::span<const float> heights_;
    TerrainInfo info_;
    std::function<void()> forget_;
    HeightPyramid pyramid_;
    glm::dvec2 border_{0.0};  ///< cells that a position on the border may be beyond it by rounding
    double rounding_ = 0;     ///< metres that a line may be under the ground by rounding
};

}  // namespace lodbench::measure
