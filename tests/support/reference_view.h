#pragma once
// The reference's view of a camera, with a picture of the test's own.

#include <utility>
#include <vector>

#include "measure/reference_view.h"

namespace lodbench::test {

inline measure::ReferenceView view_of(const measure::ReferenceTerrain& terrain,
                                      const Camera& camera, std::vector<std::uint8_t> picture) {
    return {measure::seen_samples(terrain, camera, {terrain, camera}),
            measure::reference_hits(terrain, camera), std::move(picture)};
}

}  // namespace lodbench::test
