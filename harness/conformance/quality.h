#pragma once
// Where the quality knob stands while a promise is put to the test: level of detail must be at
// work, or a mistake in it cannot show.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/camera.h"
#include "run/settings.h"

namespace lodbench::terrain {
class HeightField;
}

namespace lodbench::conformance {

class Session;
struct Subject;

/// One value of the quality knob.
struct Quality {
    std::string name;                  ///< for messages: "tau = 0.01 (finest)"
    run::Settings settings;            ///< for a Session; empty for a method without a knob
    std::optional<double> claimed_px;  ///< the claimed bound there; nothing where none is claimed
};

/// The subject's own setting, and the two ends between which its level of detail is at work.
struct Qualities {
    int terrain_size = 0;  ///< samples an edge of the ridged terrain on which it is at work
    Quality given;
    /// Both empty for a method without a quality knob: `given` is all that there is.
    std::optional<Quality> finest, coarse;
    /// The terrain of that size, made anew.
    [[nodiscard]] std::shared_ptr<const terrain::HeightField> terrain() const;
    /// From the coarsest to the finest.
    [[nodiscard]] std::vector<Quality> all() const;
};

/// Finds both ends by the triangles that are drawn, over a ridged terrain of 257 x 257 samples,
/// more than kViewport has pixels for; of 513 x 513 where the method leaves nothing out of that.
/// - finest: the end of the knob's range; where that draws more than kMostTriangles times those of
///   the full grid, the last step towards it that does not.
/// - coarse: the first step of a factor 2 (of a tenth of the range, for a range that does not call
///   for factors) from the given value at which at most a quarter of the finest's triangles are
///   drawn, or the end of the range.
[[nodiscard]] Qualities find_qualities(const Subject& subject);
inline constexpr std::uint64_t kMostTriangles = 8;

/// What `find_qualities` gives, found by the first check that asks and kept in the subject.
[[nodiscard]] const Qualities& qualities_of(const Subject& subject);

/// On its way between processes: one line, and what it says.
[[nodiscard]] std::string write_qualities(const Qualities& qualities);
[[nodiscard]] Qualities read_qualities(std::string_view line);

/// A camera that was selected.
struct Selected {
    Session& session;
    Camera camera;
    int frame = 0;
    std::string where;  ///< for messages: "tau = 1, camera 0 of seed 7"
};

/// Selects a few random cameras at each quality, the same ones at each, and
/// calls `check` after each.
void check_each_quality(const Subject& subject, const std::function<void(const Selected&)>& check);

}  // namespace lodbench::conformance
