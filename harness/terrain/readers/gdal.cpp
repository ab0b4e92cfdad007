// The only file that knows GDAL. Its drivers are registered one by one: those of the network, of
// databases and of virtual files (VRT, WMS, /vsi...) are never there to be asked.

#include "terrain/readers/module.h"

#include <fmt/format.h>

#include "api/error.h"
#include "terrain/ascii_grid_check.h"
#include "terrain/colour_heights.h"
#include "terrain/readers/gdal_place.h"
#include "terrain/world_file.h"

#include <gdal_frmts.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

namespace lodbench::terrain {
namespace {

std::string said(const GdalWords& words) {
    const std::string last = words.last();
    return last.empty() ? "GDAL says nothing more" : "GDAL: " + last;
}

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
    // Of GeoTIFF 1.0 too, what the heights are: by default only 1.1 tells.
    CPLSetConfigOption("GTIFF_REPORT_COMPD_CS", "YES");
    // GDAL hears what libtiff says, also to another library (OpenImageIO) while no GdalWords
    // listens, and would print it. Who asked libtiff is told by its result.
    CPLSetErrorHandler(CPLQuietErrorHandler);
}

constexpr std::array<const char*, 8> kDrivers = {"GTiff", "AAIGrid", "SRTMHGT", "USGSDEM",
                                                 "DTED",  "EHdr",    "HFA",     nullptr};

/// Metres in one vertical unit; nothing where the unit is unknown.
std::optional<double> metres_per_unit(const std::string& unit) {
    struct Unit {
        double metres;
        std::vector<const char*> names;
    };
    static const std::array<Unit, 7> kUnits = {{
        {1, {"", "m", "metre", "metres", "meter", "meters"}},
        {0.3048,
         {"ft", "foot", "feet", "international foot", "international feet", "international_feet",
          "foot (international)"}},
        {1200.0 / 3937.0,
         {"us survey foot", "us survey feet", "u.s. survey foot", "us_survey_foot", "survey foot",
          "survey feet", "survey_foot", "survey_feet", "foot_us", "ft_us", "ftus", "us-ft"}},
        {0.1, {"dm", "decimetre", "decimetres", "decimeter", "decimeters"}},
        {0.01, {"cm", "centimetre", "centimetres", "centimeter", "centimeters"}},
        {0.001, {"mm", "millimetre", "millimetres", "millimeter", "millimeters"}},
        {1000, {"km", "kilometre", "kilometres", "kilometer", "kilometers"}},
    }};
    for (const auto& [metres, names] : kUnits) {
        for (const char* name : names) {
            if (EQUAL(unit.c_str(), name)) return metres;
        }
    }
    return std::nullopt;
}

class GdalReader final : public RasterReader {
public:
    explicit GdalReader(const std::filesystem::path& file)
        : file_(std::filesystem::absolute(file)) {
        const GdalWords words;
        if (file_.string().starts_with("/vsi")) {
            refuse("a virtual path of GDAL; give a file on disk");
        }
        register_drivers();
        open(words);
        choose_band();
        description_.rows = dataset_->GetRasterYSize();
        description_.columns = dataset_->GetRasterXSize();
        check_raster_size(file_, description_.rows, description_.columns);
        read_type();
        read_mask();
        read_units();
        south_up_ = read_place(*dataset_, file_, words, description_);
    }

    void read_row(int row, std::span<double> values) override {
        const GdalWords words;
        const int file_row = south_up_ ? description_.rows - 1 - row : row;
        const auto read = [&](GDALRasterBand* band, void* to, GDALDataType type) {
            if (band->RasterIO(GF_Read, 0, file_row, description_.columns, 1, to,
                               description_.columns, 1, type, 0, 0, nullptr) != CE_None) {
                refuse(fmt::format("row {} cannot be read, the file may be truncated; {}", row,
                                   said(words)));
            }
        };
        read(band_, values.data(), GDT_Float64);
        if (signed_bytes_) {
            for (double& value : values) value -= value > 127 ? 256 : 0;
        }
        if (!description_.masked) return;
        valid_.resize(values.size());
        read(band_->GetMaskBand(), valid_.data(), GDT_Byte);
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (valid_[i] == 0) values[i] = std::numeric_limits<double>::quiet_NaN();
        }
    }

private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(fmt::format("{}: {}", file_.string(), what));
    }

    [[nodiscard]] bool named(const char* extension) const {
        return EQUAL(file_.extension().c_str(), extension);
    }

    void open(const GdalWords& words) {
        AsciiGrid grid;
        if (named(".asc")) grid = check_ascii_grid(file_);
        // Left to itself the driver reads integers where no cell has a decimal point, and fails at
        // a nan among them; else it reads float32.
        const std::array<const char*, 2> as_doubles = {"DATATYPE=Float64", nullptr};
        dataset_.reset(GDALDataset::Open(file_.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY,
                                         kDrivers.data(),
                                         grid.fractional ? as_doubles.data() : nullptr));
        if (!dataset_) {
            refuse(fmt::format("is no elevation model that can be read; {}", why_not(words)));
        }
        if (grid.recognised && (dataset_->GetRasterYSize() != grid.rows ||
                                dataset_->GetRasterXSize() != grid.columns)) {
            refuse(fmt::format("{} rows x {} columns in its header, {} x {} to GDAL; write it anew",
                               grid.rows, grid.columns, dataset_->GetRasterYSize(),
                               dataset_->GetRasterXSize()));
        }
    }

    [[nodiscard]] std::string why_not(const GdalWords& words) const {
        if (named(".hgt")) return why_no_tile();
        if ((named(".bil") || named(".flt")) && !find_beside(file_, ".hdr")) {
            return fmt::format("its header {} does not lie beside it",
                               file_.filename().replace_extension(".hdr").string());
        }
        if (named(".asc") && words.last().empty()) {
            return "an Arc ASCII grid begins with ncols and nrows, and this file does not";
        }
        return said(words);
    }

    /// SRTM tiles have no header: GDAL knows them by their sizes and their names.
    [[nodiscard]] std::string why_no_tile() const {
        static constexpr std::array<std::uintmax_t, 4> kSides = {1201, 3601, 7201, 6001};
        const std::uintmax_t bytes = std::filesystem::file_size(file_);
        const bool sized = std::ranges::any_of(kSides, [bytes](std::uintmax_t side) {
            return bytes == 2 * side * side || bytes == side * (side + 1);
        });
        if (sized) {
            return "its name must say where it lies: N46W122.hgt is the tile from 46 to 47 degrees "
                   "north and 122 to 121 west";
        }
        return fmt::format(
            "it has {} bytes, and SRTM tiles have 2884802 (1201 x 1201 samples, 3 seconds apart) "
            "or "
            "25934402 (3601 x 3601, 1 second): it is truncated or no such tile, fetch it anew",
            bytes);
    }

    void choose_band() {
        const int count = dataset_->GetRasterCount();
        if (count < 1) refuse("no bands; an elevation model has one");
        band_ = dataset_->GetRasterBand(1);
        const bool alpha =
            count == 2 && dataset_->GetRasterBand(2)->GetColorInterpretation() == GCI_AlphaBand;
        if (count != 1 && !alpha) {
            const bool colours = band_->GetColorInterpretation() == GCI_RedBand;
            refuse(fmt::format("{} bands; an elevation model has one ({})", count,
                               colours ? kColourHeights : "gdal_translate -b 1 takes one out"));
        }
        if (band_->GetColorInterpretation() == GCI_PaletteIndex) {
            description_.warnings.push_back(
                "its samples are indices into a table of colours, as in a picture: taken for "
                "heights");
        }
        char** parts = dataset_->GetMetadata("SUBDATASETS");
        if (const int count_of_parts = CSLCount(parts) / 2; count_of_parts > 1) {
            description_.warnings.push_back(
                fmt::format("holds {} rasters; the first is read", count_of_parts));
        }
    }

    void read_type() {
        const GDALDataType type = band_->GetRasterDataType();
        const bool exact_in_double = GDALDataTypeIsComplex(type) == 0 && type != GDT_Unknown &&
                                     type != GDT_Int64 && type != GDT_UInt64;
        if (!exact_in_double) {
            refuse(fmt::format("samples of type {}; integers of up to 32 bits and floats are read",
                               GDALGetDataTypeName(type)));
        }
        const char* pixels = band_->GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
        signed_bytes_ = type == GDT_Byte && pixels != nullptr && EQUAL(pixels, "SIGNEDBYTE");
        if (GDALDataTypeIsInteger(type) != 0) {
            const bool is_signed = signed_bytes_ || GDALDataTypeIsSigned(type) != 0;
            const double values = std::exp2(GDALGetDataTypeSizeBits(type));
            description_.integers =
                std::pair{is_signed ? -values / 2 : 0.0, (is_signed ? values / 2 : values) - 1};
        }
        description_.kind = fmt::format("{}, {}, through GDAL", dataset_->GetDriverName(),
                                        signed_bytes_ ? "Int8" : GDALGetDataTypeName(type));
        int has_no_data = 0;
        const double no_data = band_->GetNoDataValue(&has_no_data);
        if (has_no_data != 0) description_.no_data = no_data;
    }

    void read_mask() {
        description_.masked = (band_->GetMaskFlags() & (GMF_ALL_VALID | GMF_NODATA)) == 0;
        double percent = 100;
        const int coverage = band_->GetDataCoverageStatus(0, 0, description_.columns,
                                                          description_.rows, 0, &percent);
        const bool known = (coverage & GDAL_DATA_COVERAGE_STATUS_UNIMPLEMENTED) == 0;
        if (known && (coverage & GDAL_DATA_COVERAGE_STATUS_EMPTY) != 0 && !description_.no_data &&
            !description_.masked) {
            description_.warnings.push_back(
                fmt::format("{:.3g} % of its blocks are not in the file, and it names no no-data "
                            "value: they are "
                            "read as 0, taken for heights; fetch it anew, or give 0 as no-data",
                            100 - percent));
        }
    }

    void read_units() {
        const std::string unit = band_->GetUnitType();
        description_.vertical_unit_named = !unit.empty();
        const std::optional<double> metres = metres_per_unit(unit);
        if (!metres) {
            description_.unit_hint =
                fmt::format("heights in '{}', which is no unit known here", unit);
        }
        description_.vertical_scale = band_->GetScale() * metres.value_or(1);
        description_.vertical_offset = band_->GetOffset() * metres.value_or(1);
    }

    std::filesystem::path file_;
    GDALDatasetUniquePtr dataset_;
    GDALRasterBand* band_ = nullptr;
    bool south_up_ = false;
    bool signed_bytes_ = false;        ///< GDAL has no type for them before 3.7
    std::vector<std::uint8_t> valid_;  ///< of the row: 0 where the mask rules out
};

}  // namespace

}  // namespace lodbench::terrain

lodbench::terrain::RasterReader* lodbench_open_raster(const std::filesystem::path& file) {
    return new lodbench::terrain::GdalReader(file);
}
