#include "report/html/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "picture/truth_picture.h"

namespace lodbench::report::html {

Axis::Axis(std::span<const double> values, Scale scale, double begin, double end)
    : scale_(scale), begin_(begin), end_(end) {
    const bool logarithmic = scale == Scale::logarithmic;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const double value : values) {
        if (!std::isfinite(value) || (logarithmic && value <= 0)) continue;
        const double scaled = logarithmic ? std::log10(value) : value;
        low = std::min(low, scaled);
        high = std::max(high, scaled);
    }
    if (low > high) return;  // nothing: 0 .. 1
    if (scale == Scale::from_zero) low = std::min(low, 0.0);
    const double size = high - low;
    const double margin = size > 0      ? 0.05 * size
                          : logarithmic ? 0.3
                                        : std::max(0.1 * std::abs(high), 1e-9);
    low_ = low == 0 && !logarithmic ? 0 : low - margin;
    high_ = high + margin;
}

double Axis::place(double value) const {
    double scaled = value;
    if (scale_ == Scale::logarithmic) scaled = value > 0 ? std::log10(value) : low_;
    const double fraction = std::clamp((scaled - low_) / (high_ - low_), 0.0, 1.0);
    return begin_ + fraction * (end_ - begin_);
}

double Axis::step() const {
    const double nice = picture::nice_scale((high_ - low_) / 6);
    return scale_ == Scale::counting ? std::max(1.0, nice) : nice;
}

std::string Axis::tick_label(double tick) const {
    constexpr std::size_t kRoom = 8;  // characters beside the picture
    const double digits = -std::floor(std::log10(step()));
    if (scale_ != Scale::spanning || !(digits < double(kRoom))) return tick_text(tick);
    std::string label = fmt::format("{:.{}f}", tick, int(std::max(0.0, digits)));
    return label.size() <= kRoom ? label : tick_text(tick);
}

std::vector<double> Axis::ticks() const {
    std::vector<double> ticks;
    if (scale_ != Scale::logarithmic) {
        for (double k = std::ceil(low_ / step()); k * step() <= high_ && ticks.size() < 20; ++k) {
            ticks.push_back(k * step());
        }
        return ticks;
    }
    // 1, 2 and 5 of each decade where there are few decades; else of each n-th the 1.
    const double decades = high_ - low_;
    const double every = std::max(1.0, std::ceil(decades / 8));
    for (double decade = std::floor(low_); decade <= high_; decade += every) {
        for (const double digit : {1.0, 2.0, 5.0}) {
            const double place = decade + std::log10(digit);
            if ((digit == 1 || decades < 3) && place >= low_ && place <= high_) {
                ticks.push_back(digit * std::pow(10, decade));
            }
        }
    }
    return ticks;
}

std::string Axis::numbers() const {
    return fmt::format("{} {} {} {} {}", low_, high_, begin_, end_,
                       int(scale_ == Scale::logarithmic));
}

std::string tick_text(double value) {
    const double size = std::abs(value);
    if (size >= 1e9) return fmt::format("{:.3g}G", value / 1e9);
    if (size >= 1e6) return fmt::format("{:.3g}M", value / 1e6);
    if (size >= 1e4) return fmt::format("{:.3g}k", value / 1e3);
    if (size < 1e-9) return "0";
    return fmt::format("{:.4g}", value);
}

}  // namespace lodbench::report::html
