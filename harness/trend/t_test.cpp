#include "trend/t_test.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodbench::trend {

Spread spread_of(std::span<const double> values) {
    Spread spread;
    spread.count = values.size();
    if (values.empty()) return spread;
    for (const double value : values) spread.mean += value;
    spread.mean /= double(values.size());
    for (const double value : values) {
        spread.variance += (value - spread.mean) * (value - spread.mean);
    }
    spread.variance /= double(std::max<std::size_t>(1, values.size() - 1));
    return spread;
}

double student_p(double t, int degrees) {
    const double theta = std::atan(std::abs(t) / std::sqrt(double(degrees)));
    const double cosine = std::cos(theta);
    const double square = cosine * cosine;
    const bool odd = degrees % 2 != 0;
    // The series in powers of the cosine, its factors (k - 1) / k.
    double term = odd ? cosine : 1;
    double sum = 0;
    for (int k = odd ? 3 : 2; k <= degrees; k += 2) {
        sum += term;
        term *= square * double(k - 1) / double(k);
    }
    const double inside =
        odd ? 2 / std::numbers::pi * (theta + std::sin(theta) * sum) : std::sin(theta) * sum;
    return std::clamp(1 - inside, 0.0, 1.0);
}

double welch_p(const Spread& a, const Spread& b) {
    const double of_a = a.variance / double(a.count);
    const double of_b = b.variance / double(b.count);
    const double variance = of_a + of_b;
    if (!(variance > 0)) return a.mean == b.mean ? 1 : 0;
    const double degrees = variance * variance /
                           (of_a * of_a / double(a.count - 1) + of_b * of_b / double(b.count - 1));
    return student_p((a.mean - b.mean) / std::sqrt(variance), std::max(1, int(degrees)));
}

}  // namespace lodbench::trend
