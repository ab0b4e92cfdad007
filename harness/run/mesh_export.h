#pragma once
// The triangles that a method really drew, as a file that any other tool can check.

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/camera.h"
#include "api/terrain.h"
#include "measure/capture.h"

namespace lodbench::run {

/// Triangles that share vertices; world coordinates in metres.
struct Mesh {
    std::vector<glm::dvec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Makes one vertex of positions that are equal to the bit as they were captured (floats relative
/// to the eye), so that vertices that the rasteriser sees as shared are shared, and no others. The
/// two zeros are one position. Degenerate triangles are kept.
[[nodiscard]] Mesh weld(const measure::CapturedSurface& surface);
/// The same for triangles in world coordinates, three vertices each (see
/// measure::clipped_triangles).
[[nodiscard]] Mesh weld(std::span<const glm::dvec3> triangles);

/// Number of captured vertices with a coordinate that is not finite.
[[nodiscard]] std::uint64_t not_finite_count(const measure::CapturedSurface& surface);

/// What the header's comments say, so that the mesh can be judged without lodbench.
struct MeshContext {
    std::string lodbench_version, method, method_version, scenario;
    std::vector<std::pair<std::string, std::string>> params;
    TerrainInfo terrain;
    int frame = 0;
    Camera camera;
    bool clipped =
        true;  ///< to the terrain's extent; false: as sent, degenerate triangles included
};

/// Binary little-endian PLY: vertices as double x, y, z, faces as lists (uchar count, int indices).
/// The comments hold one field a line, "comment NAME VALUE...", numbers with 17 digits, matrices
/// row by row: lodbench, method, method_version, param (one line each), scenario, terrain,
/// checksum, rows, columns, spacing_m, origin_m, frame, camera_position_m, camera_orientation_wxyz,
/// vertical_fov_rad, near_plane_m, viewport_px, view_matrix_rows (camera from world),
/// projection_matrix_rows (clip from camera: reversed depth, zero to one, no far plane), clipped.
/// Throws InputError for more vertices than an int counts.
[[nodiscard]] std::string ply(const Mesh& mesh, const MeshContext& context);

}  // namespace lodbench::run
