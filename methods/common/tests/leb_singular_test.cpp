// The criterion of longest-edge bisection where a quotient of the paper has no value: the eye on
// the vertex, inside its sphere, on its surface, in the image plane; and how many of its decisions
// rounding changes.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/leb_criterion.h"
#include "leb_test_terrain.h"

namespace lodbench::common {
namespace {

constexpr double kTau = 1;

/// A view from `eye` to the north, over a grid of a plane.
template <Metric metric>
struct At {
    std::unique_ptr<terrain::HeightField> terrain = test::plane_terrain(33, 33);
    LebRefiner refiner{*terrain, {kTau, ErrorKind::midpoint, metric, false}};
    Camera camera;

    /// The eye lies so far north of the vertex in the middle.
    explicit At(double north) {
        const glm::dvec2 middle = terrain->info().position(16, 16);
        camera.position = {middle.x, middle.y + north, 0};
        camera.orientation = Camera::look({0, -1, 0});
    }
    [[nodiscard]] LebComparison<metric> compare(float error, float radius) const {
        const LebView view = refiner.view(camera);
        return {view, LebVertex{.height = 0, .error = error, .radius = radius}, 16, 16};
    }
};

TEST(LebSingular, euclidean_refines_at_and_within_the_sphere_and_never_divides) {
    for (const double distance : {0.0, 1e-300, 1.0, 9.0, 10.0}) {
        const auto at = At<Metric::euclidean>(distance).compare(1e-6F, 10);
        EXPECT_TRUE(std::isfinite(at.reach) && std::isfinite(at.away));
        EXPECT_TRUE(at.active()) << "d = " << distance << ", r = 10";
    }
    // Beyond, it is as the paper says: lambda error > tau (d - r).
    const At<Metric::euclidean> beyond(11);
    const auto limit = float(kTau * 1.0 / beyond.camera.lambda());
    EXPECT_TRUE(beyond.compare(limit * 1.001F, 10).active());
    EXPECT_FALSE(beyond.compare(limit * 0.999F, 10).active());
}

TEST(LebSingular, planar_refines_in_and_behind_the_image_plane) {
    for (const double depth : {-5.0, 0.0, 1e-300, 1.0, 10.0}) {
        const auto at = At<Metric::planar>(depth).compare(1e-6F, 10);
        EXPECT_TRUE(std::isfinite(at.reach) && std::isfinite(at.away));
        EXPECT_TRUE(at.active()) << "depth = " << depth << ", r = 10";
    }
    EXPECT_FALSE(At<Metric::planar>(1e6).compare(1e-6F, 10).active());
}

TEST(LebSingular, a_vertex_without_error_is_inactive_wherever_the_eye) {
    for (const double distance : {0.0, 5.0, 10.0, 1e3}) {
        EXPECT_FALSE(At<Metric::euclidean>(distance).compare(0, 10).active());
        EXPECT_FALSE(At<Metric::planar>(distance).compare(0, 10).active());
    }
    const auto nothing = At<Metric::euclidean>(0).compare(0, 0);  // p = e, r = 0, no error
    EXPECT_TRUE(std::isfinite(nothing.reach) && std::isfinite(nothing.away));
    EXPECT_FALSE(nothing.active());
}

/// The decision in another precision.
template <typename Real, Metric metric>
bool decides(const LebView& view, const LebVertex& vertex, int row, int column) {
    const Real x = Real(view.north_west.x) + column * Real(view.spacing.x);
    const Real y = Real(view.north_west.y) - row * Real(view.spacing.y);
    const Real z = Real(vertex.height) - Real(view.eye_height);
    const Real error = vertex.error;
    if (!(error > 0)) return false;
    if constexpr (metric == Metric::euclidean) {
        const Real reach = Real(view.scale) * error + Real(vertex.radius);
        return reach * reach > x * x + y * y + z * z;
    } else {
        return (Real(view.scale) + 1) * error + Real(vertex.radius) >
               Real(view.forward.x) * x + Real(view.forward.y) * y + Real(view.forward.z) * z;
    }
}

struct Share {
    std::size_t decisions = 0, in_double = 0, in_float = 0;
    double worst_px = 0;  ///< by which the screen error of one that double decides otherwise is off

    template <Metric metric>
    void add(const LebView& view, const LebVertex& vertex, int row, int column) {
        const LebComparison<metric> compared(view, vertex, row, column);
        const bool exact = decides<long double, metric>(view, vertex, row, column);
        ++decisions;
        in_float += decides<float, metric>(view, vertex, row, column) != exact;
        if (compared.active() == exact) return;
        ++in_double;
        // Where both sides are as good as equal, the error that is drawn or not is tau times
        // (reach - radius) / (away - radius).
        const double away = metric == Metric::euclidean ? std::sqrt(compared.away) : compared.away;
        const double within = compared.reach - double(vertex.radius);
        worst_px = std::max(worst_px, kTau * std::abs(within / (away - double(vertex.radius)) - 1));
    }
};

constexpr auto kOptions = [](Metric metric) {
    return RefinerOptions{kTau, ErrorKind::midpoint, metric, false};
};

template <Metric metric>
Share at_random(const terrain::HeightField& terrain, unsigned seed) {
    const LebRefiner refiner(terrain, kOptions(metric));
    const LebGrid& grid = refiner.grid();
    std::mt19937 random(seed);
    Share share;
    for (int i = 0; i < 20; ++i) {
        const LebView view = refiner.view(test::random_camera(terrain.info(), random));
        for (int row = 0; row < grid.size(); ++row) {
            for (int column = 0; column < grid.size(); ++column) {
                share.add<metric>(view, grid.at({row, column}), row, column);
            }
        }
    }
    return share;
}

/// Cameras for each of which one decision stands on the edge of a knife: d = lambda error / tau +
/// r.
template <Metric metric>
Share on_the_edge(const terrain::HeightField& terrain, unsigned seed) {
    const LebRefiner refiner(terrain, kOptions(metric));
    const LebGrid& grid = refiner.grid();
    std::mt19937 random(seed);
    Share share;
    for (int i = 0; i < 4000; ++i) {
        const int row = int(random() % unsigned(terrain.info().rows));
        const int column = int(random() % unsigned(terrain.info().columns));
        const LebVertex& vertex = grid.at({row, column});
        if (!(vertex.error > 0)) continue;
        Camera camera = test::random_camera(terrain.info(), random);
        const double reach = LebComparison<metric>(refiner.view(camera), vertex, row, column).reach;
        camera.position = glm::dvec3(terrain.info().position(row, column), vertex.height) -
                          reach * camera.forward();
        share.add<metric>(refiner.view(camera), vertex, row, column);
    }
    return share;
}

void tell(const char* where, const Share& share) {
    fmt::print("  {}: {} decisions, {} differ in double, by {:.3g} px at most; {} in float\n",
               where, share.decisions, share.in_double, share.worst_px, share.in_float);
}

TEST(LebPrecision, double_decides_as_long_double_does) {
    const auto terrain = test::random_terrain(129, 129, 41);
    for (const Share& share :
         {at_random<Metric::euclidean>(*terrain, 42), at_random<Metric::planar>(*terrain, 43)}) {
        tell("random cameras", share);
        EXPECT_GT(share.decisions, 300'000U);
        // A decision differs where both sides agree to 2^-50: one in some 10^12.
        EXPECT_EQ(share.in_double, 0U);
    }
}

TEST(LebPrecision, a_decision_on_the_edge_is_off_by_nothing_that_is_seen) {
    const auto terrain = test::random_terrain(129, 129, 44);
    for (const Share& share : {on_the_edge<Metric::euclidean>(*terrain, 45),
                               on_the_edge<Metric::planar>(*terrain, 46)}) {
        tell("cameras on the edge", share);
        EXPECT_GT(share.in_double, 100U) << "the cameras come near no edge";
        EXPECT_LT(share.worst_px, 1e-9);
    }
}

}  // namespace
}  // namespace lodbench::common
