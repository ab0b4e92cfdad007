#include "measure/greedy_triangulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <queue>
#include <tuple>

#include "api/error.h"
#include "measure/box_in_view.h"
#include "measure/delaunay.h"
#include "measure/error_pool.h"
#include "measure/pixel_projection.h"

namespace lodbench::measure {
namespace {

constexpr double kSlack = 1e-9;

/// The worst sample of a triangle; `px` is negative where none in view has an error.
struct Worst {
    double px = -1;
    Delaunay::Vertex sample;
};

/// Floor and ceiling of a / b, b > 0.
std::int64_t floor_of(std::int64_t a, std::int64_t b) {
    return a >= 0 ? a / b : -((-a + b - 1) / b);
}
std::int64_t ceiling_of(std::int64_t a, std::int64_t b) {
    return -floor_of(-a, b);
}

/// Which triangles of samples reach into a camera's frustum.
class Frustum {
public:
    Frustum(const ReferenceTerrain& terrain, const Camera& camera)
        : terrain_(terrain),
          box_in_view_(camera, kSlack),
          planes_(camera.frustum_planes()),
          eye_(camera.position) {}

    [[nodiscard]] bool may_hold(const SampleRect& rect) const {
        const HeightInterval range = terrain_.range(rect);
        const glm::dvec2 south_west =
            terrain_.info().position(rect.row + rect.rows - 1, rect.column);
        const glm::dvec2 north_east =
            terrain_.info().position(rect.row, rect.column + rect.columns - 1);
        return box_in_view_({south_west, range.low}, {north_east, range.high});
    }

    /// Whether the triangle of three samples is not wholly outside one plane of the frustum.
    [[nodiscard]] bool holds(const std::array<Delaunay::Vertex, 3>& v) const {
        std::array<glm::dvec3, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) corners[i] = terrain_.sample(v[i].y, v[i].x) - eye_;
        return std::ranges::none_of(planes_, [&](const glm::dvec4& plane) {
            return std::ranges::all_of(corners, [&](const glm::dvec3& corner) {
                return glm::dot(glm::dvec3(plane), corner) + plane.w < 0;
            });
        });
    }

    [[nodiscard]] std::uint64_t full_grid() const {
        constexpr int kBlock = 32;
        const TerrainInfo& info = terrain_.info();
        std::uint64_t count = 0;
        for (int row = 0; row < info.rows - 1; row += kBlock) {
            for (int column = 0; column < info.columns - 1; column += kBlock) {
                const int south = std::min(row + kBlock, info.rows - 1);
                const int east = std::min(column + kBlock, info.columns - 1);
                if (!may_hold({row, column, south - row + 1, east - column + 1})) continue;
                for (int y = row; y < south; ++y) {
                    for (int x = column; x < east; ++x) {
                        count += std::uint64_t(holds({{{x, y}, {x, y + 1}, {x + 1, y + 1}}}));
                        count += std::uint64_t(holds({{{x, y}, {x + 1, y + 1}, {x + 1, y}}}));
                    }
                }
            }
        }
        return count;
    }

private:
    const ReferenceTerrain& terrain_;
    BoxInView box_in_view_;
    std::array<glm::dvec4, 5> planes_;
    glm::dvec3 eye_;
};

class Greedy {
public:
    Greedy(const ReferenceTerrain& terrain, const Camera& camera, double target_px,
           ErrorBound bound)
        : terrain_(terrain),
          target_px_(target_px),
          bound_(bound),
          columns_(terrain.info().columns),
          delaunay_(columns_ - 1, terrain.info().rows - 1),
          pixels_(camera),
          frustum_(terrain, camera),
          errors_(terrain.heights().size(), kOutOfView) {
        const TerrainInfo& info = terrain.info();
        corner_ = pixels_.local({info.position(0, 0), 0});
        east_ = pixels_.turned({info.spacing.x, 0, 0});
        south_ = pixels_.turned({0, -info.spacing.y, 0});
        up_ = pixels_.turned({0, 0, 1});
    }

    GreedyTriangulation run() {
        std::vector<std::int32_t> changed = {0, 1};
        rate(changed);
        double greatest = 0;
        while (!queue_.empty()) {
            const auto [px, triangle, version] = queue_.top();
            if (version != versions_[std::size_t(triangle)]) {
                queue_.pop();
                continue;
            }
            if (is_met(px)) {
                greatest = px;
                break;
            }
            queue_.pop();
            changed.clear();
            delaunay_.insert(triangle, worst_[std::size_t(triangle)].sample, changed);
            rate(changed);
        }
        return result(greatest);
    }

private:
    using Entry = std::tuple<double, std::int32_t, std::uint32_t>;  // px, triangle, version

    [[nodiscard]] bool is_met(double greatest) const {
        if (bound_ == ErrorBound::max) return greatest <= target_px_;
        return over_target_ <= in_view_ - p999_rank(in_view_);
    }

    /// Of so many errors in rising order, how many are no greater than their P99.9.
    static std::uint64_t p999_rank(std::uint64_t errors) { return errors - errors / 1000; }

    /// A sample's error, or kOutOfView.
    void note(std::size_t sample, float px) {
        float& noted = errors_[sample];
        const auto count = [this](float error, std::uint64_t step) {
            in_view_ += error != kOutOfView ? step : 0;
            over_target_ += double(error) > target_px_ ? step : 0;
        };
        count(noted, ~std::uint64_t{0});
        count(px, 1);
        noted = px;
    }

    [[nodiscard]] double height(const Delaunay::Vertex& vertex) const {
        return double(terrain_.heights()[std::size_t(vertex.y) * std::size_t(columns_) +
                                         std::size_t(vertex.x)]);
    }

    /// Finds the worst sample of each of the triangles anew.
    void rate(std::vector<std::int32_t>& triangles) {
        worst_.resize(delaunay_.triangles().size());
        versions_.resize(delaunay_.triangles().size());
        std::ranges::sort(triangles);
        triangles.erase(std::ranges::unique(triangles).begin(), triangles.end());
        for (const std::int32_t triangle : triangles) {
            const auto i = std::size_t(triangle);
            ++versions_[i];
            worst_[i] = evaluate(delaunay_.triangles()[i]);
            if (worst_[i].px > 0) queue_.emplace(worst_[i].px, triangle, versions_[i]);
        }
    }

    /// Notes the error of each sample of the triangle.
    [[nodiscard]] Worst evaluate(const Delaunay::Triangle& triangle) {
        std::array<Delaunay::Vertex, 3> v;
        for (std::size_t i = 0; i < 3; ++i) {
            v[i] = delaunay_.vertices()[std::size_t(triangle.vertices[i])];
        }
        const auto [west, east] = std::minmax({v[0].x, v[1].x, v[2].x});
        const auto [north, south] = std::minmax({v[0].y, v[1].y, v[2].y});
        Worst worst;
        const bool seen = frustum_.may_hold({north, west, south - north + 1, east - west + 1});
        // The plane through the corners: z = first + slope_x (x - x0) + slope_y (y - y0).
        const double first = height(v[0]), z1 = height(v[1]) - first, z2 = height(v[2]) - first;
        const double x1 = v[1].x - v[0].x, y1 = v[1].y - v[0].y;
        const double x2 = v[2].x - v[0].x, y2 = v[2].y - v[0].y;
        const double area = x1 * y2 - x2 * y1;
        const double slope_x = (z1 * y2 - z2 * y1) / area;
        const double slope_y = (z2 * x1 - z1 * x2) / area;
        for (std::int32_t y = north; y <= south; ++y) {
            std::int64_t from = east, to = west;
            for (std::size_t i = 0; i < 3; ++i) {
                const Delaunay::Vertex* p = &v[i];
                const Delaunay::Vertex* q = &v[(i + 1) % 3];
                if (p->y > q->y) std::swap(p, q);
                if (y < p->y || y > q->y) continue;
                if (p->y == q->y) {
                    from = std::min<std::int64_t>({from, p->x, q->x});
                    to = std::max<std::int64_t>({to, p->x, q->x});
                    continue;
                }
                const std::int64_t run = std::int64_t(q->x - p->x) * (y - p->y);
                from = std::min(from, p->x + ceiling_of(run, q->y - p->y));
                to = std::max(to, p->x + floor_of(run, q->y - p->y));
            }
            const double row_height = first + slope_y * (y - v[0].y);
            const std::size_t row = std::size_t(y) * std::size_t(columns_);
            const float* const heights = &terrain_.heights()[row];
            const glm::dvec3 row_place = corner_ + south_ * double(y);
            for (auto x = std::int32_t(from); x <= std::int32_t(to); ++x) {
                const double z = double(heights[x]);
                const double drawn_z = row_height + slope_x * (x - v[0].x);
                const glm::dvec3 place = row_place + east_ * double(x);
                const glm::dvec3 truth = place + up_ * z;
                const glm::dvec3 drawn = place + up_ * drawn_z;
                if (!seen || (!pixels_.in_view(truth) && !pixels_.in_view(drawn))) {
                    note(row + std::size_t(x), kOutOfView);
                    continue;
                }
                const double px = pixels_.distance(truth, drawn).px;
                // A corner's own rounding is no error, as in the pool.
                note(row + std::size_t(x), px < ErrorPool::kLeastError ? 0 : float(px));
                if (px > worst.px && !is_corner(v, x, y)) worst = {px, {x, y}};
            }
        }
        return worst;
    }

    static bool is_corner(const std::array<Delaunay::Vertex, 3>& v, std::int32_t x,
                          std::int32_t y) {
        return std::ranges::any_of(
            v, [&](const Delaunay::Vertex& corner) { return corner.x == x && corner.y == y; });
    }

    [[nodiscard]] double p999() const {
        std::vector<float> errors;
        errors.reserve(in_view_);
        std::ranges::copy_if(errors_, std::back_inserter(errors),
                             [](float px) { return px != kOutOfView; });
        if (errors.empty()) return 0;
        const auto at = errors.begin() + std::ptrdiff_t(p999_rank(errors.size()) - 1);
        std::ranges::nth_element(errors, at);
        return double(*at);
    }

    GreedyTriangulation result(double greatest) const {
        GreedyTriangulation result;
        result.max_px = greatest;
        result.p999_px = p999();
        for (const Delaunay::Vertex& vertex : delaunay_.vertices()) {
            result.vertices.push_back({vertex.y, vertex.x});
        }
        for (const Delaunay::Triangle& triangle : delaunay_.triangles()) {
            std::array<Delaunay::Vertex, 3> v;
            for (std::size_t i = 0; i < 3; ++i) {
                v[i] = delaunay_.vertices()[std::size_t(triangle.vertices[i])];
            }
            result.in_view += std::uint64_t(frustum_.holds(v));
            // Rows run southward: the other way round, seen from above.
            result.triangles.push_back({std::uint32_t(triangle.vertices[0]),
                                        std::uint32_t(triangle.vertices[2]),
                                        std::uint32_t(triangle.vertices[1])});
        }
        return result;
    }

    static constexpr float kOutOfView = -1;

    const ReferenceTerrain& terrain_;
    double target_px_;
    ErrorBound bound_;
    int columns_;
    Delaunay delaunay_;
    PixelProjection pixels_;
    Frustum frustum_;
    glm::dvec3 corner_, east_, south_, up_;        ///< sample (0, 0) at height 0, and steps from it
    std::vector<float> errors_;                    ///< pixels, of each sample
    std::uint64_t in_view_ = 0, over_target_ = 0;  ///< samples
    std::vector<Worst> worst_;
    std::vector<std::uint32_t> versions_;  ///< of each triangle: an entry of another is stale
    std::priority_queue<Entry> queue_;
};

}  // namespace

GreedyTriangulation greedy_triangulation(const ReferenceTerrain& terrain, const Camera& camera,
                                         double target_px, ErrorBound bound) {
    if (!(target_px >= 0)) {
        throw ContractError(
            fmt::format("greedy_triangulation: a target of {} px, expected at least 0", target_px));
    }
    return Greedy(terrain, camera, target_px, bound).run();
}

std::uint64_t full_grid_in_view(const ReferenceTerrain& terrain, const Camera& camera) {
    return Frustum(terrain, camera).full_grid();
}

CapturedSurface surface_of(const GreedyTriangulation& triangulation,
                           const ReferenceTerrain& terrain, const Camera& camera) {
    CapturedSurface surface;
    surface.origin = camera.position;
    for (const auto& triangle : triangulation.triangles) {
        for (const std::uint32_t i : triangle) {
            const GridVertex& vertex = triangulation.vertices[i];
            surface.vertices.emplace_back(terrain.sample(vertex.row, vertex.column) -
                                          camera.position);
        }
    }
    return surface;
}

}  // namespace lodbench::measure
