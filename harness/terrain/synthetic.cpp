#include "terrain/synthetic.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "api/error.h"
#include "base/hash.h"

namespace lodbench::terrain {
namespace {

const std::vector<SyntheticForm>& forms() {
    static const std::vector<SyntheticForm> all = {
        {"plane", "one height everywhere", {{"height", "0", "metres"}}},
        {"ramp",
         "a tilted plane; exact in float where the heights are",
         {{"base", "0", "height of the south-west sample, metres"},
          {"slope_x", "0.1", "metres up per metre east"},
          {"slope_y", "0.05", "metres up per metre north"}}},
        {"sphere-cap",
         "the top of a sphere over the centre of the extent",
         {{"radius", "longer side of the extent",
           "of the sphere, metres; at least half the diagonal"},
          {"base", "0", "height of the four corners, metres"}}},
        {"bump",
         "a plane with one raised sample",
         {{"base", "0", "height of the plane, metres"},
          {"height", "100", "of the raised sample above the plane, metres"},
          {"row", "rows / 2, rounded down", "of the raised sample"},
          {"column", "columns / 2, rounded down", "of the raised sample"}}},
        {"step",
         "a cliff: two planes, one cell apart",
         {{"base", "0", "height of the western plane, metres"},
          {"height", "100", "of the eastern plane above the western, metres"},
          {"column", "columns / 2, rounded down", "the first raised column"}}},
        {"checkerboard",
         "every second sample raised, those diagonally beside each other alike",
         {{"base", "0", "height of the lower samples, metres"},
          {"height", "100", "of the raised samples above them, metres"}}},
        {"ridged",
         "ridged multifractal (Musgrave 1994) on gradient noise",
         {{"base", "0", "the least height possible, metres"},
          {"height", "2000", "the greatest height possible above the base, metres"},
          {"wavelength", "a quarter of the longer side", "of the first octave, metres"},
          {"octaves", "10", "1 to 24; each has half the wavelength of the one before"},
          {"persistence", "0.5", "amplitude of an octave over that of the one before, 0 to 1"},
          {"gain", "2", "how much a ridge sharpens the octaves above it, 0 to 10"}}},
        {"terraces",
         "relief as games have it: ridged, cut into level steps with cliffs between them",
         {{"base", "0", "the lowest step, metres"},
          {"height", "2000", "the highest step possible above the base, metres"},
          {"step", "100", "metres from one level to the next, above 0"},
          {"wavelength", "a quarter of the longer side", "as for ridged"},
          {"octaves", "10", "as for ridged"},
          {"persistence", "0.5", "as for ridged"},
          {"gain", "2", "as for ridged"}}},
    };
    return all;
}

const SyntheticForm& find_form(const std::string& name) {
    std::string known;
    for (const SyntheticForm& form : forms()) {
        if (name == form.name) return form;
        known += (known.empty() ? "" : ", ") + std::string(form.name);
    }
    throw InputError(fmt::format("unknown synthetic terrain '{}'; known: {}", name, known));
}

/// The shape parameters as given, checked: known names and finite values.
class Shape {
public:
    Shape(const SyntheticForm& form, const std::map<std::string, double>& given)
        : form_(form), given_(given) {
        for (const auto& [key, value] : given) {
            const bool known = std::ranges::any_of(
                form.params, [&name = key](const ShapeParam& param) { return name == param.name; });
            if (!known) throw InputError(unknown(key));
            if (!std::isfinite(value)) refuse(key, value, "it must be finite");
        }
    }

    [[nodiscard]] double real(const char* name, double fallback) const {
        const auto found = given_.find(name);
        return found == given_.end() ? fallback : found->second;
    }
    [[nodiscard]] double real(const char* name, double fallback, double least, double most) const {
        const double value = real(name, fallback);
        if (!(value >= least && value <= most)) {
            refuse(name, value, fmt::format("it must lie in {} to {}", least, most));
        }
        return value;
    }
    [[nodiscard]] int integer(const char* name, int fallback, int least, int most) const {
        const double value = real(name, fallback, least, most);
        if (value != std::floor(value)) refuse(name, value, "it must be a whole number");
        return int(value);
    }
    [[noreturn]] void refuse(const std::string& name, double value, const std::string& why) const {
        throw InputError(
            fmt::format("synthetic terrain '{}': {} = {}: {}", form_.name, name, value, why));
    }

private:
    [[nodiscard]] std::string unknown(const std::string& key) const {
        std::string known;
        for (const ShapeParam& param : form_.params) {
            known += (known.empty() ? "" : ", ") + std::string(param.name);
        }
        return fmt::format("synthetic terrain '{}': unknown shape parameter '{}'; known: {}",
                           form_.name, key, known);
    }
    const SyntheticForm& form_;
    const std::map<std::string, double>& given_;
};

/// Height as a function of (row, column).
using HeightFunction = std::function<double(int, int)>;

/// Metres east and north of the south-west sample.
glm::dvec2 local_position(const TerrainInfo& info, int row, int column) {
    return info.spacing * glm::dvec2(column, info.rows - 1 - row);
}

HeightFunction plane(const Shape& shape) {
    return [height = shape.real("height", 0)](int, int) { return height; };
}

HeightFunction ramp(const Shape& shape, const TerrainInfo& info) {
    return [base = shape.real("base", 0), slope_x = shape.real("slope_x", 0.1),
            slope_y = shape.real("slope_y", 0.05), info](int row, int column) {
        const glm::dvec2 at = local_position(info, row, column);
        return base + (slope_x * at.x + slope_y * at.y);
    };
}

// z = base + sqrt(R^2 - d^2) - sqrt(R^2 - D^2), with d the distance from the centre, D that of a
// corner.
HeightFunction sphere_cap(const Shape& shape, const TerrainInfo& info) {
    const glm::dvec2 extent = info.extent_max() - info.extent_min();
    const glm::dvec2 centre = extent * 0.5;
    const double corner2 = centre.x * centre.x + centre.y * centre.y;
    const double radius = shape.real("radius", std::max(extent.x, extent.y));
    if (!(radius > 0 && radius * radius >= corner2)) {
        shape.refuse("radius", radius,
                     fmt::format("the sphere must reach the corners, {:.6g} m from the centre",
                                 std::sqrt(corner2)));
    }
    const double rim = std::sqrt(radius * radius - corner2);
    return [base = shape.real("base", 0), radius, rim, centre, info](int row, int column) {
        const glm::dvec2 at = local_position(info, row, column) - centre;
        const double distance2 = at.x * at.x + at.y * at.y;
        return base + (std::sqrt(std::max(0.0, radius * radius - distance2)) - rim);
    };
}

HeightFunction bump(const Shape& shape, const TerrainInfo& info) {
    return [base = shape.real("base", 0), height = shape.real("height", 100),
            peak_row = shape.integer("row", info.rows / 2, 0, info.rows - 1),
            peak_column = shape.integer("column", info.columns / 2, 0, info.columns - 1)](
               int row, int column) {
        return row == peak_row && column == peak_column ? base + height : base;
    };
}

HeightFunction step(const Shape& shape, const TerrainInfo& info) {
    return [base = shape.real("base", 0), height = shape.real("height", 100),
            first = shape.integer("column", info.columns / 2, 0, info.columns - 1)](
               int, int column) { return column >= first ? base + height : base; };
}

HeightFunction checkerboard(const Shape& shape) {
    return [base = shape.real("base", 0), height = shape.real("height", 100)](int row, int column) {
        return (row + column) % 2 == 0 ? base : base + height;
    };
}

/// Unit vectors in uniform directions: hashed points of the square, kept where they fall inside the
/// unit circle, made unit length. No sine is needed.
std::vector<glm::dvec2> make_gradients() {
    constexpr std::size_t kCount = 256;
    std::vector<glm::dvec2> gradients;
    for (std::uint64_t draw = 0; gradients.size() < kCount; ++draw) {
        const std::uint64_t bits = base::mix64(draw);
        const double x = (double(bits >> 32) - 0x1p31) * 0x1p-31;
        const double y = (double(bits & 0xFFFFFFFFU) - 0x1p31) * 0x1p-31;
        const double length2 = x * x + y * y;
        if (length2 > 0.01 && length2 <= 1) {
            const double length = std::sqrt(length2);
            gradients.emplace_back(x / length, y / length);
        }
    }
    return gradients;
}

/// Perlin's gradient noise (1985, with the quintic of 2002) on the integer lattice, moved by a
/// hashed fraction of a cell: it is zero at every node, and octaves that share nodes would all peak
/// there.
class GradientNoise {
public:
    explicit GradientNoise(std::uint64_t seed)
        : seed_(base::mix64(seed)),
          shift_(double(base::mix64(seed_ + 1) >> 32) * 0x1p-32,
                 double(base::mix64(seed_ + 2) >> 32) * 0x1p-32) {}

    /// In [-sqrt(1/2), sqrt(1/2)].
    [[nodiscard]] double at(glm::dvec2 place, const std::vector<glm::dvec2>& gradients) const {
        const glm::dvec2 p = place + shift_;
        const glm::dvec2 cell(std::floor(p.x), std::floor(p.y));
        const glm::dvec2 f = p - cell;
        const auto slope = [&](int east, int north) {
            const glm::dvec2& g =
                gradients[index(std::int64_t(cell.x) + east, std::int64_t(cell.y) + north)];
            return g.x * (f.x - east) + g.y * (f.y - north);
        };
        const double u = fade(f.x);
        return lerp(lerp(slope(0, 0), slope(1, 0), u), lerp(slope(0, 1), slope(1, 1), u),
                    fade(f.y));
    }

private:
    static double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }
    static double lerp(double a, double b, double t) { return a + (b - a) * t; }

    [[nodiscard]] std::size_t index(std::int64_t column, std::int64_t row) const {
        return base::mix64(seed_ ^ (std::uint64_t(column) * base::kGolden +
                                    std::uint64_t(row) * 0xc2b2ae3d27d4eb4fULL)) >>
               56;
    }
    std::uint64_t seed_;
    glm::dvec2 shift_;
};

// F. K. Musgrave, "RidgedMultifractal", in Ebert et al., Texturing and Modeling: octave i adds
// persistence^i * weight * (1 - |noise|)^2, where weight = clamp(gain * the octave before, 0, 1).
// Departs from it in that amplitudes fall by multiplication (H = -log2 persistence) and that the
// sum is scaled to lie in 0..1.
HeightFunction ridged(const Shape& shape, const TerrainInfo& info, std::uint64_t seed) {
    const glm::dvec2 extent = info.extent_max() - info.extent_min();
    const double longer = std::max(extent.x, extent.y);
    const double base = shape.real("base", 0);
    const double height = shape.real("height", 2000);
    // The last octave's lattice coordinates stay far under 2^53, where floor and the differences
    // are exact.
    const double wavelength =
        shape.real("wavelength", longer * 0.25, longer * 0x1p-20, longer * 0x1p20);
    const int octaves = shape.integer("octaves", 10, 1, 24);
    const double persistence = shape.real("persistence", 0.5, 0, 1);
    const double gain = shape.real("gain", 2, 0, 10);

    std::vector<GradientNoise> noises;
    double amplitude_sum = 0;
    double amplitude = 1;
    for (int octave = 0; octave < octaves; ++octave, amplitude *= persistence) {
        noises.emplace_back(seed + std::uint64_t(octave) * 0x632be59bd9b4e019ULL);
        amplitude_sum += amplitude;
    }
    return [=, gradients = make_gradients()](int row, int column) {
        glm::dvec2 at = local_position(info, row, column) / wavelength;
        double sum = 0;
        double weight = 1;
        double octave_amplitude = 1;
        for (const GradientNoise& noise : noises) {
            const double ridge = 1 - std::abs(noise.at(at, gradients)) / 0.70710678118654757;
            const double signal = weight * (ridge * ridge);
            sum += octave_amplitude * signal;
            weight = std::clamp(gain * signal, 0.0, 1.0);
            octave_amplitude *= persistence;
            at *= 2.0;
        }
        return base + height * (sum / amplitude_sum);
    };
}

HeightFunction terraces(const Shape& shape, const TerrainInfo& info, std::uint64_t seed) {
    const double base = shape.real("base", 0);
    const double step = shape.real("step", 100);
    if (!(step > 0)) shape.refuse("step", step, "it must be above 0");
    return [base, step, relief = ridged(shape, info, seed)](int row, int column) {
        return base + step * std::floor((relief(row, column) - base) / step);
    };
}

HeightFunction make_function(const TerrainSource& source, const TerrainInfo& info) {
    const SyntheticForm& form = find_form(source.synthetic);
    const Shape shape(form, source.shape);
    const std::string_view name = form.name;
    if (name == "plane") return plane(shape);
    if (name == "ramp") return ramp(shape, info);
    if (name == "sphere-cap") return sphere_cap(shape, info);
    if (name == "bump") return bump(shape, info);
    if (name == "step") return step(shape, info);
    if (name == "checkerboard") return checkerboard(shape);
    if (name == "terraces") return terraces(shape, info, source.seed);
    return ridged(shape, info, source.seed);
}

}  // namespace

std::span<const SyntheticForm> synthetic_forms() {
    return forms();
}

std::vector<float> make_synthetic(const TerrainSource& source, const TerrainInfo& info) {
    const HeightFunction height = make_function(source, info);
    std::vector<float> heights(std::size_t(info.rows) * std::size_t(info.columns));
    tbb::parallel_for(0, info.rows, [&](int row) {
        float* out = heights.data() + std::size_t(row) * std::size_t(info.columns);
        for (int column = 0; column < info.columns; ++column) {
            out[column] = float(height(row, column));
        }
    });
    return heights;
}

}  // namespace lodbench::terrain
