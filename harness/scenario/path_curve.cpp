#include "scenario/path_curve.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "api/error.h"

namespace lodbench::scenario {
namespace {

/// Arc lengths are tabulated for this many pieces of each segment; within a piece the length is a
/// five-point Gauss-Legendre integral, exact for polynomials of degree 9.
constexpr std::size_t kPieces = 16;
constexpr double kNodes[5] = {0.0, -0.5384693101056831, 0.5384693101056831, -0.9061798459386640,
                              0.9061798459386640};
constexpr double kWeights[5] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                0.2369268850561891, 0.2369268850561891};

glm::dvec3 hermite(const glm::dvec3 (&h)[4], double u) {
    const double u2 = u * u;
    const double u3 = u2 * u;
    return (2 * u3 - 3 * u2 + 1) * h[0] + (3 * u2 - 2 * u3) * h[1] + (u3 - 2 * u2 + u) * h[2] +
           (u3 - u2) * h[3];
}

glm::dvec3 hermite_derivative(const glm::dvec3 (&h)[4], double u) {
    const double u2 = u * u;
    return (6 * u2 - 6 * u) * (h[0] - h[1]) + (3 * u2 - 4 * u + 1) * h[2] + (3 * u2 - 2 * u) * h[3];
}

/// Derivatives by the knot parameter at each point: inside, the derivative of the parabola through
/// the point and its neighbours, which is the tangent of the non-uniform Catmull-Rom spline; at an
/// end that of the chord, as a phantom point mirrored at the end gives.
std::vector<glm::dvec3> tangents(const std::vector<glm::dvec3>& values,
                                 const std::vector<double>& steps) {
    const std::size_t n = values.size();
    std::vector<glm::dvec3> result(n);
    result[0] = (values[1] - values[0]) / steps[0];
    result[n - 1] = (values[n - 1] - values[n - 2]) / steps[n - 2];
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const glm::dvec3 before = (values[i] - values[i - 1]) / steps[i - 1];
        const glm::dvec3 after = (values[i + 1] - values[i]) / steps[i];
        result[i] = (before * steps[i] + after * steps[i - 1]) / (steps[i - 1] + steps[i]);
    }
    return result;
}

}  // namespace

double unwrapped(double a, double b) {
    return a + std::remainder(b - a, 360.0);
}

Curve::Curve(std::vector<glm::dvec3> positions, std::vector<glm::dvec3> angles) {
    if (positions.size() < 2 || angles.size() != positions.size()) {
        throw ContractError("Curve: expected at least two positions and as many angles");
    }
    std::vector<double> steps;
    for (std::size_t i = 0; i + 1 < positions.size(); ++i) {
        steps.push_back(std::sqrt(glm::distance(positions[i], positions[i + 1])));
        if (!(steps.back() > 0 && std::isfinite(steps.back()))) {
            throw ContractError("Curve: consecutive positions must be finite and apart");
        }
    }
    const std::vector<glm::dvec3> position_tangents = tangents(positions, steps);
    const std::vector<glm::dvec3> angle_tangents = tangents(angles, steps);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        segments_.push_back({{positions[i], positions[i + 1], position_tangents[i] * steps[i],
                              position_tangents[i + 1] * steps[i]},
                             {angles[i], angles[i + 1], angle_tangents[i] * steps[i],
                              angle_tangents[i + 1] * steps[i]}});
    }
    lengths_.push_back(0);
    for (std::size_t piece = 0; piece < segments_.size() * kPieces; ++piece) {
        const double from = double(piece % kPieces) / double(kPieces);
        lengths_.push_back(lengths_.back() + piece_length(piece, from, from + 1.0 / kPieces));
    }
}

double Curve::speed(std::size_t piece, double u) const {
    return glm::length(hermite_derivative(segments_[piece / kPieces].position, u));
}

double Curve::piece_length(std::size_t piece, double from, double to) const {
    const double half = (to - from) / 2;
    double sum = 0;
    for (int i = 0; i < 5; ++i) sum += kWeights[i] * speed(piece, from + half * (1 + kNodes[i]));
    return sum * half;
}

CurvePoint Curve::at(double travelled) const {
    travelled = std::clamp(travelled, 0.0, length());
    const auto above = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, travelled);
    const auto piece = std::size_t(above - lengths_.begin()) - 1;
    const double start = double(piece % kPieces) / double(kPieces);
    const double wanted = travelled - lengths_[piece];
    // The length grows with u, so that bisection always ends; 48 halvings leave 1 / 2^52 of a
    // segment.
    double low = start;
    double high = start + 1.0 / kPieces;
    if (wanted <= 0) {
        high = low;
    } else if (travelled >= lengths_[piece + 1]) {
        low = high;
    }
    for (int i = 0; i < 48 && low < high; ++i) {
        const double middle = (low + high) / 2;
        (piece_length(piece, start, middle) < wanted ? low : high) = middle;
    }
    const double u = (low + high) / 2;
    const Segment& segment = segments_[piece / kPieces];
    return {hermite(segment.position, u), hermite(segment.angles, u),
            hermite_derivative(segment.position, u)};
}

}  // namespace lodbench::scenario
