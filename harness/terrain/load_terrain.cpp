#include "terrain/load_terrain.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "api/error.h"
#include "terrain/raster_reader.h"
#include "terrain/synthetic.h"
#include "terrain/void_fill.h"

namespace lodbench::terrain {
namespace {

constexpr std::int64_t kMaxSamples = std::int64_t(1) << 31;

/// The kernel's estimate of what can be allocated; nothing where it does not say.
std::optional<std::int64_t> available_memory() {
    std::ifstream stream("/proc/meminfo");
    std::string key;
    std::int64_t kibibytes = 0;
    std::string unit;
    while (stream >> key >> kibibytes) {
        std::getline(stream, unit);
        if (key == "MemAvailable:") return kibibytes * 1024;
    }
    return std::nullopt;
}

void check_size(const std::string& what, std::int64_t rows, std::int64_t columns) {
    if (rows < 2 || columns < 2) {
        throw InputError(fmt::format(
            "{}: {} rows x {} columns make no surface; at least 2 x 2 samples are needed", what,
            rows, columns));
    }
    // Divided, not multiplied: both may be anything.
    if (rows > kMaxSamples / columns || rows > std::numeric_limits<int>::max() ||
        columns > std::numeric_limits<int>::max()) {
        throw InputError(fmt::format(
            "{}: {} rows x {} columns are more than the {} samples that are read; crop or "
            "thin it",
            what, rows, columns, kMaxSamples));
    }
    const std::int64_t bytes = rows * columns * std::int64_t(sizeof(float));
    if (const auto free = available_memory(); free && bytes > *free) {
        throw InputError(fmt::format(
            "{}: {} rows x {} columns need {} MiB, {} MiB of memory are free; crop or thin it",
            what, rows, columns, bytes >> 20, *free >> 20));
    }
}

template <typename T>
std::optional<T> first_of(const std::optional<T>& one, const std::optional<T>& other) {
    return one ? one : other;
}

void check_overrides(const TerrainSource& source) {
    const auto check = [](const char* name, const std::optional<double>& value, bool positive) {
        if (value && (!std::isfinite(*value) || (positive && !(*value > 0)))) {
            throw InputError(fmt::format("terrain: {} = {}; it must be {}", name, *value,
                                         positive ? "positive and finite" : "finite"));
        }
    };
    check("spacing (x)", source.spacing_x, true);
    check("spacing (y)", source.spacing_y, true);
    check("vertical scale", source.vertical_scale, false);
    check("vertical offset", source.vertical_offset, false);
    check("origin (x)", source.origin_x, false);
    check("origin (y)", source.origin_y, false);
    if (source.no_data && std::isinf(*source.no_data)) {
        throw InputError("terrain: no-data is infinite; it must be a number or nan");
    }
}

/// From the file's numbers to heights; voids become NaN.
class HeightRule {
public:
    HeightRule(const TerrainSource& source, const Sidecar& sidecar,
               const RasterDescription& description)
        : file_(source.file.string()),
          scale_(first_of(source.vertical_scale, sidecar.vertical_scale)
                     .value_or(description.vertical_scale)),
          offset_(first_of(source.vertical_offset, sidecar.vertical_offset)
                      .value_or(description.vertical_offset)),
          no_data_(first_of(first_of(source.no_data, sidecar.no_data), description.no_data)) {
        if (!description.unit_hint.empty() && !source.vertical_scale && !sidecar.vertical_scale) {
            throw InputError(fmt::format("{}: {}; give the vertical scale (metres per unit)", file_,
                                         description.unit_hint));
        }
        if (!std::isfinite(scale_) || !std::isfinite(offset_)) {
            throw InputError(fmt::format("{}: vertical scale {}, offset {}; both must be finite",
                                         file_, scale_, offset_));
        }
        if (no_data_ && description.float32) no_data_ = double(float(*no_data_));
    }

    void apply(int row, std::span<const double> samples, std::span<float> heights) const {
        for (std::size_t column = 0; column < samples.size(); ++column) {
            const double sample = samples[column];
            if (is_void(sample)) {
                heights[column] = std::numeric_limits<float>::quiet_NaN();
                continue;
            }
            heights[column] = float(sample * scale_ + offset_);
            if (!std::isfinite(heights[column])) {
                throw InputError(
                    fmt::format("{}: the height at row {}, column {} is {}; every height must be "
                                "finite, or its "
                                "value given as no-data",
                                file_, row, column, sample * scale_ + offset_));
            }
        }
    }

    /// What to say of a raster without a valid sample.
    [[nodiscard]] std::string all_void() const {
        return fmt::format("{}: every sample is no-data ({}); check the no-data value", file_,
                           no_data_.value_or(0));
    }

private:
    [[nodiscard]] bool is_void(double sample) const {
        return no_data_ && (sample == *no_data_ || (std::isnan(sample) && std::isnan(*no_data_)));
    }
    std::string file_;
    double scale_;
    double offset_;
    std::optional<double> no_data_;
};

LoadedTerrain load_raster(const TerrainSource& source) {
    const Sidecar sidecar = read_sidecar(source.file);
    const auto reader = open_raster(source.file, sidecar);
    const RasterDescription& description = reader->description();
    LoadedTerrain loaded;
    loaded.kind = description.kind;

    TerrainInfo info;
    info.name = sidecar.name.value_or(source.file.stem().string());
    info.rows = description.rows;
    info.columns = description.columns;
    const auto spacing_x = first_of(source.spacing_x, sidecar.spacing_x);
    const auto spacing_y = first_of(source.spacing_y, sidecar.spacing_y);
    if (!description.spacing && !(spacing_x && spacing_y)) {
        if (!description.spacing_hint.empty()) {
            throw InputError(fmt::format("{}: {}; give the spacing in metres", source.file.string(),
                                         description.spacing_hint));
        }
        loaded.spacing_assumed = true;
    }
    const glm::dvec2 file_spacing = description.spacing.value_or(glm::dvec2(1));
    info.spacing = {spacing_x.value_or(file_spacing.x), spacing_y.value_or(file_spacing.y)};
    const glm::dvec2 file_origin = description.origin.value_or(glm::dvec2(0));
    info.origin = {first_of(source.origin_x, sidecar.origin_x).value_or(file_origin.x),
                   first_of(source.origin_y, sidecar.origin_y).value_or(file_origin.y)};

    const HeightRule rule(source, sidecar, description);
    const auto columns = std::size_t(info.columns);
    std::vector<double> samples(columns);
    // Memory is touched as rows come: a small file that claims to be huge ends before it costs any.
    std::vector<float> heights;
    heights.reserve(std::size_t(info.rows) * columns);
    for (int row = 0; row < info.rows; ++row) {
        reader->read_row(row, samples);
        heights.resize(heights.size() + columns);
        rule.apply(row, samples, std::span(heights).last(columns));
    }
    const std::uint64_t voids = fill_voids(heights, info.rows, info.columns, info.spacing);
    if (voids == heights.size()) throw InputError(rule.all_void());
    info.void_count = voids + sidecar.voids_filled.value_or(0);
    loaded.field = std::make_unique<HeightField>(info, std::move(heights));
    return loaded;
}

LoadedTerrain load_synthetic(const TerrainSource& source) {
    if (source.vertical_scale || source.vertical_offset || source.no_data) {
        throw InputError(
            fmt::format("synthetic terrain '{}': vertical scale, vertical offset and "
                        "no-data belong to files; use the form's own parameters",
                        source.synthetic));
    }
    check_size(fmt::format("synthetic terrain '{}'", source.synthetic), source.rows,
               source.columns);
    TerrainInfo info;
    info.name = source.synthetic;
    info.rows = source.rows;
    info.columns = source.columns;
    info.spacing = {source.spacing_x.value_or(kSyntheticSpacing),
                    source.spacing_y.value_or(kSyntheticSpacing)};
    info.origin = {source.origin_x.value_or(0), source.origin_y.value_or(0)};
    std::vector<float> heights = make_synthetic(source, info);
    return {std::make_unique<HeightField>(info, std::move(heights)), "synthetic", false};
}

}  // namespace

void check_raster_size(const std::filesystem::path& file, std::int64_t rows, std::int64_t columns) {
    check_size(file.string(), rows, columns);
}

LoadedTerrain load_terrain_with_provenance(const TerrainSource& source) {
    try {
        if (source.file.empty() == source.synthetic.empty()) {
            throw InputError(source.file.empty()
                                 ? "terrain: neither a file nor a synthetic form is named"
                                 : "terrain: both a file and a synthetic form are named; name one");
        }
        check_overrides(source);
        return source.file.empty() ? load_synthetic(source) : load_raster(source);
    } catch (const InputError& error) {
        if (source.where.empty()) throw;
        throw InputError(fmt::format("{}: {}", source.where, error.what()));
    } catch (const std::bad_alloc&) {
        const std::string name = source.file.empty() ? source.synthetic : source.file.string();
        throw EnvironmentError(fmt::format("{}: not enough memory to hold it", name));
    }
}

std::unique_ptr<HeightField> load_terrain(const TerrainSource& source) {
    return load_terrain_with_provenance(source).field;
}

}  // namespace lodbench::terrain
