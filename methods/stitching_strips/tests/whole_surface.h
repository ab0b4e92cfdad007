#pragma once
// A captured surface without holes and overlaps, off the grid: vertices meet to the bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "support/method_fixture.h"

namespace lodbench::test {

/// Of a surface: each vertex once, and the triangles of three different ones.
class IndexedSurface {
public:
    explicit IndexedSurface(const measure::CapturedSurface& surface) {
        std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, Hash> numbers;
        for (std::size_t i = 0; i < surface.vertices.size(); i += 3) {
            std::array<std::uint32_t, 3> triangle{};
            for (std::size_t corner = 0; corner < 3; ++corner) {
                // Adding 0 makes one zero of the two.
                const glm::vec3 at = surface.vertices[i + corner] + glm::vec3(0);
                const auto [found, added] = numbers.try_emplace(
                    {std::bit_cast<std::uint32_t>(at.x), std::bit_cast<std::uint32_t>(at.y),
                     std::bit_cast<std::uint32_t>(at.z)},
                    std::uint32_t(vertices_.size()));
                if (added) vertices_.emplace_back(at);
                triangle[corner] = found->second;
            }
            if (triangle[0] != triangle[1] && triangle[1] != triangle[2] &&
                triangle[2] != triangle[0]) {
                triangles_.push_back(triangle);
            }
        }
    }

    [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }

    /// What is wrong with a surface that fills a rectangle; nothing where all triangles look
    /// upward, meet along whole edges, and fill it once.
    [[nodiscard]] std::string faults() const {
        glm::dvec2 low(std::numeric_limits<double>::max()), high(-low);
        for (const glm::dvec3& vertex : vertices_) {
            low = glm::min(low, glm::dvec2(vertex));
            high = glm::max(high, glm::dvec2(vertex));
        }
        std::vector<std::uint64_t> directed;
        directed.reserve(3 * triangles_.size());
        double area = 0;
        std::size_t downward = 0;
        for (const auto& triangle : triangles_) {
            const double twice = twice_area(triangle);
            if (twice <= 0) ++downward;
            area += twice / 2;
            for (std::size_t side = 0; side < 3; ++side) {
                directed.push_back(key(triangle[side], triangle[(side + 1) % 3]));
            }
        }
        std::ranges::sort(directed);
        std::size_t repeated = 0, open = 0;
        for (std::size_t i = 0; i < directed.size(); ++i) {
            if (i > 0 && directed[i] == directed[i - 1]) ++repeated;
            const auto from = std::uint32_t(directed[i] >> 32U), to = std::uint32_t(directed[i]);
            if (!std::ranges::binary_search(directed, key(to, from)) &&
                !on_border(from, to, low, high)) {
                ++open;
            }
        }
        std::string words;
        const auto say = [&](const std::string& what) { words += what + "; "; };
        if (triangles_.empty()) say("no triangles");
        if (downward > 0) say(std::to_string(downward) + " triangles have no area or look down");
        if (repeated > 0) say(std::to_string(repeated) + " edges are used twice in one direction");
        if (open > 0) say(std::to_string(open) + " inner edges are used once");
        const double whole = (high.x - low.x) * (high.y - low.y);
        // Sums of floats' products: far below one triangle's area.
        if (std::abs(area - whole) > 1e-9 * whole) {
            say("the areas add up to " + std::to_string(area / whole) + " of the rectangle");
        }
        return words;
    }

    /// By place, whatever their order.
    [[nodiscard]] std::vector<std::array<std::array<float, 3>, 3>> sorted_triangles() const {
        std::vector<std::array<std::array<float, 3>, 3>> all;
        for (const auto& triangle : triangles_) {
            auto& corners = all.emplace_back();
            for (std::size_t i = 0; i < 3; ++i) {
                const glm::vec3 at(vertices_[triangle[i]]);
                corners[i] = {at.x, at.y, at.z};
            }
            std::ranges::rotate(corners, std::ranges::min_element(corners));
        }
        std::ranges::sort(all);
        return all;
    }

private:
    struct Hash {
        std::size_t operator()(const std::array<std::uint32_t, 3>& bits) const {
            std::size_t mixed = 0;
            for (const std::uint32_t word : bits) {
                mixed = (mixed ^ word) * 0x9E3779B97F4A7C15U;
                mixed ^= mixed >> 29U;
            }
            return mixed;
        }
    };
    static std::uint64_t key(std::uint32_t from, std::uint32_t to) {
        return std::uint64_t(from) << 32U | to;
    }
    [[nodiscard]] double twice_area(const std::array<std::uint32_t, 3>& triangle) const {
        const glm::dvec3 &a = vertices_[triangle[0]], &b = vertices_[triangle[1]],
                         &c = vertices_[triangle[2]];
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    }
    [[nodiscard]] bool on_border(std::uint32_t from, std::uint32_t to, const glm::dvec2& low,
                                 const glm::dvec2& high) const {
        const glm::dvec3 &a = vertices_[from], &b = vertices_[to];
        const auto along = [](double one, double other, double side) {
            return one == side && other == side;
        };
        return along(a.x, b.x, low.x) || along(a.x, b.x, high.x) || along(a.y, b.y, low.y) ||
               along(a.y, b.y, high.y);
    }

    std::vector<glm::dvec3> vertices_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
};

/// Above, beside and low over a terrain, looking anywhere.
inline Camera random_camera_over(const TerrainInfo& info, std::mt19937& random) {
    const auto pick = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    const double reach = std::max(size.x, size.y);
    const glm::dvec2 place =
        info.extent_min() + size * glm::dvec2(pick(-0.2, 1.2), pick(-0.2, 1.2));
    const double height = info.max_height + reach * std::exp2(pick(-12, 0));
    Camera camera =
        camera_at({place, height}, pick(0, 360), pick(-90, 10), pick(-20, 20), pick(30, 90));
    camera.viewport = {1280, 960};  // the paper's
    return camera;
}

}  // namespace lodbench::test
