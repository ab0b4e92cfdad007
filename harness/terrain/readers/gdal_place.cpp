#include "terrain/readers/gdal_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "api/error.h"
#include "terrain/world_file.h"

#include <cpl_error.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

namespace lodbench::terrain {

struct GdalWords::Handler {
    static void CPL_STDCALL keep(CPLErr level, CPLErrorNum /*number*/, const char* message) {
        auto& self = *static_cast<GdalWords*>(CPLGetErrorHandlerUserData());
        (level >= CE_Failure ? self.failure_ : self.warning_) = message;
        if (self.proj_.empty() && STARTS_WITH(message, "PROJ:")) self.proj_ = message;
    }
};

GdalWords::GdalWords() {
    CPLPushErrorHandlerEx(&Handler::keep, this);
}

GdalWords::~GdalWords() {
    CPLPopErrorHandler();
}

std::string GdalWords::last() const {
    std::string line = !failure_.empty() ? failure_ : warning_;
    std::ranges::replace_if(
        line, [](char c) { return c == '\n' || c == '\r'; }, ' ');
    return line;
}

namespace {

/// How far a metre of the map may be off from the ground's at the raster's centre. Maps made for
/// surveys (UTM: 0.04 %, state planes: 0.01 %) are faithful; what is off by more is told, and by
/// much more, as Web Mercator is, taken to the ground.
constexpr double kFaithful = 0.01;
constexpr double kTolerable = 0.05;

double off_by(glm::dvec2 ratio) {
    return std::max(std::abs(ratio.x - 1), std::abs(ratio.y - 1));
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

/// "WGS 84 / UTM zone 10N (EPSG:32610)".
std::string name_of(const OGRSpatialReference& reference) {
    const char* name = reference.GetName();
    std::string text = name == nullptr || *name == '\0' ? "without a name" : name;
    std::ranges::replace_if(
        text, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    const char* authority = reference.GetAuthorityName(nullptr);
    const char* code = reference.GetAuthorityCode(nullptr);
    if (authority == nullptr || code == nullptr) return text;
    return fmt::format("{} ({}:{})", text, authority, code);
}

class Place {
public:
    Place(const std::filesystem::path& file, RasterDescription& description)
        : file_(file), description_(description) {}

    bool read(GDALDataset& dataset, const GdalWords& words);

private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(fmt::format("{}: {}", file_.string(), what));
    }
    void in_degrees(const OGRSpatialReference& reference);
    void in_map_units(const OGRSpatialReference& reference);
    void read_vertical(const OGRSpatialReference& reference);
    [[nodiscard]] glm::dvec2 ground_per_unit(const OGRSpatialReference& reference) const;
    void set(glm::dvec2 metres) {
        description_.spacing = pixel_ * metres;
        description_.origin = corner_ * metres;
    }

    const std::filesystem::path& file_;
    RasterDescription& description_;
    glm::dvec2 pixel_{};
    glm::dvec2 corner_{};  ///< the south-west sample
    glm::dvec2 centre_{};
};

// A geotransform maps (column, row) of pixel corners to (x, y):
// x = t0 + column t1 + row t2, y = t3 + column t4 + row t5.
bool Place::read(GDALDataset& dataset, const GdalWords& words) {
    std::array<double, 6> t{};
    if (dataset.GetGeoTransform(t.data()) != CE_None) {
        if (dataset.GetGCPCount() > 0) {
            description_.spacing_hint =
                "placed by ground control points alone, which gdalwarp makes a grid of";
        }
        return false;
    }
    if (t[2] != 0 || t[4] != 0) {
        refuse(fmt::format(
            "a rotated geotransform (terms {} and {}); warp it upright with gdalwarp", t[2], t[4]));
    }
    if (!(t[1] > 0) || t[5] == 0 || !std::isfinite(t[1]) || !std::isfinite(t[5])) {
        refuse(fmt::format("pixels of {} by {}; the width must be positive, the height not zero",
                           t[1], t[5]));
    }
    const bool south_up = t[5] > 0;
    pixel_ = {t[1], std::abs(t[5])};
    const double south_row = south_up ? 0.5 : description_.rows - 0.5;
    corner_ = {t[0] + 0.5 * t[1], t[3] + south_row * t[5]};
    centre_ = corner_ + 0.5 * pixel_ * glm::dvec2(description_.columns - 1, description_.rows - 1);

    const OGRSpatialReference* named = dataset.GetSpatialRef();
    OGRSpatialReference beside;
    if (const auto prj = named == nullptr ? find_beside(file_, ".prj") : std::nullopt) {
        char** lines = CSLLoad(prj->c_str());
        if (beside.importFromESRI(lines) == OGRERR_NONE) named = &beside;
        CSLDestroy(lines);
        if (named == nullptr) {
            description_.spacing_hint =
                fmt::format("the reference system in {} cannot be read", prj->filename().string());
            return south_up;
        }
    }
    if (named != nullptr && !words.proj().empty()) {
        description_.spacing_hint = fmt::format(
            "the units of its reference system are not known, for PROJ fails ({}; do PROJ_LIB or "
            "PROJ_DATA name another installation's folder?)",
            words.proj());
    } else if (named == nullptr) {
        if (looks_like_degrees(corner_, pixel_, description_.rows, description_.columns)) {
            description_.spacing_hint =
                fmt::format("no coordinate system, and pixels of {} x {} look like degrees",
                            pixel_.x, pixel_.y);
            return south_up;
        }
        description_.reference = "none named; coordinates taken for metres";
        set(glm::dvec2(1));
    } else {
        OGRSpatialReference reference(*named);
        reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        reference.IsGeographic() != 0 ? in_degrees(reference) : in_map_units(reference);
        read_vertical(reference);
    }
    return south_up;
}

void Place::in_degrees(const OGRSpatialReference& reference) {
    if (reference.IsDerivedGeographic() != 0) {
        refuse("longitudes and latitudes of a turned pole; warp it with gdalwarp");
    }
    const double radians = reference.GetAngularUnits(nullptr);
    const double latitude = centre_.y * radians;
    constexpr double kDegrees = 180 / std::numbers::pi;
    if (!(std::abs(latitude) < 0.5 * std::numbers::pi)) {
        refuse(fmt::format("centre latitude of {} degrees; it must lie between the poles",
                           latitude * kDegrees));
    }
    set(radians * metres_per_radian(latitude, reference));
    description_.reference = fmt::format("{}; degrees turned into metres at latitude {:.4f}",
                                         name_of(reference), latitude * kDegrees);
    const double half = 0.5 * pixel_.y * (description_.rows - 1) * radians;
    const double widest = std::cos(std::max(0.0, std::abs(latitude) - half));
    const double narrowest = std::cos(std::min(0.5 * std::numbers::pi, std::abs(latitude) + half));
    const double here = std::cos(latitude);
    description_.warnings.push_back(
        fmt::format("geographic ({}): degrees became metres at the centre latitude {:.4f}, so a "
                    "cell is {:.4g} % "
                    "wider on the ground at one edge and {:.4g} % narrower at the other; gdalwarp "
                    "to a projected "
                    "system for more",
                    name_of(reference), latitude * kDegrees, 100 * (widest / here - 1),
                    100 * (1 - narrowest / here)));
}

void Place::in_map_units(const OGRSpatialReference& reference) {
    const char* unit = nullptr;
    const double metres = reference.GetLinearUnits(&unit);
    if (!(metres > 0) || !std::isfinite(metres)) refuse(fmt::format("map units of {} m", metres));
    const std::string units =
        metres == 1 ? "metres"
                    : fmt::format("{} ({:.10g} m)", unit == nullptr ? "units" : unit, metres);
    description_.reference = fmt::format("{}; {}", name_of(reference), units);
    const glm::dvec2 ground = ground_per_unit(reference);
    const glm::dvec2 ratio = ground / metres;
    const bool scaled = off_by(ratio) > kTolerable;
    set(scaled ? ground : glm::dvec2(metres));
    if (off_by(ratio) <= kFaithful) return;
    if (scaled) {
        description_.reference +=
            fmt::format(", taken to the ground's by {:.6g} east, {:.6g} north", ratio.x, ratio.y);
    }
    description_.warnings.push_back(fmt::format(
        "{}: a metre of the map is {:.4g} m on the ground east and {:.4g} m north at the centre{}; "
        "gdalwarp to a projection that keeps true lengths there (UTM) for more",
        name_of(reference), ratio.x, ratio.y,
        scaled ? ", so spacing and origin were scaled by that" : ", and spacing is the map's"));
}

/// Metres on the ground for a unit of the map, east and north at the raster's centre; those of the
/// unit where PROJ cannot say (a local system, a place outside of the projection).
glm::dvec2 Place::ground_per_unit(const OGRSpatialReference& reference) const {
    const glm::dvec2 unit(reference.GetLinearUnits(nullptr));
    if (reference.IsProjected() == 0) return unit;
    const std::unique_ptr<OGRSpatialReference> degrees(reference.CloneGeogCS());
    if (!degrees) return unit;
    degrees->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> transform(
        OGRCreateCoordinateTransformation(&reference, degrees.get()));
    if (!transform) return unit;
    const glm::dvec2 step = 0.5 * pixel_;
    std::array<double, 4> x = {centre_.x - step.x, centre_.x + step.x, centre_.x, centre_.x};
    std::array<double, 4> y = {centre_.y, centre_.y, centre_.y - step.y, centre_.y + step.y};
    std::array<int, 4> done{};
    if (transform->Transform(4, x.data(), y.data(), nullptr, done.data()) == 0) return unit;
    const double radians = degrees->GetAngularUnits(nullptr);
    const glm::dvec2 metres = radians * metres_per_radian(0.5 * (y[0] + y[1]) * radians, *degrees);
    const double full_turn = 2 * std::numbers::pi / radians;
    const auto length = [&](std::size_t from, std::size_t to) {
        return std::hypot(metres.x * std::remainder(x[to] - x[from], full_turn),
                          metres.y * (y[to] - y[from]));
    };
    const glm::dvec2 ground = glm::dvec2(length(0, 1), length(2, 3)) / pixel_;
    const bool sound =
        std::isfinite(ground.x) && std::isfinite(ground.y) && ground.x > 0 && ground.y > 0;
    return sound ? ground : unit;
}

/// A compound system says what its heights are; a horizontal one in feet leaves it open.
void Place::read_vertical(const OGRSpatialReference& reference) {
    const double metres = reference.IsGeographic() != 0 ? 1 : reference.GetLinearUnits(nullptr);
    if (reference.IsCompound() == 0) {
        if (!description_.vertical_unit_named && metres < 1) {
            description_.warnings.push_back(
                fmt::format("its map units are {:.10g} m long and the unit of its heights is not "
                            "named: taken for "
                            "metres; where they are the same, give the vertical scale {:.10g}",
                            metres, metres));
        }
        return;
    }
    OGRAxisOrientation orientation = OAO_Up;
    reference.GetAxis("COMPD_CS|VERT_CS", 0, &orientation);
    if (orientation == OAO_Down) {
        description_.unit_hint =
            "its heights count downwards, as depths, which a negative scale turns";
        return;
    }
    const double unit = reference.GetTargetLinearUnits("VERT_CS", nullptr);
    if (description_.vertical_unit_named || !(unit > 0) || !std::isfinite(unit)) return;
    description_.vertical_scale *= unit;
    description_.vertical_offset *= unit;
}

}  // namespace

bool read_place(GDALDataset& dataset, const std::filesystem::path& file, const GdalWords& words,
                RasterDescription& description) {
    return Place(file, description).read(dataset, words);
}

}  // namespace lodbench::terrain
