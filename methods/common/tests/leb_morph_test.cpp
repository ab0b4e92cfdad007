// Geomorphing: the surface moves no faster than is stated, has no cracks and keeps the bound; and
// the two forms of lambda.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "api/error.h"
#include "leb_mesh.h"

namespace lodbench::common {
namespace {

using test::defect_of;
using test::Mesh;
using test::surface_of;

RefinerOptions morphing(double tau, double ratio, ErrorKind error = ErrorKind::midpoint,
                        Metric metric = Metric::euclidean, bool culling = false) {
    return {.tau = tau, .error = error, .metric = metric, .culling = culling, .morph = ratio};
}

/// Heights of the strip's vertices by index; fails where one has two.
std::map<std::uint32_t, float> heights_of(const LebRefiner& refiner) {
    std::map<std::uint32_t, float> heights;
    for (const MorphedVertex& vertex : refiner.morph()->vertices()) {
        const auto [known, is_new] = heights.try_emplace(vertex.index, vertex.height);
        EXPECT_EQ(known->second, vertex.height) << "vertex " << vertex.index;
    }
    return heights;
}

std::vector<double> drawn_surface(LebRefiner& refiner, const Camera& camera) {
    const Mesh mesh(refiner.grid().size(), refiner.refine(camera).indices());
    EXPECT_EQ(defect_of(mesh), "");
    if (!refiner.morph()) return surface_of(mesh, refiner.grid());
    const auto heights = heights_of(refiner);
    return surface_of(mesh, [&](std::uint32_t index) { return heights.at(index); });
}

/// By vertex: how fast it moves at most, in metres a metre of the eye, by the formula in
/// leb_morph.h and by nothing that the code under test computes but errors and radii.
class StatedRates {
public:
    StatedRates(const LebGrid& grid, double lambda, double tau, double ratio)
        : grid_(grid), outer_(lambda / (tau / reserve(ratio))), inner_(outer_ / ratio) {}
    double rate(Sample vertex) { return of(vertex).rate; }

private:
    struct Motion {
        double most_off = 0;  ///< H, metres from the edge
        double rate = 0;
    };
    static double reserve(double ratio) { return ratio * std::log(ratio) / (ratio - 1); }
    Motion of(Sample vertex) {
        const int last = grid_.size() - 1;
        if (vertex.row % last == 0 && vertex.column % last == 0) return {};
        if (2 * vertex.row == last && 2 * vertex.column == last) return {};
        const auto found = known_.find(grid_.index(vertex));
        if (found != known_.end()) return found->second;
        const auto [from, to] = split_edge(vertex);
        const Motion a = of(from), b = of(to);
        const LebVertex& v = grid_.at(vertex);
        const double delta =
            std::abs(v.height - 0.5 * (double(grid_.at(from).height) + grid_.at(to).height));
        Motion motion{delta + std::max(a.most_off, b.most_off), std::max(a.rate, b.rate)};
        if (v.error > 0) {
            const double most = outer_ * v.error + v.radius;
            const double least = inner_ * v.error + v.radius;
            motion.rate += 2 * most / (most * most - least * least) * motion.most_off;
        }
        return known_[grid_.index(vertex)] = motion;
    }
    const LebGrid& grid_;
    double outer_, inner_;
    std::map<std::size_t, Motion> known_;
};

/// A step of half a metre or so along a line that nears the ground.
Camera on_the_way(const TerrainInfo& info, int step) {
    Camera camera;
    camera.position = {info.origin.x - 100 + 0.6 * step, info.origin.y + 200 + 0.2 * step,
                       info.max_height + 150 - 0.1 * step};
    camera.orientation = Camera::look({1, 0.3, -0.4});
    return camera;
}

/// The greatest motion of a sample of the drawn surface in a step, of what is stated.
double fastest_of_stated(LebRefiner& flown, double tau, double ratio) {
    const LebGrid& grid = flown.grid();
    StatedRates rates(grid, Camera{}.lambda(), tau, ratio);
    const TerrainInfo info = test::random_terrain(65, 65, 31)->info();
    double fastest = 0;
    std::vector<double> before;
    for (int step = 0; step < 100; ++step) {
        const Camera camera = on_the_way(info, step);
        std::vector<double> now = drawn_surface(flown, camera);
        const double way =
            step == 0 ? 0 : glm::length(camera.position - on_the_way(info, step - 1).position);
        for (std::size_t i = 0; i < now.size() && !before.empty(); ++i) {
            const Sample sample{int(i) / grid.size(), int(i) % grid.size()};
            // Each of 12 levels rounds to float, a height under 128 m to 2^-18 m, in both frames.
            const double rounding = 24 * 0x1p-18;
            const double moved = std::max(std::abs(now[i] - before[i]) - rounding, 0.0);
            if (moved > 0) fastest = std::max(fastest, moved / (rates.rate(sample) * way));
        }
        before = std::move(now);
    }
    return fastest;
}

TEST(LebMorph, no_vertex_moves_faster_than_its_stated_rate_and_without_morphing_they_do) {
    const auto terrain = test::random_terrain(65, 65, 31);
    for (const ErrorKind error : {ErrorKind::midpoint, ErrorKind::accumulated}) {
        for (const double ratio : {1.2, 2.0, 5.0}) {
            const double tau = 30;
            LebRefiner with(*terrain, morphing(tau, ratio, error));
            const double fastest = fastest_of_stated(with, tau, ratio);
            EXPECT_LE(fastest, 1) << "ratio " << ratio;
            EXPECT_GT(fastest, 0.05) << "a flight on which nothing moves tests nothing";
            LebRefiner without(*terrain, morphing(tau, 1, error));
            EXPECT_GT(fastest_of_stated(without, tau, ratio), 10) << "ratio " << ratio;
        }
    }
}

TEST(LebMorph, has_the_vertices_of_the_lower_threshold_each_between_its_own_height_and_its_edge) {
    std::mt19937 random(32);
    std::size_t moved = 0;
    for (const Metric metric : {Metric::euclidean, Metric::planar}) {
        for (const bool culling : {false, true}) {
            const auto terrain = test::random_terrain(47, 65, 33);
            const double ratio = 3, tau = 8;
            LebRefiner refiner(*terrain,
                               morphing(tau, ratio, ErrorKind::midpoint, metric, culling));
            const double lower = tau / (ratio * std::log(ratio) / (ratio - 1));
            LebRefiner fixed(*terrain, morphing(lower, 1, ErrorKind::midpoint, metric, culling));
            for (int frame = 0; frame < 30; ++frame) {
                const Camera camera = test::random_camera(terrain->info(), random);
                const auto strip = refiner.refine(camera).indices();
                const auto expected = fixed.refine(camera).indices();
                ASSERT_TRUE(
                    std::equal(strip.begin(), strip.end(), expected.begin(), expected.end()));
                ASSERT_EQ(refiner.morph()->vertices().size(), strip.size());
                const auto heights = heights_of(refiner);
                std::size_t between = 0;
                for (const auto& [index, height] : heights) {
                    const Sample vertex{int(index) / 65, int(index) % 65};
                    const float own = refiner.grid().at(vertex).height;
                    if (height == own) continue;
                    const auto [from, to] = split_edge(vertex);
                    // All ends are vertices too, or `at` throws.
                    const double edge =
                        0.5 * (double(heights.at(std::uint32_t(refiner.grid().index(from)))) +
                               heights.at(std::uint32_t(refiner.grid().index(to))));
                    EXPECT_GE(height, float(std::min(edge, double(own))));
                    EXPECT_LE(height, float(std::max(edge, double(own))));
                    ++between;
                }
                EXPECT_LE(between, refiner.morph()->morphing());
                moved += between;
            }
        }
    }
    EXPECT_GT(moved, 1000U);
}

TEST(LebMorph, of_a_tiny_tolerance_is_the_terrain) {
    const auto terrain = test::random_terrain(33, 33, 34);
    LebRefiner refiner(*terrain, morphing(1e-9, 2));
    Camera camera;
    camera.position = {0, 0, 5000};
    const std::vector<double> surface = drawn_surface(refiner, camera);
    for (std::size_t i = 0; i < surface.size(); ++i) {
        EXPECT_EQ(surface[i], double(refiner.grid().vertices()[i].height));
    }
    EXPECT_EQ(refiner.morph()->morphing(), 0U);
}

TEST(LebMorph, keeps_the_bound_with_accumulated_errors_and_the_planar_metric) {
    const auto terrain = test::random_terrain(65, 65, 13);
    std::mt19937 random(14);
    double worst = 0;
    std::size_t morphed = 0;
    for (const double ratio : {1.1, 2.0, 10.0}) {
        for (const double tau : {1.0, 16.0}) {
            LebRefiner refiner(*terrain,
                               morphing(tau, ratio, ErrorKind::accumulated, Metric::planar, true));
            for (int frame = 0; frame < 40; ++frame) {
                const Camera camera = test::random_camera(terrain->info(), random);
                const std::vector<double> surface = drawn_surface(refiner, camera);
                morphed += refiner.morph()->morphing();
                for (std::size_t i = 0; i < surface.size(); ++i) {
                    const Sample sample{int(i) / 65, int(i) % 65};
                    const glm::dvec2 xy = terrain->info().position(sample.row, sample.column);
                    const auto drawn = camera.project({xy, surface[i]});
                    const auto exact = camera.project({xy, refiner.grid().at(sample).height});
                    const auto inside = [](const glm::dvec2& p) {
                        return p.x >= 0 && p.y >= 0 && p.x <= 640 && p.y <= 480;
                    };
                    if (!drawn || !exact || !(inside(*drawn) || inside(*exact))) continue;
                    worst = std::max(worst, glm::length(*drawn - *exact) / tau);
                }
            }
        }
    }
    EXPECT_LE(worst, 1.0);
    EXPECT_GT(worst, 0.1) << "a test that sees no error tests nothing";
    EXPECT_GT(morphed, 1000U);
}

TEST(LebRefiner, of_the_angles_lambda_is_that_of_a_tolerance_as_much_smaller) {
    const auto terrain = test::random_terrain(65, 65, 35);
    std::mt19937 random(36);
    for (const auto& [degrees, times] :
         {std::pair{90.0, 1.2732395447351628}, std::pair{120.0, 1.6539866862653763}}) {
        LebRefiner angle(*terrain, {.tau = 4, .lambda = LambdaForm::angle});
        LebRefiner tangent(*terrain, {.tau = 4 / times});
        for (int frame = 0; frame < 20; ++frame) {
            Camera camera = test::random_camera(terrain->info(), random);
            camera.vertical_fov = degrees * 0.017453292519943295;
            const double scale = tangent.view(camera).scale;
            EXPECT_NEAR(angle.view(camera).scale, scale, 1e-12 * scale);
            EXPECT_EQ(angle.refine(camera).triangle_count(),
                      tangent.refine(camera).triangle_count());
        }
    }
}

TEST(LebRefiner, refuses_a_ratio_of_thresholds_below_1) {
    const auto terrain = test::random_terrain(9, 9, 37);
    EXPECT_THROW(LebRefiner(*terrain, {.morph = 0.9}), ContractError);
    EXPECT_THROW(LebRefiner(*terrain, {.morph = std::nan("")}), ContractError);
}

}  // namespace
}  // namespace lodbench::common
