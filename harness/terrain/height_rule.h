#pragma once
// From the numbers of a raster to heights in metres, and what these numbers make one suspect.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "terrain/height_field.h"
#include "terrain/raster_reader.h"
#include "terrain/sidecar.h"

namespace lodbench::terrain {

/// Metres. A number so far from 0 is no height on any body that has a terrain (the Earth's radius
/// is 6.4e6): it marks a sample without data, as -3.4028235e38 does.
inline constexpr double kMostHeight = 1e7;

/// What the samples that are not void look like, in units of the file.
class SampleCensus {
public:
    /// `zero_is_a_mark`: 0 is suspected too where every other sample is far above it.
    explicit SampleCensus(bool zero_is_a_mark) : zero_is_a_mark_(zero_is_a_mark) {}

    void add(double sample, int row, int column) {
        if (sample >= lowest_.sample && sample <= highest_.sample) return;
        extend(sample, row, column);
    }

    struct Place {
        double sample = 0;
        int row = -1;  ///< -1: there is none
        int column = -1;
    };
    /// A number that is known to mark samples without data, so far outside the range of all others
    /// that it is no height among them.
    struct Mark {
        Place first;
        std::uint64_t count = 0;
    };
    [[nodiscard]] std::vector<Mark> marks() const;
    /// Of what is no such number; row -1 where there is none.
    [[nodiscard]] const Place& lowest() const { return lowest_; }
    [[nodiscard]] const Place& highest() const { return highest_; }

private:
    void extend(double sample, int row, int column);

    bool zero_is_a_mark_;
    Place lowest_{std::numeric_limits<double>::infinity()};
    Place highest_{-std::numeric_limits<double>::infinity()};
    std::vector<Mark> marks_;
};

/// Whether samples of 16 bits were written with their bytes the other way round: terrain is smooth,
/// and with its bytes swapped it is not.
class ByteOrderCensus {
public:
    /// The bits of a sample; `first` where the one before it is not its neighbour.
    void add(std::uint16_t sample, bool first);
    [[nodiscard]] bool look_swapped() const;

private:
    /// As signed and as unsigned numbers, whichever is less: a step across sea level is small.
    static double step(std::uint16_t one, std::uint16_t other) {
        const int difference = std::abs(int(one) - int(other));
        return std::min(difference, 65536 - difference);
    }
    std::uint16_t before_ = 0;
    unsigned low_bytes_ = 0;  ///< every bit that one of them has
    double as_read_ = 0;      ///< sum of the differences of neighbours
    double as_swapped_ = 0;
};

/// height = sample * scale + offset; voids become NaN.
class HeightRule {
public:
    /// What the source says goes before the sidecar, the sidecar before the file. Throws
    /// InputError.
    HeightRule(const TerrainSource& source, const Sidecar& sidecar,
               const RasterDescription& description);

    /// Heights of one row; returns how many are void. Throws InputError for one that is not finite
    /// or beyond kMostHeight, with its place.
    int apply(int row, std::span<const double> samples, std::span<float> heights);

    /// What to say of a raster without a valid sample.
    [[nodiscard]] std::string all_void() const;
    /// Of the rows so far.
    [[nodiscard]] std::vector<std::string> warnings() const;

private:
    [[nodiscard]] bool is_void(double sample) const;
    [[noreturn]] void refuse(int row, int column, double sample) const;

    std::string file_;
    double scale_;
    double offset_;
    std::optional<double> no_data_;
    double tolerance_ = 0;
    bool masked_;
    std::string unheld_;  ///< why no sample can be the no-data value; empty where one can
    double wrapped_ = 0;  ///< what the no-data value becomes in the file's bits, where unheld_
    std::uint64_t wrapped_count_ = 0;
    SampleCensus census_;
    bool two_bytes_ = false;
    ByteOrderCensus bytes_;
};

}  // namespace lodbench::terrain
