#include "common/leb_grid.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include "api/error.h"

namespace lodbench::common {
namespace {

constexpr int kLargestSize = 32769;

int padded_size(const TerrainInfo& info) {
    const int longest = std::max(info.rows, info.columns);
    if (longest > kLargestSize) {
        throw InputError("terrain '" + info.name + "' has " + std::to_string(longest) +
                         " samples a side; longest-edge bisection takes at most " +
                         std::to_string(kLargestSize) + ": use a smaller terrain");
    }
    // From 3: the base mesh has a centre.
    int size = 3;
    while (size < longest) size = 2 * (size - 1) + 1;
    return size;
}

}  // namespace

void LebGrid::Free::operator()(LebVertex* vertices) const {
    std::free(vertices);
}

std::unique_ptr<LebVertex[], LebGrid::Free> LebGrid::allocate(std::size_t count) {
    // Neighbours in a column lie a row apart, on another page each: with pages of 4 KiB the
    // refinement of a large terrain waits for address translation. The advice may be refused; it is
    // only speed.
    constexpr std::size_t kHugePage = std::size_t(2) << 20;
    const std::size_t used = count * sizeof(LebVertex);
    const bool large = used >= kHugePage;
    const std::size_t alignment = large ? kHugePage : alignof(std::max_align_t);
    const std::size_t bytes = (used + alignment - 1) / alignment * alignment;
    void* memory = std::aligned_alloc(alignment, bytes);
    if (memory == nullptr) throw std::bad_alloc();
    if (large) madvise(memory, bytes, MADV_HUGEPAGE);
    return std::unique_ptr<LebVertex[], Free>(static_cast<LebVertex*>(memory));
}

LebGrid::LebGrid(const Terrain& terrain)
    : size_(padded_size(terrain.info())),
      spacing_(terrain.info().spacing),
      north_west_(terrain.info().position(0, 0)),
      vertices_(allocate(vertex_count())) {
    constexpr int kBand = 64;
    const TerrainInfo& info = terrain.info();
    std::vector<float> band(std::size_t(kBand) * std::size_t(info.columns));
    for (int first = 0; first < info.rows; first += kBand) {
        const int rows = std::min(kBand, info.rows - first);
        const auto columns = std::size_t(info.columns);
        terrain.read({first, 0, rows, info.columns},
                     std::span(band).first(std::size_t(rows) * columns));
        for (int row = 0; row < rows; ++row) {
            const float* heights = band.data() + std::size_t(row) * columns;
            LebVertex* vertices = &at({first + row, 0});
            for (std::size_t c = 0; c < columns; ++c) vertices[c] = {heights[c], 0, 0};
            std::fill(vertices + columns, vertices + size_, LebVertex{heights[columns - 1], 0, 0});
        }
    }
    const LebVertex* last = &at({info.rows - 1, 0});
    for (int row = info.rows; row < size_; ++row) std::copy_n(last, size_, &at({row, 0}));
}

}  // namespace lodbench::common
