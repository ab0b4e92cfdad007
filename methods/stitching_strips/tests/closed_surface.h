#pragma once
// No crack and no overlap, of a surface whose vertices need not be samples: judged by which
// triangles share which edges, to the bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <unordered_map>
#include <vector>

#include "support/method_fixture.h"

namespace lodbench::test {

struct VertexHash {
    std::size_t operator()(const glm::vec3& vertex) const {
        std::array<std::uint32_t, 3> bits{};
        std::memcpy(bits.data(), &vertex, sizeof bits);
        std::size_t hash = 0;
        for (const std::uint32_t word : bits) hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
        return hash ^ hash >> 29U;
    }
};

/// Adds failures for what is not a surface over one rectangle that holds the terrain: an edge
/// within it that not exactly two triangles share, one from each side; a triangle that is turned
/// over; more or less area in plan than the rectangle's.
class ClosedSurface {
public:
    explicit ClosedSurface(const measure::CapturedSurface& surface) : surface_(surface) {
        for (const glm::vec3& vertex : surface.vertices) {
            low_ = glm::min(low_, glm::vec2(vertex));
            high_ = glm::max(high_, glm::vec2(vertex));
        }
        number_vertices();
    }

    void expect_closed(const TerrainInfo& terrain, const std::string& where) {
        const float reach = std::max({-low_.x, -low_.y, high_.x, high_.y});
        const float rounding = 8.0F * std::ldexp(reach, -24);
        for (int axis = 0; axis < 2; ++axis) {
            const double eye = surface_.origin[axis];
            EXPECT_LE(low_[axis], terrain.extent_min()[axis] - eye + rounding) << where;
            EXPECT_GE(high_[axis], terrain.extent_max()[axis] - eye - rounding) << where;
        }
        const glm::dvec2 size = glm::dvec2(high_) - glm::dvec2(low_);
        const double area = add_triangles(rounding * std::max(size.x, size.y), where);
        EXPECT_NEAR(area, size.x * size.y, 4 * rounding * (size.x + size.y)) << where;
        expect_edges_shared(where);
    }

private:
    using Edge =
        std::uint64_t;  ///< numbers of both vertices, in the order in which a triangle has them
    [[nodiscard]] static Edge edge(std::uint32_t from, std::uint32_t to) {
        return Edge(from) << 32U | to;
    }

    void number_vertices() {
        std::unordered_map<glm::vec3, std::uint32_t, VertexHash> numbers;
        numbers.reserve(surface_.vertices.size() / 3);
        for (glm::vec3 vertex : surface_.vertices) {
            vertex += 0.0F;  // one zero
            numbers_.push_back(
                numbers.try_emplace(vertex, std::uint32_t(numbers.size())).first->second);
        }
        places_.resize(numbers.size());
        for (const auto& [place, number] : numbers) places_[number] = place;
    }

    /// Twice the rounding of a coordinate over a triangle's length is what an area may be wrong by.
    double add_triangles(double slack, const std::string& where) {
        double sum = 0;
        int turned = 0;
        for (std::size_t i = 0; i < numbers_.size(); i += 3) {
            const std::array corners = {numbers_[i], numbers_[i + 1], numbers_[i + 2]};
            if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
                continue;  // where a segment begins to grow
            }
            const glm::dvec2 a(places_[corners[0]]), b(places_[corners[1]]), c(places_[corners[2]]);
            const double area = 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
            turned += area < -slack;
            sum += area;
            for (int corner = 0; corner < 3; ++corner) {
                edges_.push_back(
                    edge(corners[std::size_t(corner)], corners[std::size_t(corner + 1) % 3]));
            }
        }
        EXPECT_EQ(turned, 0) << where;
        return sum;
    }

    void expect_edges_shared(const std::string& where) {
        std::ranges::sort(edges_);
        EXPECT_TRUE(std::ranges::adjacent_find(edges_) == edges_.end())
            << where << ": an edge is used twice from the same side";
        int single = 0;
        glm::vec3 first(0.0F);
        for (const Edge& used : edges_) {
            const auto from = std::uint32_t(used >> 32U), to = std::uint32_t(used);
            if (on_border(from, to) || std::ranges::binary_search(edges_, edge(to, from))) continue;
            if (single++ == 0) first = places_[from];
        }
        EXPECT_EQ(single, 0) << where << ": edges used once, the first at " << first.x << ", "
                             << first.y << " from the eye";
    }
    [[nodiscard]] bool on_border(std::uint32_t from, std::uint32_t to) const {
        for (int axis = 0; axis < 2; ++axis) {
            for (const float border : {low_[axis], high_[axis]}) {
                if (places_[from][axis] == border && places_[to][axis] == border) return true;
            }
        }
        return false;
    }

    const measure::CapturedSurface& surface_;
    glm::vec2 low_{INFINITY}, high_{-INFINITY};
    std::vector<std::uint32_t> numbers_;  ///< of the surface's vertices, those alike being one
    std::vector<glm::vec3> places_;       ///< by number
    std::vector<Edge> edges_;
};

struct ClosedCase {
    const char* ground;  ///< "puget" or a form of synthetic terrain
    int rows, columns;
    std::vector<std::pair<std::string, std::string>> settings;
};

inline std::shared_ptr<const terrain::HeightField> ground_of(const ClosedCase& one) {
    if (std::string(one.ground) == "puget") return puget_sound();
    terrain::TerrainSource source;
    source.synthetic = one.ground;
    source.rows = one.rows;
    source.columns = one.columns;
    source.spacing_x = 10;
    source.spacing_y = 12.5;
    return terrain::load_terrain(source);
}

/// Random cameras over and beside the ground, each at a tolerance of 0.5 to 8 pixels.
inline void expect_closed_from_everywhere(const std::string& method, const ClosedCase& one,
                                          int cameras, unsigned seed) {
    const auto terrain = ground_of(one);
    const TerrainInfo& info = terrain->info();
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    constexpr int kCamerasOfATolerance = 5;
    for (int i = 0; i < cameras; i += kCamerasOfATolerance) {
        const double tau = 0.5 * std::pow(2.0, between(0, 4));
        auto settings = one.settings;
        settings.emplace_back("tau", std::to_string(tau));
        settings.emplace_back("culling", "false");
        Flight flight(terrain, "stitching_strips", method, settings);
        for (int j = i; j < std::min(i + kCamerasOfATolerance, cameras); ++j) {
            const glm::dvec2 place =
                info.extent_min() + size * glm::dvec2(between(-0.2, 1.2), between(-0.2, 1.2));
            const double height =
                info.max_height + std::max(size.x, size.y) * std::pow(10.0, between(-3, 0));
            Camera camera = camera_at({place, height}, between(0, 360), between(-90, 0));
            camera.viewport = {640, 480};
            const measure::CapturedSurface surface = flight.surface(camera);
            ClosedSurface(surface).expect_closed(info, method + " over " + one.ground +
                                                           ", camera " + std::to_string(j) +
                                                           ", tau " + std::to_string(tau));
            if (testing::Test::HasFailure()) return;
        }
    }
}

}  // namespace lodbench::test
