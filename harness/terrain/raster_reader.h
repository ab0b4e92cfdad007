#pragma once
// What every importer of rasters gives: a description, then rows of the file's own numbers.

#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "terrain/sidecar.h"

namespace lodbench::terrain {

/// What the file itself says; what it does not say is empty.
struct RasterDescription {
    std::string kind;  ///< "GeoTIFF, int16, through GDAL"
    int rows = 0;
    int columns = 0;
    std::optional<glm::dvec2> spacing;  ///< metres
    std::optional<glm::dvec2> origin;   ///< metres, of the south-west sample
    double vertical_scale = 1;          ///< metres per unit of the file
    double vertical_offset = 0;         ///< metres, added after scaling
    std::optional<double> no_data;      ///< in units of the file; may be NaN
    /// Least and greatest that a sample can be; empty: samples are floats.
    std::optional<std::pair<double, double>> integers;
    bool masked = false;       ///< a mask or alpha rules samples out: these come as NaN
    std::string spacing_hint;  ///< why the spacing is empty though the file has one; may be empty
    std::string
        unit_hint;  ///< why the vertical scale must be given; empty where the file's is known
    bool vertical_unit_named = false;   ///< the file names the unit of its heights
    std::string reference;              ///< as Provenance has it
    std::vector<std::string> warnings;  ///< without the file's name
};

/// An open raster. Rows come in the order north to south; each is asked for once, in order.
class RasterReader {
public:
    RasterReader() = default;
    virtual ~RasterReader() = default;
    RasterReader(const RasterReader&) = delete;
    RasterReader& operator=(const RasterReader&) = delete;

    [[nodiscard]] const RasterDescription& description() const { return description_; }

    /// The numbers of one row as the file holds them, never normalised; double holds every type up
    /// to 32 bits exactly. NaN for those that a mask or alpha of 0 rules out. `values` has
    /// `columns` elements. Throws InputError where the file cannot be read.
    virtual void read_row(int row, std::span<double> values) = 0;

protected:
    RasterDescription description_;
};

/// Elevation models. Degrees become metres at the centre latitude phi, on the file's ellipsoid (WGS
/// 84 where it names none: a = 6378137 m, f = 1 / 298.257223563), with e^2 = f (2 - f), per radian:
///     east   a cos(phi) / (1 - e^2 sin^2 phi)^(1/2)
///     north  a (1 - e^2) / (1 - e^2 sin^2 phi)^(3/2)
/// and the origin is longitude and latitude of the south-west sample times these. Projected
/// coordinates are multiplied by the length of their unit. A sample stands at the centre of its
/// pixel. Where a map's metre at the raster's centre is off from the ground's by more than a
/// twentieth, as in Web Mercator, spacing and origin are those of the ground, with a warning; by
/// more than a hundredth, there is the warning alone. Rotated geotransforms are refused, south-up
/// rasters flipped. GDAL is loaded at the first call. Throws InputError.
[[nodiscard]] std::unique_ptr<RasterReader> open_with_gdal(const std::filesystem::path& file);

/// Images of one channel, or of one and alpha. OpenImageIO is loaded at the first call. Throws
/// InputError.
[[nodiscard]] std::unique_ptr<RasterReader> open_with_oiio(const std::filesystem::path& file);

/// Raw samples, row by row from the north, as the sidecar says. Throws InputError.
[[nodiscard]] std::unique_ptr<RasterReader> open_raw(const std::filesystem::path& file,
                                                     const Sidecar& sidecar);

/// PGM, binary (P5), any maximal value: OpenImageIO stretches a maximum that is not 255 or 65535,
/// so this one is read here. Throws InputError.
[[nodiscard]] std::unique_ptr<RasterReader> open_pgm(const std::filesystem::path& file);

/// Whether numbers that no reference system explains are degrees rather than metres: `corner` is
/// the south-west sample, `pixel` the spacing, both in the file's units. All must lie in the range
/// of longitudes and latitudes, and be so fine that no survey in metres is, or go around the world.
[[nodiscard]] bool looks_like_degrees(glm::dvec2 corner, glm::dvec2 pixel, int rows, int columns);

/// Chooses the reader by the rule that `raster_route` states.
[[nodiscard]] std::unique_ptr<RasterReader> open_raster(const std::filesystem::path& file,
                                                        const Sidecar& sidecar);

/// Throws InputError for a grid that is too small (under 2 x 2) or larger than 2^36 samples. Called
/// before anything of that size is allocated; whether the memory holds it is asked where it must.
void check_raster_size(const std::filesystem::path& file, std::int64_t rows, std::int64_t columns);

}  // namespace lodbench::terrain
