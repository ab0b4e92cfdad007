#pragma once
// A raster's heights, row by row: what the file holds, by what source and sidecar say of it.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "terrain/height_field.h"
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
    /// "png, uint16, through OpenImageIO".
    [[nodiscard]] const std::string& kind() const { return reader_->description().kind; }
    /// Neither source, sidecar nor file says it: 1 m was taken.
    [[nodiscard]] bool spacing_assumed() const { return spacing_assumed_; }

    /// The next row, `columns` heights in metres; NaN where there is no data. Returns how many of
    /// them have none. Throws InputError where the file cannot be read or a height is not finite.
    int next(std::span<float> heights);

    /// What to say of a raster without a valid sample.
    [[nodiscard]] std::string all_void() const;

private:
    std::unique_ptr<RasterReader> reader_;
    std::unique_ptr<HeightRule> rule_;
    TerrainInfo info_;
    bool spacing_assumed_ = false;
    std::vector<double> samples_;
    int row_ = 0;
};

}  // namespace lodbench::terrain
