#pragma once
// A raster's heights, row by row: what the file holds, by what source and sidecar say of it.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "terrain/height_field.h"
#include "terrain/provenance.h"
#include "terrain/raster_reader.h"

namespace lodbench::terrain {

class HeightRule;

/// Rows of `source.file`, which is no store, from the north. Height range and checksum of `info`
/// are not known, and of its voids only those that were filled before the file was written.
class RasterRows {
public:
    /// Throws InputError.
    explicit RasterRows(const TerrainSource& source);
    ~RasterRows();

    [[nodiscard]] const TerrainInfo& info() const { return info_; }
    /// With what the rows so far make one suspect.
    [[nodiscard]] Provenance provenance() const;

    /// The next row, `columns` heights in metres; NaN where there is no data. Returns how many of
    /// them have none. Throws InputError where the file cannot be read or a height is not finite.
    int next(std::span<float> heights);

    /// What to say of a raster without a valid sample.
    [[nodiscard]] std::string all_void() const;

private:
    std::unique_ptr<RasterReader> reader_;
    std::unique_ptr<HeightRule> rule_;
    TerrainInfo info_;
    Provenance provenance_;
    std::vector<double> samples_;
    int row_ = 0;
};

}  // namespace lodbench::terrain
