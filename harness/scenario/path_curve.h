#pragma once
// The curve that a path travels: position and angles as a function of the length travelled.

#include <glm/vec3.hpp>
#include <vector>

namespace lodbench::scenario {

/// A place on a curve: metres and degrees.
struct CurvePoint {
    glm::dvec3 position{0.0};
    glm::dvec3 angles{0.0};   ///< heading, pitch, roll in degrees
    glm::dvec3 tangent{0.0};  ///< derivative of the position, not normalised
};

/// Centripetal Catmull-Rom spline (Catmull and Rom, A class of local interpolating splines, 1974;
/// the knots of Yuksel, Schaefer and Keyser, Parameterization and applications of Catmull-Rom
/// curves, 2011: square roots of the chords), reparametrised by arc length. C1 in position and
/// angles. With two points it is the straight line between them.
class Curve {
public:
    /// At least two points, consecutive ones apart; `angles` has one entry a point and is
    /// interpolated as given. Throws ContractError otherwise.
    Curve(std::vector<glm::dvec3> positions, std::vector<glm::dvec3> angles);

    [[nodiscard]] double length() const { return lengths_.back(); }  ///< metres, > 0
    /// Point after `travelled` metres, clamped to [0, length()].
    [[nodiscard]] CurvePoint at(double travelled) const;

private:
    struct Segment {
        glm::dvec3
            position[4];  ///< Hermite: ends p0, p1 and tangents m0, m1 per unit of u in [0, 1]
        glm::dvec3 angles[4];
    };
    [[nodiscard]] double speed(std::size_t piece, double u) const;
    [[nodiscard]] double piece_length(std::size_t piece, double from, double to) const;

    std::vector<Segment> segments_;
    std::vector<double>
        lengths_;  ///< up to the start of each piece; kPieces pieces a segment, and the end
};

/// Degrees b + 360 k nearest to a: the shorter way round.
[[nodiscard]] double unwrapped(double a, double b);

}  // namespace lodbench::scenario
