#pragma once
// The reference's view of a camera, with a picture of the test's own.

#include <utility>
#include <vector>

#include "measure/reference_view.h"

namespace lodbench::measure::test {

inline ReferenceView view_of(const ReferenceTerrain& terrain, const Camera& camera,
                             std::vector<std::uint8_t> picture) {
    return {seen_samples(terrain, camera, {terrain, camera}), reference_hits(terrain, camera),
            std::move(picture)};
}

}  // namespace lodbench::measure::test
