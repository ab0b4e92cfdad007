// The only file that knows GDAL. Its drivers are registered one by one: those of the network, of
// databases and of virtual files (VRT, WMS, /vsi...) are never there to be asked.

#include "terrain/readers/module.h"

#include <fmt/format.h>

#include "api/error.h"

#include <cpl_error.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace lodbench::terrain {
namespace {

/// While it lives, GDAL's words on this thread come here instead of stderr.
class ErrorText {
public:
    ErrorText() { CPLPushErrorHandlerEx(&ErrorText::keep, this); }
    ~ErrorText() { CPLPopErrorHandler(); }
    ErrorText(const ErrorText&) = delete;
    ErrorText& operator=(const ErrorText&) = delete;

    /// The last failure, else the last warning, on one line.
    [[nodiscard]] std::string text() const {
        std::string line = !failure_.empty() ? failure_ : warning_;
        for (char& c : line) {
            if (c == '\n' || c == '\r') c = ' ';
        }
        return line.empty() ? "GDAL says nothing more" : "GDAL: " + line;
    }

private:
    static void CPL_STDCALL keep(CPLErr level, CPLErrorNum /*number*/, const char* message) {
        auto& self = *static_cast<ErrorText*>(CPLGetErrorHandlerUserData());
        (level >= CE_Failure ? self.failure_ : self.warning_) = message;
    }
    std::string failure_, warning_;
};

void register_drivers() {
    GDALRegister_GTiff();
    GDALRegister_AAIGrid();
    GDALRegister_SRTMHGT();
    GDALRegister_USGSDEM();
    GDALRegister_DTED();
    GDALRegister_EHdr();
    GDALRegister_HFA();
    // Of the blocks that it keeps: rows are asked for in order, and a terrain larger than memory is
    // passed over in little of it. By default it takes a twentieth of all there is.
    GDALSetCacheMax64(GIntBig(256) << 20);
}

constexpr std::array<const char*, 8> kDrivers = {"GTiff", "AAIGrid", "SRTMHGT", "USGSDEM",
                                                 "DTED",  "EHdr",    "HFA",     nullptr};

/// Metres in one vertical unit; nothing where the unit is unknown.
std::optional<double> metres_per_unit(const std::string& unit) {
    static constexpr std::array<std::pair<const char*, double>, 15> kUnits = {{
        {"", 1},
        {"m", 1},
        {"metre", 1},
        {"metres", 1},
        {"meter", 1},
        {"meters", 1},
        {"ft", 0.3048},
        {"foot", 0.3048},
        {"feet", 0.3048},
        {"us survey foot", 1200.0 / 3937.0},
        {"us survey feet", 1200.0 / 3937.0},
        {"ftus", 1200.0 / 3937.0},
        {"us-ft", 1200.0 / 3937.0},
        {"cm", 0.01},
        {"dm", 0.1},
    }};
    for (const auto& [name, metres] : kUnits) {
        if (EQUAL(unit.c_str(), name)) return metres;
    }
    return std::nullopt;
}

/// Metres per radian of longitude (x) and latitude (y) at a latitude; see open_with_gdal.
glm::dvec2 metres_per_radian(double latitude, const OGRSpatialReference& reference) {
    const double axis = reference.GetSemiMajor();
    const double inverse_flattening = reference.GetInvFlattening();
    const double flattening = inverse_flattening > 0 ? 1 / inverse_flattening : 0;  // 0: a sphere
    const double e2 = flattening * (2 - flattening);
    const double sine = std::sin(latitude);
    const double w2 = 1 - e2 * sine * sine;
    return {axis * std::cos(latitude) / std::sqrt(w2), axis * (1 - e2) / (w2 * std::sqrt(w2))};
}

class GdalReader final : public RasterReader {
public:
    explicit GdalReader(const std::filesystem::path& file)
        : file_(std::filesystem::absolute(file)) {
        const ErrorText errors;
        const std::string path = file_.string();
        if (path.starts_with("/vsi")) refuse("a virtual path of GDAL; give a file on disk");
        register_drivers();
        dataset_.reset(
            GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, kDrivers.data()));
        if (!dataset_)
            refuse(fmt::format("is no elevation model that can be read; {}", errors.text()));
        if (dataset_->GetRasterCount() != 1) {
            refuse(
                fmt::format("{} bands; an elevation model has one (gdal_translate -b 1 takes one "
                            "out)",
                            dataset_->GetRasterCount()));
        }
        band_ = dataset_->GetRasterBand(1);
        description_.rows = dataset_->GetRasterYSize();
        description_.columns = dataset_->GetRasterXSize();
        check_raster_size(file_, description_.rows, description_.columns);
        read_type();
        read_units();
        read_georeference();
    }

    void read_row(int row, std::span<double> values) override {
        const ErrorText errors;
        const int file_row = south_up_ ? description_.rows - 1 - row : row;
        if (band_->RasterIO(GF_Read, 0, file_row, description_.columns, 1, values.data(),
                            description_.columns, 1, GDT_Float64, 0, 0, nullptr) != CE_None) {
            refuse(fmt::format("row {} cannot be read, the file may be truncated; {}", row,
                               errors.text()));
        }
    }

private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(fmt::format("{}: {}", file_.string(), what));
    }

    void read_type() {
        const GDALDataType type = band_->GetRasterDataType();
        const bool exact_in_double = GDALDataTypeIsComplex(type) == 0 && type != GDT_Unknown &&
                                     type != GDT_Int64 && type != GDT_UInt64;
        if (!exact_in_double) {
            refuse(fmt::format("samples of type {}; integers of up to 32 bits and floats are read",
                               GDALGetDataTypeName(type)));
        }
        description_.float32 = type == GDT_Float32;
        description_.kind = fmt::format("{}, {}, through GDAL", dataset_->GetDriverName(),
                                        GDALGetDataTypeName(type));
        int has_no_data = 0;
        const double no_data = band_->GetNoDataValue(&has_no_data);
        if (has_no_data != 0) description_.no_data = no_data;
    }

    void read_units() {
        const std::string unit = band_->GetUnitType();
        const std::optional<double> metres = metres_per_unit(unit);
        if (!metres) {
            description_.unit_hint =
                fmt::format("heights in '{}', which is no unit known here", unit);
        }
        description_.vertical_scale = band_->GetScale() * metres.value_or(1);
        description_.vertical_offset = band_->GetOffset() * metres.value_or(1);
    }

    // A geotransform maps (column, row) of pixel corners to (x, y):
    // x = t0 + column t1 + row t2, y = t3 + column t4 + row t5.
    void read_georeference() {
        std::array<double, 6> t{};
        if (dataset_->GetGeoTransform(t.data()) != CE_None) return;
        if (t[2] != 0 || t[4] != 0) {
            refuse(fmt::format(
                "a rotated geotransform (terms {} and {}); warp it upright with gdalwarp", t[2],
                t[4]));
        }
        if (!(t[1] > 0) || t[5] == 0 || !std::isfinite(t[1]) || !std::isfinite(t[5])) {
            refuse(fmt::format(
                "pixels of {} by {}; the width must be positive, the height not zero", t[1], t[5]));
        }
        south_up_ = t[5] > 0;
        const glm::dvec2 pixel(t[1], std::abs(t[5]));
        const double south_row = south_up_ ? 0.5 : description_.rows - 0.5;
        const glm::dvec2 corner(t[0] + 0.5 * t[1], t[3] + south_row * t[5]);
        const double centre_y = corner.y + 0.5 * (description_.rows - 1) * pixel.y;

        const OGRSpatialReference* reference = dataset_->GetSpatialRef();
        if (reference == nullptr && looks_like_degrees(corner, pixel)) {
            description_.spacing_hint = fmt::format(
                "no coordinate system, and pixels of {} x {} look like degrees", pixel.x, pixel.y);
            return;
        }
        glm::dvec2 metres(1);
        if (reference != nullptr && reference->IsGeographic() != 0) {
            const double radians = reference->GetAngularUnits(nullptr);
            const double latitude = centre_y * radians;
            if (!(std::abs(latitude) < 0.5 * std::numbers::pi)) {
                refuse(fmt::format("centre latitude of {} degrees; it must lie between the poles",
                                   latitude * 180 / std::numbers::pi));
            }
            metres = radians * metres_per_radian(latitude, *reference);
        } else if (reference != nullptr) {
            metres = glm::dvec2(reference->GetLinearUnits(nullptr));
        }
        description_.spacing = pixel * metres;
        description_.origin = corner * metres;
    }

    /// An .asc without .prj does not say what its numbers are: a thousandth of something, within
    /// the range of longitudes and latitudes, is taken for neither.
    [[nodiscard]] bool looks_like_degrees(glm::dvec2 corner, glm::dvec2 pixel) const {
        const glm::dvec2 far = corner + pixel * glm::dvec2(description_.columns, description_.rows);
        return pixel.x < 0.02 && pixel.y < 0.02 && std::abs(corner.x) <= 360 &&
               std::abs(far.x) <= 360 && std::abs(corner.y) <= 90 && std::abs(far.y) <= 90.5;
    }

    std::filesystem::path file_;
    GDALDatasetUniquePtr dataset_;
    GDALRasterBand* band_ = nullptr;
    bool south_up_ = false;
};

}  // namespace

}  // namespace lodbench::terrain

lodbench::terrain::RasterReader* lodbench_open_raster(const std::filesystem::path& file) {
    return new lodbench::terrain::GdalReader(file);
}
