#!/usr/bin/env python3
"""Checks a mesh that `lodbench mesh` wrote, sharing no code with lodbench (numpy only).

check_mesh.py MESH.ply [--watertight] [--covers-terrain] [--same-surface FULL_GRID.ply [--within METRES]]
              [--shares-vertices BORDER_EDGES] [--max-triangles N]

Always: the header is complete, every number is finite, every index is in range, and the camera's fields
agree with its matrices: a vertex projected through the matrices lands on the pixel that the position, the
orientation and the field of view give.

--watertight        no edge is used once but on the border of the mesh's (padded) square, none more than
                    twice; neighbours are oriented alike; no vertex lies inside an edge (T-junction); the
                    faces' areas add up to the border's rectangle, so nothing is missing or drawn twice.
                    Needs a mesh --before-clipping whose vertices are grid samples; degenerate faces are
                    left out.
--covers-terrain    the mesh's rectangle contains the terrain's extent.
--same-surface F    at each sample of the terrain the mesh has F's height, to float rounding and --within.
--shares-vertices N for meshes off the grid: no edge is used twice in one direction, and exactly N are used
                    once. N is what the method's grid has on its border; a seam where neighbours do not
                    share their vertices to the bit adds two for each of its edges.
Prints one line; exit status 0 when all holds, 1 with the reasons otherwise.
"""
import argparse
import math
import sys

import numpy as np


class Broken(Exception):
    """A promise that the mesh does not keep, in words."""


def require(condition, text):
    if not condition:
        raise Broken(text)


class Mesh:
    """The file's vertices (n x 3 float64), faces (m x 3), and its comments by first word."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        end = data.find(b"end_header\n")
        require(data.startswith(b"ply\n") and end > 0, "not a PLY file")
        lines = data[:end].decode("utf-8").splitlines()
        require("format binary_little_endian 1.0" in lines, "not binary little-endian")
        self.fields = {}
        counts = {}
        for line in lines:
            words = line.split(" ", 2)
            if words[0] == "comment" and len(words) == 3:
                self.fields.setdefault(words[1], []).append(words[2])
            if words[0] == "element":
                counts[words[1]] = int(words[2])
        body = data[end + len(b"end_header\n"):]
        face_type = np.dtype([("count", "u1"), ("index", "<i4", (3,))])
        expected = counts["vertex"] * 24 + counts["face"] * face_type.itemsize
        require(len(body) == expected, f"body has {len(body)} bytes, the header implies {expected}")
        self.vertices = np.frombuffer(body, "<f8", counts["vertex"] * 3).reshape(-1, 3)
        faces = np.frombuffer(body, face_type, counts["face"], counts["vertex"] * 24)
        require((faces["count"] == 3).all(), "a face is not a triangle")
        self.faces = faces["index"].astype(np.int64)
        require(np.isfinite(self.vertices).all(), "a vertex is not finite")
        if len(self.faces):
            require(self.faces.min() >= 0 and self.faces.max() < len(self.vertices),
                    "a face names a vertex that is not there")

    def numbers(self, name, count):
        require(name in self.fields, f"the header has no comment '{name}'")
        values = np.array([float(word) for word in self.fields[name][0].split()])
        require(len(values) == count, f"comment '{name}' has {len(values)} numbers, not {count}")
        require(np.isfinite(values).all(), f"comment '{name}' is not finite")
        return values

    def solid_faces(self):
        """Faces with three different vertices: strips repeat vertices on purpose."""
        a, b, c = self.faces.T
        return self.faces[(a != b) & (b != c) & (c != a)]

    def rounding(self):
        """How far a stored coordinate may lie from what was meant: positions are floats relative to the
        eye after a few roundings (difference of samples, offset, matrix), each 2^-24 of the distance."""
        reach = np.abs(self.vertices - self.numbers("camera_position_m", 3)).max(initial=1.0)
        return 8 * 2.0**-24 * reach

    def grid(self):
        """Column and row (counted from the south) of each vertex, as integers."""
        spacing = self.numbers("spacing_m", 2)
        exact = (self.vertices[:, :2] - self.numbers("origin_m", 2)) / spacing
        nearest = np.rint(exact)
        off = np.abs(exact - nearest).max(initial=0.0)
        require(off <= max(self.rounding() / spacing.min(), 1e-9),
                f"a vertex lies {off:.3g} cells beside its sample")
        return nearest.astype(np.int64)


def check_camera(mesh):
    """Two independent ways to a pixel: the matrices, and the angles."""
    position = mesh.numbers("camera_position_m", 3)
    w, x, y, z = mesh.numbers("camera_orientation_wxyz", 4)
    fov = mesh.numbers("vertical_fov_rad", 1)[0]
    near = mesh.numbers("near_plane_m", 1)[0]
    width, height = mesh.numbers("viewport_px", 2)
    view = mesh.numbers("view_matrix_rows", 16).reshape(4, 4)
    projection = mesh.numbers("projection_matrix_rows", 16).reshape(4, 4)
    require(abs(w * w + x * x + y * y + z * z - 1) < 1e-9, "the orientation is not a unit quaternion")
    axes = np.array([  # columns: the camera's right, up and backward in the world
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
    if not len(mesh.vertices):
        return "no vertex to project"
    relative = mesh.vertices - position
    sideways, upward, depth = relative @ axes[:, 0], relative @ axes[:, 1], -(relative @ axes[:, 2])
    # The vertex best inside the picture, away from its centre so that a wrong scale shows.
    steep = np.maximum(np.abs(sideways), np.abs(upward)) / np.maximum(depth, 1e-300)
    visible = depth > near
    if not visible.any():
        return "no vertex in front of the camera"
    chosen = int(np.argmin(np.where(visible, np.abs(steep - 0.3), np.inf)))
    pixels_per_tangent = height / (2 * math.tan(fov / 2))
    by_angles = np.array([width / 2 + pixels_per_tangent * sideways[chosen] / depth[chosen],
                          height / 2 - pixels_per_tangent * upward[chosen] / depth[chosen]])
    clip = projection @ (view @ np.append(mesh.vertices[chosen], 1.0))
    by_matrices = np.array([(clip[0] / clip[3] + 1) / 2 * width, (1 - clip[1] / clip[3]) / 2 * height])
    # The view matrix subtracts world coordinates: their magnitude times 2^-52 is lost, seen from `depth`.
    scale = np.abs(position).max() + np.abs(mesh.vertices[chosen]).max()
    allowed = 1e-6 + 64 * 2.0**-52 * scale / depth[chosen] * pixels_per_tangent
    distance = float(np.abs(by_angles - by_matrices).max())
    require(distance <= allowed, f"vertex {chosen} projects to {by_matrices} by the matrices and to "
                                 f"{by_angles} by the angles")
    require(abs(clip[2] / clip[3] - near / depth[chosen]) < 1e-9, "the depth is not near / distance")
    return f"vertex {chosen} at pixel {by_matrices[0]:.3f} {by_matrices[1]:.3f}"


def edges_of(faces):
    """Directed edges of the faces, then for each undirected one (low, high): uses forth and back."""
    directed = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    low, high = directed.min(axis=1), directed.max(axis=1)
    # One number an edge: np.unique of pairs takes many times as long.
    count = int(faces.max()) + 1 if len(faces) else 1
    keys, inverse = np.unique(low * count + high, return_inverse=True)
    inverse = inverse.reshape(-1)
    unique = np.stack([keys // count, keys % count], axis=1)
    forth = np.bincount(inverse, directed[:, 0] == low, len(unique)).astype(np.int64)
    return unique, forth, np.bincount(inverse, minlength=len(unique)) - forth


def check_watertight(mesh):
    faces = mesh.solid_faces()
    require(len(faces) > 0, "no triangle with an area")
    grid = mesh.grid()
    used = np.unique(faces)
    places, how_often = np.unique(grid[used], axis=0, return_counts=True)
    require((how_often == 1).all(),
            f"{int((how_often > 1).sum())} samples have two different positions, first at column, row "
            f"{places[np.argmax(how_often > 1)] if len(places) else ''}")
    corner = grid[faces]
    a, b, c = corner[:, 0], corner[:, 1], corner[:, 2]
    twice = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    require((twice > 0).all() or (twice < 0).all(),
            f"{min(int((twice > 0).sum()), int((twice <= 0).sum()))} triangles are turned over or flat")
    low, high = grid[used].min(axis=0), grid[used].max(axis=0)
    edges, forth, back = edges_of(faces)
    require((forth <= 1).all() and (back <= 1).all(),
            f"{int(((forth > 1) | (back > 1)).sum())} edges are used twice in one direction")
    ends = grid[edges]
    on_border = np.zeros(len(edges), bool)
    for axis in (0, 1):
        for side in (low, high):
            on_border |= (ends[:, :, axis] == side[axis]).all(axis=1)
    once = (forth + back) == 1
    bad = once & ~on_border
    require(not bad.any(), f"{int(bad.sum())} inner edges are used once, first from column, row "
                           f"{ends[np.argmax(bad)].tolist()}")
    # T-junctions: a sample of the mesh inside an edge.
    size = high - low + 1
    taken = np.zeros(size[::-1], bool)
    taken[grid[used][:, 1] - low[1], grid[used][:, 0] - low[0]] = True
    step = ends[:, 1] - ends[:, 0]
    parts = np.gcd(np.abs(step[:, 0]), np.abs(step[:, 1]))
    for i in range(1, int(parts.max())):
        longer = parts > i
        inside = ends[longer, 0] + step[longer] // parts[longer, None] * i - low
        hit = taken[inside[:, 1], inside[:, 0]]
        require(not hit.any(), f"{int(hit.sum())} T-junctions, first at column, row "
                               f"{(inside[np.argmax(hit)] + low).tolist()}")
    area = int(np.abs(twice).sum())
    require(area == 2 * int((high - low).prod()),
            f"the triangles cover {area / 2} cells of {int((high - low).prod())}")
    return f"{len(faces)} triangles watertight over {size[0]} x {size[1]} samples"


def check_covers(mesh):
    grid = mesh.grid()[np.unique(mesh.solid_faces())]
    rows, columns = (int(mesh.numbers(name, 1)[0]) for name in ("rows", "columns"))
    low, high = grid.min(axis=0), grid.max(axis=0)
    require((low <= 0).all() and high[0] >= columns - 1 and high[1] >= rows - 1,
            f"the mesh spans {low.tolist()} to {high.tolist()}, the terrain has {columns} x {rows} samples")
    return "terrain covered"


def heights_at_samples(mesh):
    """The surface at each sample of the terrain, NaN where no triangle covers it."""
    rows, columns = (int(mesh.numbers(name, 1)[0]) for name in ("rows", "columns"))
    faces = mesh.solid_faces()
    corner = mesh.grid()[faces]
    z = mesh.vertices[:, 2][faces]
    surface = np.full((rows, columns), np.nan)
    shapes, which = np.unique((corner[:, 1:] - corner[:, :1]).reshape(-1, 4), axis=0, return_inverse=True)
    which = which.reshape(-1)
    for number, (bx, by, cx, cy) in enumerate(shapes):
        twice = bx * cy - by * cx
        if twice == 0:
            continue
        members = np.nonzero(which == number)[0]
        xs = np.arange(min(0, bx, cx), max(0, bx, cx) + 1)
        ys = np.arange(min(0, by, cy), max(0, by, cy) + 1)
        px, py = (axis.reshape(-1) for axis in np.meshgrid(xs, ys))
        v, w = (px * cy - py * cx) / twice, (bx * py - by * px) / twice
        for x, y, weight_b, weight_c in zip(px, py, v, w):
            if weight_b < 0 or weight_c < 0 or weight_b + weight_c > 1 + 1e-12:
                continue
            column, row = corner[members, 0, 0] + x, corner[members, 0, 1] + y
            inside = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
            values = z[members] @ np.array([1 - weight_b - weight_c, weight_b, weight_c])
            surface[row[inside], column[inside]] = values[inside]
    return surface


def check_same_surface(mesh, other, within):
    for name in ("checksum", "rows", "columns"):
        require(mesh.fields.get(name) == other.fields.get(name), f"the two meshes differ in {name}")
    ours, theirs = heights_at_samples(mesh), heights_at_samples(other)
    require(not np.isnan(theirs).any(), "the other mesh does not cover the terrain")
    require(not np.isnan(ours).any(), f"{int(np.isnan(ours).sum())} samples are not covered")
    difference = np.abs(ours - theirs)
    allowed = mesh.rounding() + other.rounding() + within
    row, column = np.unravel_index(np.argmax(difference), difference.shape)
    require(difference.max() <= allowed,
            f"heights differ by up to {difference.max():.6g} m (column {column}, row {row} from the south); "
            f"{allowed:.3g} m are allowed")
    return f"same surface to {difference.max():.3g} m ({allowed:.3g} m are allowed)"


def check_shares(mesh, border_edges):
    faces = mesh.solid_faces()
    require(len(faces) > 0, "no triangle with three vertices")
    edges, forth, back = edges_of(faces)
    require((forth <= 1).all() and (back <= 1).all(),
            f"{int(((forth > 1) | (back > 1)).sum())} edges are used twice in one direction")
    once = int((forth + back == 1).sum())
    require(once == border_edges, f"{once} edges are used once, the border has {border_edges}")
    return f"{len(faces)} triangles share vertices, {once} border edges"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("--watertight", action="store_true")
    parser.add_argument("--covers-terrain", action="store_true")
    parser.add_argument("--same-surface", metavar="FULL_GRID.ply")
    parser.add_argument("--within", type=float, default=0.0)
    parser.add_argument("--shares-vertices", type=int, metavar="BORDER_EDGES")
    parser.add_argument("--max-triangles", type=int)
    arguments = parser.parse_args()
    try:
        mesh = Mesh(arguments.mesh)
        said = [check_camera(mesh)]
        if arguments.watertight:
            said.append(check_watertight(mesh))
        if arguments.covers_terrain:
            said.append(check_covers(mesh))
        if arguments.same_surface:
            said.append(check_same_surface(mesh, Mesh(arguments.same_surface), arguments.within))
        if arguments.shares_vertices is not None:
            said.append(check_shares(mesh, arguments.shares_vertices))
        if arguments.max_triangles is not None:
            require(len(mesh.solid_faces()) <= arguments.max_triangles,
                    f"{len(mesh.solid_faces())} triangles, at most {arguments.max_triangles} allowed")
    except Broken as broken:
        print(f"{arguments.mesh}: {broken}")
        return 1
    print(f"{arguments.mesh}: " + "; ".join(said))
    return 0


if __name__ == "__main__":
    sys.exit(main())
