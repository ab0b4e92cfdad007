#include "measure/reference_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "measure/box_in_view.h"
#include "measure/pixel_projection.h"

namespace lodbench::measure {

namespace {

constexpr std::size_t kWord = 64;  // samples a task's boundary must not divide
constexpr double kSlack = 1e-9;

}  // namespace

std::vector<std::uint64_t> seen_samples(const ReferenceTerrain& terrain, const Camera& camera,
                                        const HiddenGround& hidden) {
    const TerrainInfo& info = terrain.info();
    const PixelProjection pixels(camera);
    const BoxInView in_view(camera, kSlack);
    const std::size_t columns = std::size_t(info.columns);
    std::vector<std::uint64_t> seen((terrain.heights().size() + kWord - 1) / kWord);
    // Words, not rows: a word may hold the end of one row and the beginning of the next.
    constexpr std::size_t kRun = 64;  // words a task
    tbb::parallel_for(std::size_t{0}, (seen.size() + kRun - 1) / kRun, [&](std::size_t task) {
        const std::size_t begin = task * kRun * kWord;
        const std::size_t end = std::min(begin + kRun * kWord, terrain.heights().size());
        for (std::size_t first = begin; first < end;) {
            const int row = int(first / columns);
            const int column = int(first % columns);
            const int count = int(std::min({end - first, columns - first % columns, kWord}));
            const HeightInterval heights = terrain.range({row, column, 1, count});
            const glm::dvec2 west = info.position(row, column);
            const glm::dvec2 east = info.position(row, column + count - 1);
            if (in_view({west, heights.low}, {east, heights.high})) {
                for (int i = column; i < column + count; ++i) {
                    if (hidden.sample(row, i)) continue;
                    const glm::dvec3 local = pixels.local(terrain.sample(row, i));
                    if (!pixels.in_view(local) ||
                        !terrain.sees(camera.position, camera.near_plane / local.z, row, i)) {
                        continue;
                    }
                    const std::size_t index = first + std::size_t(i - column);
                    seen[index / kWord] |= std::uint64_t{1} << (index % kWord);
                }
            }
            first += std::size_t(count);
        }
    });
    return seen;
}

std::vector<ReferenceHit> reference_hits(const ReferenceTerrain& terrain, const Camera& camera) {
    const PixelProjection pixels(camera);
    const int width = camera.viewport.width;
    std::vector<ReferenceHit> hits(std::size_t(width) * std::size_t(camera.viewport.height));
    tbb::parallel_for(0, camera.viewport.height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            hits[std::size_t(y) * std::size_t(width) + std::size_t(x)] =
                terrain.cast(pixels.eye(), pixels.direction(x + 0.5, y + 0.5), camera.near_plane);
        }
    });
    return hits;
}

}  // namespace lodbench::measure
