#pragma once
// Terrains by formula: the known answers of the tests, and relief of any size without a file.

#include <span>
#include <string>
#include <vector>

#include "terrain/height_field.h"

namespace lodbench::terrain {

/// One parameter of a form. Where the default depends on the grid, `default_text` says how.
struct ShapeParam {
    const char* name;
    const char* default_text;
    const char* help;
};

struct SyntheticForm {
    const char* name;
    const char* help;
    std::vector<ShapeParam> params;
};

/// All forms: plane, ramp, sphere-cap, bump, step, checkerboard, ridged, terraces.
[[nodiscard]] std::span<const SyntheticForm> synthetic_forms();

/// Metres between samples where the source gives none.
inline constexpr double kSyntheticSpacing = 10;

/// Heights of `source.synthetic` over the grid of `info` (rows, columns, spacing), row by row, row
/// 0 north. The same bits on every machine: integer hashing and the operations that IEEE 754 rounds
/// exactly
/// (+ - * / sqrt floor) only, no contraction, no sum whose order depends on threads.
/// Throws InputError for an unknown form or shape parameter (listing the known ones) or a bad
/// value.
[[nodiscard]] std::vector<float> make_synthetic(const TerrainSource& source,
                                                const TerrainInfo& info);

}  // namespace lodbench::terrain
