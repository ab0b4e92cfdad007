#include "measure/drawn_surface.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "measure/plan_ray.h"
#include "measure/plan_triangle.h"

namespace lodbench::measure {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = DrawnSurface::kRoundingUnits / 16777216;  // 2^-24

bool finite(const Corners& corners) {
    return std::ranges::all_of(corners, [](const glm::vec3& corner) {
        return std::isfinite(corner.x) && std::isfinite(corner.y) && std::isfinite(corner.z);
    });
}

glm::dvec3 normal(const Corners& corners) {
    const glm::dvec3 a(corners[0]);
    return glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
}

double largest_plan_coordinate(const glm::vec3* corners) {
    float largest = 0;
    for (int i = 0; i < 3; ++i) {
        largest = std::max({largest, std::abs(corners[i].x), std::abs(corners[i].y)});
    }
    return largest;
}

/// Least altitude in plan = twice the area / longest edge.
bool thicker_than(double thickness, const Corners& corners) {
    const glm::dvec2 a(corners[0]);
    const glm::dvec2 b(corners[1]);
    const glm::dvec2 c(corners[2]);
    const double longest =
        std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    return std::abs(plan_area(a, b, c)) > thickness * longest;
}

/// The t at which origin + t * direction meets a triangle, sides inclusive; infinity where it does
/// not. Signs of the volumes that the ray spans with the sides, each from the same end for both
/// triangles at that side (after Woop, Benthin and Wald: Watertight Ray/Triangle Intersection,
/// 2013, without their shear): no ray slips through between two.
double meeting(const glm::vec3* corners, const glm::dvec3& origin, const glm::dvec3& direction) {
    const glm::dvec3 a = glm::dvec3(corners[0]) - origin;
    const glm::dvec3 b = glm::dvec3(corners[1]) - origin;
    const glm::dvec3 c = glm::dvec3(corners[2]) - origin;
    const double weight_a = glm::dot(direction, glm::cross(b, c));
    const double weight_b = -glm::dot(direction, glm::cross(a, c));
    const double weight_c = glm::dot(direction, glm::cross(a, b));
    const auto [least, greatest] = std::minmax({weight_a, weight_b, weight_c});
    if (least < 0 && greatest > 0) return kInfinity;
    const double sum = weight_a + weight_b + weight_c;
    if (sum == 0) return kInfinity;  // seen edge-on
    const glm::dvec3 point = (weight_a * a + weight_b * b + weight_c * c) / sum;
    return glm::dot(point, direction) / glm::dot(direction, direction);
}

/// From the end of `axis` to the segment ab.
double distance_to_segment(const glm::dvec3& axis, const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 along = b - a;
    const double length = glm::dot(along, along);
    const double share =
        length > 0 ? std::clamp(glm::dot(axis - a, along) / length, 0.0, 1.0) : 0.0;
    return glm::distance(axis, a + share * along);
}

/// False unless a point is farther than `plan` from a triangle, by what its sides say: quicker than
/// the distance to its outline. A hundredth is far more than the rounding of a side's value for
/// triangles that are not millions of times as large as the extent's `reach`.
bool lies_beyond(const PlanTriangle& triangle, const glm::dvec2& point, double plan, double reach) {
    const glm::dvec2 size = triangle.high - triangle.low;
    if (std::max(size.x, size.y) > 0x1p20 * reach) return false;
    return std::ranges::any_of(triangle.edges, [&](const PlanTriangle::Edge& edge) {
        const double side = edge.side(point);
        return side < 0 && side * side > 1.02 * plan * plan * glm::dot(edge.along, edge.along);
    });
}

void append(std::vector<glm::vec3>& vertices, const glm::vec3* corners) {
    vertices.insert(vertices.end(), corners, corners + 3);
}

}  // namespace

struct DrawnSurface::Sorted {
    std::vector<glm::vec3> surface, slivers;
    std::vector<glm::vec3> steep;    ///< with thickness
    std::vector<glm::vec3> upright;  ///< steep, without
};

DrawnSurface::DrawnSurface(CapturedSurface&& surface, const TerrainInfo& info)
    : info_(info),
      origin_(surface.origin),
      low_(info.extent_min() - glm::dvec2(surface.origin)),
      high_(info.extent_max() - glm::dvec2(surface.origin)),
      reach_(std::max({std::abs(low_.x), std::abs(low_.y), std::abs(high_.x), std::abs(high_.y)})) {
    Sorted sorted = sort_by_kind(std::move(surface.vertices));
    slivers_ = TriangleTree(std::move(sorted.slivers), low_, high_);
    surface_ = TriangleTree(std::move(sorted.surface), low_, high_);

    std::vector<glm::vec3> skirts;
    std::vector<glm::vec3> risers;
    const std::vector<char> steep_below = below_surface(sorted.steep);
    for (std::size_t i = 0; i < steep_below.size(); ++i) {
        append(steep_below[i] != 0 ? skirts : risers, &sorted.steep[i * 3]);
    }
    if (!risers.empty()) {
        std::vector<glm::vec3> all = surface_.release();
        all.insert(all.end(), risers.begin(), risers.end());
        surface_ = TriangleTree(std::move(all), low_, high_);
    }
    // Only now: what hangs from a riser is below it, and is never part of l_f itself.
    const std::vector<char> upright_below = below_surface(sorted.upright);
    for (std::size_t i = 0; i < upright_below.size(); ++i) {
        if (upright_below[i] != 0) {
            append(skirts, &sorted.upright[i * 3]);
        } else {
            ++wall_triangle_count_;
        }
    }
    for (const glm::vec3& vertex : skirts) {
        skirts_low_ = glm::min(skirts_low_, glm::dvec2(vertex));
        skirts_high_ = glm::max(skirts_high_, glm::dvec2(vertex));
    }
    skirts_ = TriangleTree(std::move(skirts), low_, high_);
    for (const TriangleTree* tree : {&surface_, &slivers_}) {
        for (const glm::vec3& vertex : tree->vertices()) {
            lowest_ = std::min(lowest_, double(vertex.z));
            highest_ = std::max(highest_, double(vertex.z));
        }
    }
}

HeightInterval DrawnSurface::bounds() const {
    if (lowest_ > highest_) return {kInfinity, -kInfinity};
    // Displacements are rounded to float.
    const double rounding =
        0x1p-20 * (std::abs(origin_.z) + std::max(std::abs(lowest_), std::abs(highest_)));
    return {origin_.z + lowest_ - rounding, origin_.z + highest_ + rounding};
}

DrawnSurface::Sorted DrawnSurface::sort_by_kind(std::vector<glm::vec3>&& vertices) const {
    Sorted sorted;
    sorted.surface = std::move(vertices);  // nearly all of them: kept where they are
    std::size_t kept = 0;
    for (std::size_t i = 0; i + 2 < sorted.surface.size(); i += 3) {
        Corners corners{sorted.surface[i], sorted.surface[i + 1], sorted.surface[i + 2]};
        if (!finite(corners) || !touches_extent(corners.data())) continue;
        corners = ordered(corners);
        const glm::dvec3 upward = normal(corners);
        if (upward == glm::dvec3(0.0)) continue;
        const bool steep = glm::length(glm::dvec2(upward)) > kSteepSlope * std::abs(upward.z);
        const bool thick = thicker_than(plan_rounding(corners.data()), corners);
        if (steep) {
            append(thick ? sorted.steep : sorted.upright, corners.data());
        } else if (!thick) {
            append(sorted.slivers, corners.data());
        } else {
            std::ranges::copy(corners, sorted.surface.begin() + std::ptrdiff_t(kept));
            kept += 3;
        }
    }
    sorted.surface.resize(kept);
    return sorted;
}

std::vector<char> DrawnSurface::below_surface(std::span<const glm::vec3> steep) const {
    std::vector<char> below(steep.size() / 3);
    tbb::parallel_for(std::size_t(0), below.size(),
                      [&](std::size_t i) { below[i] = is_below_surface(&steep[i * 3]) ? 1 : 0; });
    return below;
}

bool DrawnSurface::is_below_surface(const glm::vec3* corners) const {
    const glm::dvec3 a(corners[0]);
    const glm::dvec3 b(corners[1]);
    const glm::dvec3 c(corners[2]);
    // The rounding of z; and over the rounding in plan, a surface that is not steep rises by
    // kSteepSlope times that at most.
    const double margin = kRounding * std::max({std::abs(a.z), std::abs(b.z), std::abs(c.z)}) +
                          kSteepSlope * plan_rounding(corners);
    const std::array<glm::dvec3, 7> points{
        a, b, c, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0, (a + b + c) / 3.0};
    return std::ranges::all_of(points, [&](const glm::dvec3& point) {
        return relative_height(glm::clamp(glm::dvec2(point), low_, high_)) >= point.z - margin;
    });
}

double DrawnSurface::plan_rounding(double largest_coordinate) const {
    return kRounding * std::min(largest_coordinate, reach_);
}

double DrawnSurface::plan_rounding(const glm::vec3* corners) const {
    return plan_rounding(largest_plan_coordinate(corners));
}

bool DrawnSurface::touches_extent(const glm::vec3* corners) const {
    const double rounding = plan_rounding(corners);
    for (int axis = 0; axis < 2; ++axis) {
        const auto [least, greatest] =
            std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
        if (greatest < low_[axis] - rounding || least > high_[axis] + rounding) return false;
    }
    return true;
}

std::optional<double> DrawnSurface::height(const glm::dvec2& position) const {
    return world_height(relative_height(position - glm::dvec2(origin_)));
}

std::optional<double> DrawnSurface::world_height(double relative) const {
    if (relative == -kInfinity) return std::nullopt;
    return origin_.z + relative;
}

DrawnSurface::Look DrawnSurface::look(const glm::dvec2& position) const {
    const glm::dvec2 point = position - glm::dvec2(origin_);
    const PlanBox box = around(point, point);
    double covering = -kInfinity;
    double nearby = -kInfinity;
    Rounding greatest;
    const auto keep_rounding = [&](const glm::vec3* corners, double plan) {
        const float highest =
            std::max({std::abs(corners[0].z), std::abs(corners[1].z), std::abs(corners[2].z)});
        greatest = {std::max(greatest.plan, plan),
                    std::max(greatest.height, kRounding * double(highest))};
    };
    const auto enters = [&](const TriangleTree::Node& node) { return node.meets(box); };
    const auto visit = [&](const glm::vec3* corners, bool has_inside) {
        if (!box.meets(corners)) return;
        const double plan = plan_rounding(corners);
        const PlanTriangle triangle(corners);
        const bool covers = triangle.covers(point);
        if (covers && has_inside) {
            covering = std::max(covering, triangle.height(point));
        } else if (!covers && lies_beyond(triangle, point, plan, reach_)) {
            return;
        } else {
            const OutlinePoint nearest = nearest_on_outline(corners, point);
            if (nearest.distance <= plan) {
                nearby = std::max(nearby, nearest.z);
            } else if (!covers) {
                return;
            }
        }
        keep_rounding(corners, plan);
    };
    surface_.each(enters, [&](const glm::vec3* corners) { visit(corners, true); });
    slivers_.each(enters, [&](const glm::vec3* corners) { visit(corners, false); });
    return {world_height(covering != -kInfinity ? covering : nearby), greatest};
}

double DrawnSurface::relative_height(const glm::dvec2& point) const {
    double highest = -kInfinity;
    const PlanBox box(point);
    surface_.each([&box](const TriangleTree::Node& node) { return node.meets(box); },
                  [&](const glm::vec3* corners) {
                      if (!box.meets(corners)) return;
                      const PlanTriangle triangle(corners);
                      if (triangle.covers(point)) {
                          highest = std::max(highest, triangle.height(point));
                      }
                  });
    if (highest != -kInfinity) return highest;
    return nearby_height(point);
}

double DrawnSurface::nearby_height(const glm::dvec2& point) const {
    double highest = -kInfinity;
    const PlanBox box = around(point, point);
    const auto enters = [&](const TriangleTree::Node& node) { return node.meets(box); };
    const auto visit = [&](const glm::vec3* corners) {
        if (!box.meets(corners)) return;
        const OutlinePoint nearest = nearest_on_outline(corners, point);
        if (nearest.distance <= plan_rounding(corners)) highest = std::max(highest, nearest.z);
    };
    surface_.each(enters, visit);
    slivers_.each(enters, visit);
    return highest;
}

bool DrawnSurface::anything_near(const glm::dvec2& low, const glm::dvec2& high) const {
    const PlanBox box = around(low, high);
    const auto enters = [&](const TriangleTree::Node& node) { return node.meets(box); };
    const auto found = [](const glm::vec3* /*corners*/) { return true; };
    return surface_.any(enters, found) || slivers_.any(enters, found);
}

PlanBox DrawnSurface::around(const glm::dvec2& low, const glm::dvec2& high) const {
    // Of no triangle more, and a little for the rounding of the distance itself.
    return {low, high, plan_rounding(kInfinity) * (1 + 0x1p-40)};
}

bool DrawnSurface::passes_below(const glm::dvec3& origin, const glm::dvec3& direction, double from,
                                double to) const {
    const std::optional<PlanRay> ray =
        PlanRay::over(low_, high_, origin - origin_, direction, from, to);
    if (!ray) return false;
    return surface_.any([&ray](const TriangleTree::Node& node) { return ray->reaches(node); },
                        [&ray](const glm::vec3* corners) {
                            return ray->reaches(corners) && ray->is_below(PlanTriangle(corners));
                        });
}

std::optional<double> DrawnSurface::meets_skirt(const glm::dvec3& origin,
                                                const glm::dvec3& direction, double from,
                                                double to) const {
    // Skirts may lean out of the extent.
    return least_meeting(skirts_, skirts_low_, skirts_high_, origin, direction, from, to);
}

std::optional<double> DrawnSurface::meets_surface(const glm::dvec3& origin,
                                                  const glm::dvec3& direction, double from,
                                                  double to) const {
    return least_meeting(surface_, low_, high_, origin, direction, from, to);
}

template <typename Visit>
bool DrawnSurface::any_beside(const glm::dvec3& start, const glm::dvec3& direction, double from,
                              double to, double radius, const Visit& visit) const {
    // In plan: the boxes that come within the radius of the segment, by their slabs.
    const glm::dvec2 a = glm::dvec2(start + from * direction);
    const glm::dvec2 b = glm::dvec2(start + to * direction);
    const double margin = radius * to * glm::length(direction);
    const auto comes_by = [&](const TriangleTree::Node& node, std::size_t i) {
        if (node.min_x[i] > node.max_x[i]) return false;  // no child
        double enter = 0;
        double leave = 1;
        for (int axis_index = 0; axis_index < 2; ++axis_index) {
            const double low = (axis_index == 0 ? node.min_x[i] : node.min_y[i]) - margin;
            const double high = (axis_index == 0 ? node.max_x[i] : node.max_y[i]) + margin;
            const double along = b[axis_index] - a[axis_index];
            if (along == 0) {
                if (a[axis_index] < low || a[axis_index] > high) return false;
                continue;
            }
            const double one = (low - a[axis_index]) / along;
            const double other = (high - a[axis_index]) / along;
            enter = std::max(enter, std::min(one, other));
            leave = std::min(leave, std::max(one, other));
        }
        return enter <= leave;
    };
    const auto enters = [&](const TriangleTree::Node& node) {
        unsigned mask = 0;
        for (std::size_t i = 0; i < TriangleTree::Node::kWidth; ++i) {
            mask |= unsigned(comes_by(node, i)) << i;
        }
        return mask;
    };
    return surface_.any(enters, visit);
}

DrawnSurface::Reach DrawnSurface::reach_beside(const glm::dvec3& origin,
                                               const glm::dvec3& direction, double from, double to,
                                               double radius, const glm::dvec3& forward) const {
    const glm::dvec3 start = origin - origin_;
    Reach reach;
    (void)any_beside(start, direction, from, to, radius, [&](const glm::vec3* corners) {
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 size = glm::abs(glm::dvec3(corners[i]));
            reach.largest = std::max({reach.largest, size.x, size.y, size.z});
            reach.nearest =
                std::min(reach.nearest, glm::dot(forward, glm::dvec3(corners[i]) - start));
        }
        return false;
    });
    return reach;
}

bool DrawnSurface::sliver_near(const glm::dvec3& origin, const glm::dvec3& direction, double from,
                               double to, double radius, double thickness) const {
    const glm::dvec3 start = origin - origin_;
    const glm::dvec3 axis = glm::normalize(direction);
    return any_beside(start, direction, from, to, radius, [&](const glm::vec3* corners) {
        // Projected to the plane at distance 1 along the ray.
        std::array<glm::dvec3, 3> seen;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3 corner = glm::dvec3(corners[i]) - start;
            const double distance = glm::dot(corner, axis);
            if (!(distance > 0)) return false;
            seen[i] = corner / distance;
        }
        double longest = 0;
        double nearest = kInfinity;
        for (std::size_t i = 0; i < 3; ++i) {
            longest = std::max(longest, glm::distance(seen[i], seen[(i + 1) % 3]));
            nearest = std::min(nearest, distance_to_segment(axis, seen[i], seen[(i + 1) % 3]));
        }
        const double area = glm::length(glm::cross(seen[1] - seen[0], seen[2] - seen[0]));
        return nearest <= radius && area < thickness * longest;
    });
}

std::optional<double> DrawnSurface::least_meeting(const TriangleTree& tree, const glm::dvec2& low,
                                                  const glm::dvec2& high, const glm::dvec3& origin,
                                                  const glm::dvec3& direction, double from,
                                                  double to) const {
    if (tree.triangle_count() == 0) return std::nullopt;
    const glm::dvec3 start = origin - origin_;
    const std::optional<PlanRay> ray = PlanRay::over(low, high, start, direction, from, to);
    if (!ray) return std::nullopt;
    double least = kInfinity;
    tree.each([&ray](const TriangleTree::Node& node) { return ray->reaches(node); },
              [&](const glm::vec3* corners) {
                  const double t = meeting(corners, start, direction);
                  if (t >= from && t <= to) least = std::min(least, t);
              });
    if (least == kInfinity) return std::nullopt;
    return least;
}

}  // namespace lodbench::measure
