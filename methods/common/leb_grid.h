#pragma once
// A terrain of any size as the (2^n + 1)^2 vertices of longest-edge bisection, with the a-priori
// refinement criteria of each.

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>

#include "api/terrain.h"
#include "common/leb.h"

namespace lodbench::common {

/// One vertex. The three are read together, once per test, so they lie together.
struct LebVertex {
    float height;  ///< metres
    float error;   ///< metres, saturated: never below a child's
    float radius;  ///< metres: the sphere around the vertex holds the spheres of its children
};

/// The padded grid: the terrain's samples in the north-west corner, its last column and last row
/// repeated to the east and to the south.
class LebGrid {
public:
    /// Reads the terrain in bands of rows through `Terrain::read`; errors and radii are zero.
    /// Throws InputError for a terrain of more than 32769 samples a side, whose vertices 32-bit
    /// indices could not name.
    explicit LebGrid(const Terrain& terrain);

    [[nodiscard]] int size() const { return size_; }  ///< vertices a side, 2^n + 1
    [[nodiscard]] glm::dvec2 spacing() const { return spacing_; }
    /// World x, y of vertex (0, 0), the north-west corner.
    [[nodiscard]] glm::dvec2 north_west() const { return north_west_; }

    [[nodiscard]] std::size_t index(Sample vertex) const {
        return std::size_t(vertex.row) * std::size_t(size_) + std::size_t(vertex.column);
    }
    [[nodiscard]] bool contains(Sample vertex) const {
        return vertex.row >= 0 && vertex.column >= 0 && vertex.row < size_ && vertex.column < size_;
    }
    [[nodiscard]] const LebVertex& at(Sample vertex) const { return vertices_[index(vertex)]; }
    [[nodiscard]] LebVertex& at(Sample vertex) { return vertices_[index(vertex)]; }
    [[nodiscard]] const LebVertex* vertices() const { return vertices_.get(); }
    [[nodiscard]] LebVertex* vertices() { return vertices_.get(); }
    [[nodiscard]] std::size_t vertex_count() const {
        return std::size_t(size_) * std::size_t(size_);
    }

private:
    int size_ = 0;
    glm::dvec2 spacing_{1.0};
    glm::dvec2 north_west_{0.0};
    struct Free {
        void operator()(LebVertex* vertices) const;
    };
    static std::unique_ptr<LebVertex[], Free> allocate(std::size_t count);
    std::unique_ptr<LebVertex[], Free> vertices_;
};

}  // namespace lodbench::common
