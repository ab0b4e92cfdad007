#include "measure/reference_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>

#include "measure/box_in_view.h"
#include "measure/pixel_projection.h"

namespace lodbench::measure {

namespace {

constexpr std::size_t kWord = 64;
constexpr double kSlack = 1e-9;

/// Sets the bits of `run` from bit `first` on. Neighbours' runs share words.
void set_bits(std::vector<std::uint64_t>& words, std::size_t first, std::uint64_t run) {
    const auto add = [&](std::size_t word, std::uint64_t bits) {
        if (bits == 0) return;
        std::atomic_ref<std::uint64_t>(words[word]).fetch_or(bits, std::memory_order_relaxed);
    };
    const unsigned shift = first % kWord;
    add(first / kWord, run << shift);
    if (shift > 0) add(first / kWord + 1, run >> (kWord - shift));
}

}  // namespace

std::vector<std::uint64_t> seen_samples(const ReferenceTerrain& terrain, const Camera& camera,
                                        const HiddenGround& hidden) {
    constexpr int kSide = HiddenGround::kSquare;
    const TerrainInfo& info = terrain.info();
    const PixelProjection pixels(camera);
    const BoxInView in_view(camera, kSlack);
    const int square_rows = (info.rows + kSide - 1) / kSide;
    const int square_columns = (info.columns + kSide - 1) / kSide;
    std::vector<std::uint64_t> seen((terrain.heights().size() + kWord - 1) / kWord);
    tbb::parallel_for(0, square_rows * square_columns, [&](int index) {
        const int square_row = index / square_columns;
        const int square_column = index % square_columns;
        const SampleRect rect{square_row * kSide, square_column * kSide,
                              std::min(kSide, info.rows - square_row * kSide),
                              std::min(kSide, info.columns - square_column * kSide)};
        const HeightInterval heights = terrain.range(rect);
        const glm::dvec2 south_west = info.position(rect.row + rect.rows - 1, rect.column);
        const glm::dvec2 north_east = info.position(rect.row, rect.column + rect.columns - 1);
        if (!in_view({south_west, heights.low}, {north_east, heights.high})) return;
        const HiddenGround::Square hides = hidden.square(square_row, square_column);
        const std::uint64_t all = ~std::uint64_t{0} >> unsigned(kSide - rect.columns);
        for (int row = rect.row; row < rect.row + rect.rows; ++row) {
            std::uint64_t run = 0;
            for (std::uint64_t left = all & ~hides[std::size_t(row - rect.row)]; left != 0;
                 left &= left - 1) {
                const int column = rect.column + std::countr_zero(left);
                const glm::dvec3 local = pixels.local(terrain.sample(row, column));
                if (!pixels.in_view(local) ||
                    !terrain.sees(camera.position, camera.near_plane / local.z, row, column)) {
                    continue;
                }
                run |= left & -left;
            }
            if (run == 0) continue;
            set_bits(seen, std::size_t(row) * std::size_t(info.columns) + std::size_t(rect.column),
                     run);
        }
        terrain.forget();
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
        terrain.forget();
    });
    return hits;
}

}  // namespace lodbench::measure
