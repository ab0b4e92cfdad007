#pragma once
// Samples without data get heights by a rule that depends on nothing but the grid.

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <string>

#include "api/terrain.h"

namespace lodbench::terrain {

/// Fills the voids (NaN) of a grid of rows x columns samples, row by row, and returns how many
/// there were.
///
/// The rule: a void takes the mean of the nearest valid samples to its west, east, north and south,
/// each weighted by one over its distance in metres; directions without one are left out. Voids
/// whose row and column hold no valid sample are filled by the same rule in a second pass, which
/// takes the filled ones as valid; two passes always suffice. A grid without a valid sample is left
/// as it is. `spacing` is metres between columns (x) and rows (y).
std::uint64_t fill_voids(std::span<float> heights, int rows, int columns, glm::dvec2 spacing);

/// Share of a terrain's samples without data from which on it is said.
inline constexpr double kManyVoids = 0.01;

/// What to say of a terrain of which that share or more was filled; "" of any other.
[[nodiscard]] std::string warning_of_voids(const TerrainInfo& info);

}  // namespace lodbench::terrain
