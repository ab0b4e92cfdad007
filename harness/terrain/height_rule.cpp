#include "terrain/height_rule.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "api/error.h"

namespace lodbench::terrain {
namespace {

template <typename T>
std::optional<T> first_of(const std::optional<T>& one, const std::optional<T>& other) {
    return one ? one : other;
}

/// Numbers that programs write where they have no height; those beyond kMostHeight are refused
/// anyway.
constexpr std::array kMarks = {-9999.0,    -99999.0, -999999.0, -32768.0, -32767.0, -999.0,
                               -9999999.0, 9999.0,   32767.0,   65535.0,  0.0};

/// From here on a number is a mark, never a height, and programs write it with as few as six
/// digits: -3.40282e38 for -3.4028234663852886e38.
constexpr double kHugeNumber = 1e15;
constexpr double kSixDigits = 1e-5;

constexpr double kFloatMax = std::numeric_limits<float>::max();

/// How far a sample of floats may be from the no-data value and still be it: files keep the value
/// as a double or as text, samples as float32 (or as doubles that were floats once), rounded once
/// each.
double tolerance_of(double no_data) {
    if (!std::isfinite(no_data)) return 0;
    if (std::abs(no_data) >= kHugeNumber) return kSixDigits * std::abs(no_data);
    return 2 * double(std::numeric_limits<float>::epsilon()) * std::abs(no_data);
}

/// Metres: no place on the Earth is higher or deeper (8849, -10935), with room for raised datums.
constexpr double kHighestOnEarth = 9000;
constexpr double kLowestOnEarth = -11500;

}  // namespace

void SampleCensus::extend(double sample, int row, int column) {
    if (std::ranges::find(kMarks, sample) != kMarks.end() && (sample != 0 || zero_is_a_mark_)) {
        const auto known =
            std::ranges::find(marks_, sample, [](const Mark& mark) { return mark.first.sample; });
        if (known == marks_.end()) {
            marks_.push_back({{sample, row, column}, 1});
        } else {
            ++known->count;
        }
        return;
    }
    if (sample < lowest_.sample) lowest_ = {sample, row, column};
    if (sample > highest_.sample) highest_ = {sample, row, column};
}

void ByteOrderCensus::add(std::uint16_t sample, bool first) {
    const auto swapped = std::uint16_t(sample >> 8U | sample << 8U);
    low_bytes_ |= sample & 0xFFU;
    if (!first) {
        as_read_ += step(before_, sample);
        as_swapped_ += step(std::uint16_t(before_ >> 8U | before_ << 8U), swapped);
    }
    before_ = sample;
}

bool ByteOrderCensus::look_swapped() const {
    // Of a smooth surface the ratio is tens or hundreds; of noise, 1. Samples of 8 bits moved up by
    // 8 would be smoother swapped too, and are right.
    constexpr double kFar = 8;
    return low_bytes_ != 0 && as_read_ > kFar * as_swapped_;
}

std::vector<SampleCensus::Mark> SampleCensus::marks() const {
    std::vector<Mark> found;
    const double range = std::max(highest_.sample - lowest_.sample, 0.0);
    for (const Mark& mark : marks_) {
        const double gap =
            std::max(lowest_.sample - mark.first.sample, mark.first.sample - highest_.sample);
        // Land does meet the sea at 0, so that needs more.
        const double least = std::max(mark.first.sample == 0 ? range : 0.1 * range, 100.0);
        const bool alone = lowest_.row < 0;
        if (alone ? mark.first.sample != 0 : gap > least) found.push_back(mark);
    }
    return found;
}

HeightRule::HeightRule(const TerrainSource& source, const Sidecar& sidecar,
                       const RasterDescription& description)
    : file_(source.file.string()),
      scale_(first_of(source.vertical_scale, sidecar.vertical_scale)
                 .value_or(description.vertical_scale)),
      offset_(first_of(source.vertical_offset, sidecar.vertical_offset)
                  .value_or(description.vertical_offset)),
      no_data_(first_of(first_of(source.no_data, sidecar.no_data), description.no_data)),
      masked_(description.masked),
      census_(description.spacing.has_value()) {
    if (!description.unit_hint.empty() && !source.vertical_scale && !sidecar.vertical_scale) {
        throw InputError(fmt::format("{}: {}; give the vertical scale (metres per unit)", file_,
                                     description.unit_hint));
    }
    if (!std::isfinite(scale_) || !std::isfinite(offset_) || scale_ == 0) {
        throw InputError(
            fmt::format("{}: vertical scale {}, offset {}; both must be finite, the scale not 0",
                        file_, scale_, offset_));
    }
    two_bytes_ =
        description.integers && description.integers->second - description.integers->first == 65535;
    if (!no_data_) return;
    if (!description.integers) {
        tolerance_ = tolerance_of(*no_data_);
        return;
    }
    const auto [least, most] = *description.integers;
    if (*no_data_ >= least && *no_data_ <= most) return;
    unheld_ =
        fmt::format("no-data is {}, which no integer from {} to {} can be", *no_data_, least, most);
    wrapped_ = *no_data_ + (*no_data_ < least ? 1 : -1) * (most - least + 1);
}

bool HeightRule::is_void(double sample) const {
    if (!std::isfinite(sample)) return masked_ || no_data_.has_value();
    if (!no_data_) return false;
    if (sample == *no_data_ || std::abs(sample - *no_data_) <= tolerance_) return true;
    // -1.7976931348623157e308 in a file of float32: the samples are as far as these go.
    const bool beyond_float = tolerance_ > kFloatMax || std::isinf(*no_data_);
    return beyond_float && std::abs(sample) >= (1 - kSixDigits) * kFloatMax &&
           std::signbit(sample) == std::signbit(*no_data_);
}

void HeightRule::refuse(int row, int column, double sample) const {
    const double height = sample * scale_ + offset_;
    if (!std::isfinite(sample)) {
        throw InputError(fmt::format(
            "{}: the height at row {}, column {} is {}; every height must be finite, or "
            "its value given as no-data",
            file_, row, column, height));
    }
    throw InputError(fmt::format(
        "{}: the height at row {}, column {} is {}, implausible on any body: it marks a sample "
        "without data; give it as no-data ({}), or correct the vertical scale",
        file_, row, column, height, sample));
}

int HeightRule::apply(int row, std::span<const double> samples, std::span<float> heights) {
    int voids = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double sample = samples[i];
        if (is_void(sample)) {
            heights[i] = std::numeric_limits<float>::quiet_NaN();
            ++voids;
            continue;
        }
        const double height = sample * scale_ + offset_;
        if (!(std::abs(height) < kMostHeight)) refuse(row, int(i), sample);
        heights[i] = float(height);
        if (!unheld_.empty() && sample == wrapped_) ++wrapped_count_;
        census_.add(sample, row, int(i));
        if (two_bytes_)
            bytes_.add(std::uint16_t(std::int32_t(sample)), i == 0 || std::isnan(heights[i - 1]));
    }
    return voids;
}

std::string HeightRule::all_void() const {
    if (!no_data_) return fmt::format("{}: its mask rules out every sample; check the mask", file_);
    return fmt::format("{}: every sample is no-data ({}); check the no-data value", file_,
                       *no_data_);
}

std::vector<std::string> HeightRule::warnings() const {
    std::vector<std::string> texts;
    if (wrapped_count_ > 0) {
        texts.push_back(fmt::format(
            "{}: {}, but {} samples are {}, which has the same bits: taken for heights; give it as "
            "no-data, or say in the file that its samples are signed",
            file_, unheld_, wrapped_count_, wrapped_));
    }
    if (bytes_.look_swapped()) {
        texts.push_back(
            fmt::format("{}: neighbouring samples differ far less with the two bytes of each the "
                        "other way round: "
                        "check the order of bytes",
                        file_));
    }
    for (const SampleCensus::Mark& mark : census_.marks()) {
        texts.push_back(fmt::format(
            "{}: {} samples are {}, the first at row {}, column {}, far from all others: taken for "
            "heights, though it often marks samples without data; if it does, give it as no-data",
            file_, mark.count, mark.first.sample, mark.first.row, mark.first.column));
    }
    const SampleCensus::Place& lowest = scale_ > 0 ? census_.lowest() : census_.highest();
    const SampleCensus::Place& highest = scale_ > 0 ? census_.highest() : census_.lowest();
    for (const auto& [place, what] : {std::pair{&lowest, "deeper"}, {&highest, "higher"}}) {
        const double height = place->sample * scale_ + offset_;
        const bool beyond = place == &lowest ? height < kLowestOnEarth : height > kHighestOnEarth;
        if (place->row < 0 || !beyond) continue;
        texts.push_back(fmt::format(
            "{}: the height at row {}, column {} is {} m, {} than any on the Earth; check unit, "
            "vertical scale, no-data and order of bytes",
            file_, place->row, place->column, float(height), what));
        break;
    }
    return texts;
}

}  // namespace lodbench::terrain
