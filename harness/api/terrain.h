#pragma once
// The terrain as served to methods: float32 heights in metres on a regular grid.

#include <atomic>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>

namespace lodbench {

/// A block of samples of the full-resolution grid: rows [row, row + rows), columns likewise.
struct SampleRect {
    int row = 0;
    int column = 0;
    int rows = 0;
    int columns = 0;
};

/// What is known of a terrain without reading a sample of it.
struct TerrainInfo {
    std::string name;
    int rows = 0;                  ///< >= 2
    int columns = 0;               ///< >= 2
    glm::dvec2 spacing{1.0};       ///< metres between columns (x) and between rows (y), > 0
    glm::dvec2 origin{0.0};        ///< world x, y of sample (rows - 1, 0), the south-west corner
    float min_height = 0;          ///< metres
    float max_height = 0;          ///< metres
    std::uint64_t void_count = 0;  ///< samples that had no data and were filled
    std::string checksum;          ///< of the grid as served: 16 hex digits

    [[nodiscard]] glm::dvec2 extent_min() const { return origin; }
    [[nodiscard]] glm::dvec2 extent_max() const {
        return origin + spacing * glm::dvec2(columns - 1, rows - 1);
    }
    /// World x, y of sample (row, column); row 0 is the north edge.
    [[nodiscard]] glm::dvec2 position(int row, int column) const {
        return origin + spacing * glm::dvec2(column, rows - 1 - row);
    }
};

/// Serves samples by rectangle and counts what was asked for. Every height is finite. `read` may be
/// called from several threads at once.
class Terrain {
public:
    virtual ~Terrain() = default;
    Terrain(const Terrain&) = delete;
    Terrain& operator=(const Terrain&) = delete;

    [[nodiscard]] const TerrainInfo& info() const { return info_; }

    /// Copies the rectangle into `heights`, row by row, rect.rows * rect.columns floats in metres.
    /// Throws ContractError when the rectangle leaves the grid or the span has another size.
    void read(const SampleRect& rect, std::span<float> heights) const;

    /// Samples that `read` has delivered so far.
    [[nodiscard]] std::uint64_t samples_served() const { return samples_served_.load(); }

protected:
    Terrain() = default;
    TerrainInfo info_;

private:
    virtual void copy_samples(const SampleRect& rect, std::span<float> heights) const = 0;
    mutable std::atomic<std::uint64_t> samples_served_{0};
};

}  // namespace lodbench
