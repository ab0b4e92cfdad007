#include "measure/triangle_tree.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/common.hpp>
#include <limits>
#include <span>
#include <utility>

#include "api/error.h"

namespace lodbench::measure {
namespace {

constexpr std::size_t kMaxTriangles = std::size_t(1) << 28U;
/// Four boxes are tested in the time of one or two triangles: small leaves pay.
constexpr std::size_t kLeafTriangles = 4;

/// Place on the curve in the upper half, the triangle's index in the lower: sorting is total.
using Key = std::uint64_t;

std::uint32_t place(Key key) {
    return std::uint32_t(key >> 32U);
}

/// A zero after each of 16 bits.
std::uint32_t spread(std::uint32_t bits) {
    bits = (bits | (bits << 8U)) & 0x00FF00FFU;
    bits = (bits | (bits << 4U)) & 0x0F0F0F0FU;
    bits = (bits | (bits << 2U)) & 0x33333333U;
    return (bits | (bits << 1U)) & 0x55555555U;
}

/// The middle of the part of the box that lies in [low, high], 16 bits an axis: what a triangle has
/// outside, however far, does not say where it will be asked for.
std::uint32_t curve_place(const glm::vec3* corners, const glm::dvec2& low, const glm::dvec2& high) {
    std::array<std::uint32_t, 2> cell{};
    for (int axis = 0; axis < 2; ++axis) {
        const auto [least, greatest] =
            std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
        const double middle = (std::clamp(double(least), low[axis], high[axis]) +
                               std::clamp(double(greatest), low[axis], high[axis])) /
                              2;
        const double part = (middle - low[axis]) / (high[axis] - low[axis]);
        cell[std::size_t(axis)] = std::uint32_t(std::clamp(part * 65536, 0.0, 65535.0));
    }
    return spread(cell[0]) | (spread(cell[1]) << 1U);
}

/// By place, stable: least significant digit first. Three times as fast as std::sort.
void sort_by_place(std::vector<Key>& keys) {
    constexpr unsigned kDigitBits = 11;
    constexpr std::size_t kDigits = std::size_t(1) << kDigitBits;
    std::vector<Key> sorted(keys.size());
    for (unsigned shift = 32; shift < 64; shift += kDigitBits) {
        std::array<std::size_t, kDigits> next{};
        const auto digit = [shift](Key key) { return (key >> shift) & (kDigits - 1); };
        for (const Key key : keys) ++next[digit(key)];
        std::size_t begin = 0;
        for (std::size_t& entry : next) begin += std::exchange(entry, begin);
        for (const Key key : keys) sorted[next[digit(key)]++] = key;
        keys.swap(sorted);
    }
}

/// Moves triangle index(keys[i]) to i for every i, in place: a second copy of 33 million triangles
/// would be 1.2 GB. Follows each cycle of the permutation once; leaves index(keys[i]) = i.
void permute(std::span<glm::vec3> vertices, std::span<Key> keys) {
    constexpr Key kIndex = 0xFFFFFFFFU;
    const auto triangle = [&vertices](std::size_t i) { return vertices.subspan(i * 3, 3); };
    for (std::size_t start = 0; start < keys.size(); ++start) {
        if ((keys[start] & kIndex) == start) continue;
        std::array<glm::vec3, 3> held{};
        std::ranges::copy(triangle(start), held.begin());
        std::size_t to = start;
        while (true) {
            const std::size_t source = keys[to] & kIndex;
            keys[to] = (keys[to] & ~kIndex) | to;
            if (source == start) break;
            std::ranges::copy(triangle(source), triangle(to).begin());
            to = source;
        }
        std::ranges::copy(held, triangle(to).begin());
    }
}

struct Box {
    glm::vec2 min{std::numeric_limits<float>::infinity()};
    glm::vec2 max{-std::numeric_limits<float>::infinity()};
    float max_z = -std::numeric_limits<float>::infinity();
};

}  // namespace

class TriangleTree::Builder {
public:
    Builder(std::span<const glm::vec3> vertices, std::span<const Key> keys,
            std::vector<Node>& nodes)
        : vertices_(vertices), keys_(keys), nodes_(nodes) {}

    /// Appends the node over triangles [begin, end) and all below it.
    Box add(std::size_t begin, std::size_t end) {
        std::array<std::size_t, Node::kWidth + 1> borders{begin, end};
        std::size_t part_count = 1;
        while (part_count < Node::kWidth) {
            std::size_t largest = 0;
            for (std::size_t i = 1; i < part_count; ++i) {
                if (borders[i + 1] - borders[i] > borders[largest + 1] - borders[largest]) {
                    largest = i;
                }
            }
            if (borders[largest + 1] - borders[largest] <= kLeafTriangles) break;
            const std::size_t border = split(borders[largest], borders[largest + 1]);
            std::copy_backward(borders.begin() + std::ptrdiff_t(largest) + 1,
                               borders.begin() + std::ptrdiff_t(part_count) + 1,
                               borders.begin() + std::ptrdiff_t(part_count) + 2);
            borders[largest + 1] = border;
            ++part_count;
        }
        const std::size_t index = nodes_.size();
        nodes_.emplace_back();
        Box whole;
        for (std::size_t i = 0; i < Node::kWidth; ++i) {
            Box box;
            Node::Child child{0, 0};
            if (i < part_count) {
                const std::size_t count = borders[i + 1] - borders[i];
                const bool leaf = count <= kLeafTriangles;
                child.first =
                    std::uint32_t(leaf ? borders[i] : nodes_.size()) & (kMaxTriangles - 1);
                child.triangle_count = leaf ? count & 0xFU : 0U;
                box = leaf ? bounds(borders[i], borders[i + 1]) : add(borders[i], borders[i + 1]);
            }
            Node& node = nodes_[index];
            node.min_x[i] = box.min.x;
            node.min_y[i] = box.min.y;
            node.max_x[i] = box.max.x;
            node.max_y[i] = box.max.y;
            node.max_z[i] = box.max_z;
            node.children[i] = child;
            whole.min = glm::min(whole.min, box.min);
            whole.max = glm::max(whole.max, box.max);
            whole.max_z = std::max(whole.max_z, box.max_z);
        }
        return whole;
    }

private:
    /// First triangle of the second part: where the highest bit that differs turns 1, or the middle
    /// of triangles that are all in one place.
    [[nodiscard]] std::size_t split(std::size_t begin, std::size_t end) const {
        const std::uint32_t different = place(keys_[begin]) ^ place(keys_[end - 1]);
        if (different == 0) return begin + (end - begin) / 2;
        const std::uint32_t bit = std::bit_floor(different);
        const auto keys = keys_.subspan(begin, end - begin);
        const auto found =
            std::ranges::partition_point(keys, [bit](Key key) { return (place(key) & bit) == 0; });
        return begin + std::size_t(found - keys.begin());
    }

    [[nodiscard]] Box bounds(std::size_t begin, std::size_t end) const {
        Box box;
        for (const glm::vec3& vertex : vertices_.subspan(begin * 3, (end - begin) * 3)) {
            box.min = glm::min(box.min, glm::vec2(vertex));
            box.max = glm::max(box.max, glm::vec2(vertex));
            box.max_z = std::max(box.max_z, vertex.z);
        }
        return box;
    }

    std::span<const glm::vec3> vertices_;
    std::span<const Key> keys_;
    std::vector<Node>& nodes_;
};

TriangleTree::TriangleTree(std::vector<glm::vec3>&& vertices, const glm::dvec2& low,
                           const glm::dvec2& high)
    : vertices_(std::move(vertices)) {
    const std::size_t count = triangle_count();
    if (count == 0) return;
    if (count > kMaxTriangles) {
        throw EnvironmentError(
            fmt::format("a captured surface of {} triangles: at most {} can be measured", count,
                        kMaxTriangles));
    }
    std::vector<Key> keys(count);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096),
                      [&](const tbb::blocked_range<std::size_t>& part) {
                          for (std::size_t i = part.begin(); i < part.end(); ++i) {
                              keys[i] = (Key(curve_place(&vertices_[i * 3], low, high)) << 32U) | i;
                          }
                      });
    sort_by_place(keys);
    permute(vertices_, keys);
    Builder(vertices_, keys, nodes_).add(0, count);
    nodes_.shrink_to_fit();
}

std::vector<glm::vec3> TriangleTree::release() {
    nodes_.clear();
    return std::exchange(vertices_, {});
}

}  // namespace lodbench::measure
