#pragma once
// Where a raster that GDAL opened lies, in metres on the ground.

#include <string>

#include "terrain/raster_reader.h"

class GDALDataset;

namespace lodbench::terrain {

/// While it lives, GDAL's words on this thread come here instead of stderr.
class GdalWords {
public:
    GdalWords();
    ~GdalWords();
    GdalWords(const GdalWords&) = delete;
    GdalWords& operator=(const GdalWords&) = delete;

    /// The last failure, else the last warning, on one line; empty where there is none.
    [[nodiscard]] std::string last() const;
    /// What PROJ said first: that it does not find its database, mostly. Empty where it said
    /// nothing.
    [[nodiscard]] const std::string& proj() const { return proj_; }

private:
    struct Handler;
    std::string failure_, warning_, proj_;
};

/// Sets spacing, origin, reference, hints and warnings of `description`, which has rows and
/// columns; `words` have heard the dataset being opened. Returns whether the raster's first row is
/// the southern one. Throws InputError, "FILE: ...".
bool read_place(GDALDataset& dataset, const std::filesystem::path& file, const GdalWords& words,
                RasterDescription& description);

}  // namespace lodbench::terrain
