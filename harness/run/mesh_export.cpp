#include "run/mesh_export.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <glm/mat4x4.hpp>
#include <limits>
#include <unordered_map>

#include "api/error.h"
#include "base/hash.h"

namespace lodbench::run {

namespace {

static_assert(std::endian::native == std::endian::little,
              "the PLY is written as it lies in memory");

using Bits = std::array<std::uint64_t, 3>;

struct HashBits {
    std::size_t operator()(const Bits& bits) const {
        std::uint64_t hash = 0;
        for (const std::uint64_t word : bits) {
            // Grid coordinates differ in few bits, which must reach all of the hash.
            hash = base::mix64(hash + word);
        }
        return std::size_t(hash);
    }
};

/// `key(i)` is the position by which vertex i is told from others, `world(i)` where it lies. A
/// float widens to a double one to one, so that equal floats have equal keys and no others.
template <typename Key, typename World>
Mesh weld_by(std::size_t count, const Key& key, const World& world) {
    Mesh mesh;
    mesh.triangles.resize(count / 3);
    std::unordered_map<Bits, std::uint32_t, HashBits> numbers;
    numbers.reserve(count / 4);
    for (std::size_t i = 0; i < mesh.triangles.size() * 3; ++i) {
        const glm::dvec3 position = key(i) + 0.0;  // -0 becomes 0
        const auto [entry, is_new] =
            numbers.try_emplace(std::bit_cast<Bits>(position), std::uint32_t(mesh.vertices.size()));
        if (is_new) mesh.vertices.push_back(world(i));
        mesh.triangles[i / 3][i % 3] = entry->second;
    }
    return mesh;
}

/// A comment is one line: what a plugin or a file put into a text must not end the header.
std::string one_line(std::string text) {
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    }
    return text;
}

std::string rows_of(const glm::dmat4& matrix) {
    std::string text;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            text += fmt::format("{}{:.17g}", text.empty() ? "" : " ", matrix[column][row]);
        }
    }
    return text;
}

/// Camera from world, world positions included: in double, for whoever reads the file.
glm::dmat4 view_matrix(const Camera& camera) {
    const glm::dmat4 rotation = glm::mat4_cast(glm::conjugate(camera.orientation));
    glm::dmat4 view = rotation;
    view[3] = glm::dvec4(-(glm::dmat3(rotation) * camera.position), 1.0);
    return view;
}

std::string header(const Mesh& mesh, const MeshContext& context) {
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    const auto add = [&](const char* name, const std::string& value) {
        text += fmt::format("comment {} {}\n", name, one_line(value));
    };
    const TerrainInfo& terrain = context.terrain;
    const Camera& camera = context.camera;
    const glm::dquat& q = camera.orientation;
    add("lodbench", context.lodbench_version);
    add("method", context.method);
    add("method_version", context.method_version);
    for (const auto& [name, value] : context.params) add("param", name + " " + value);
    add("scenario", context.scenario);
    add("terrain", terrain.name);
    add("checksum", terrain.checksum);
    add("rows", fmt::format("{}", terrain.rows));
    add("columns", fmt::format("{}", terrain.columns));
    add("spacing_m", fmt::format("{:.17g} {:.17g}", terrain.spacing.x, terrain.spacing.y));
    add("origin_m", fmt::format("{:.17g} {:.17g}", terrain.origin.x, terrain.origin.y));
    add("frame", fmt::format("{}", context.frame));
    add("camera_position_m", fmt::format("{:.17g} {:.17g} {:.17g}", camera.position.x,
                                         camera.position.y, camera.position.z));
    add("camera_orientation_wxyz",
        fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}", q.w, q.x, q.y, q.z));
    add("vertical_fov_rad", fmt::format("{:.17g}", camera.vertical_fov));
    add("near_plane_m", fmt::format("{:.17g}", camera.near_plane));
    add("viewport_px", fmt::format("{} {}", camera.viewport.width, camera.viewport.height));
    add("view_matrix_rows", rows_of(view_matrix(camera)));
    add("projection_matrix_rows", rows_of(camera.projection()));
    add("clipped", context.clipped ? "1" : "0");
    text += fmt::format(
        "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.vertices.size(), mesh.triangles.size());
    return text;
}

}  // namespace

Mesh weld(const measure::CapturedSurface& surface) {
    return weld_by(
        surface.vertices.size(), [&](std::size_t i) { return glm::dvec3(surface.vertices[i]); },
        [&](std::size_t i) { return surface.world(i); });
}

Mesh weld(std::span<const glm::dvec3> triangles) {
    const auto position = [&](std::size_t i) { return triangles[i]; };
    return weld_by(triangles.size(), position, position);
}

std::uint64_t not_finite_count(const measure::CapturedSurface& surface) {
    std::uint64_t count = 0;
    for (const glm::vec3& v : surface.vertices) {
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) ++count;
    }
    return count;
}

std::string ply(const Mesh& mesh, const MeshContext& context) {
    constexpr std::size_t kMostVertices = std::size_t(std::numeric_limits<std::int32_t>::max());
    if (mesh.vertices.size() > kMostVertices) {
        throw InputError(
            fmt::format("the mesh has {} vertices, a PLY's int indices reach {}; "
                        "choose a coarser setting with --set",
                        mesh.vertices.size(), kMostVertices));
    }
    constexpr std::size_t kVertexBytes = 3 * sizeof(double);
    constexpr std::size_t kIndexBytes = 3 * sizeof(std::uint32_t);
    std::string text = header(mesh, context);
    std::size_t at = text.size();
    text.resize(at + mesh.vertices.size() * kVertexBytes +
                mesh.triangles.size() * (1 + kIndexBytes));
    static_assert(sizeof(glm::dvec3) == kVertexBytes);
    if (!mesh.vertices.empty()) {
        std::memcpy(&text[at], mesh.vertices.data(), mesh.vertices.size() * kVertexBytes);
    }
    at += mesh.vertices.size() * kVertexBytes;
    for (const auto& triangle : mesh.triangles) {
        text[at] = 3;
        std::memcpy(&text[at + 1], triangle.data(), kIndexBytes);
        at += 1 + kIndexBytes;
    }
    return text;
}

}  // namespace lodbench::run
