#!/usr/bin/env python3
"""Measures the screen error of a mesh that `lodbench mesh` wrote, sharing no code with lodbench (numpy only).

check_truth.py MESH.ply HEIGHTS.raw

MESH.ply names the terrain's grid and the camera. HEIGHTS.raw are the heights that the methods were served,
with HEIGHTS.raw.toml beside it, as `lodbench terrain import` or `synth` write them.

Drawn height: at each sample of the terrain the highest of the triangles that cover it in plan, borders
included. Positions were float32 relative to the eye, so a sample that nothing covers is still covered by a
triangle whose border is no farther than such positions are uncertain, at the nearest point of it. A triangle
narrower than that covers only so, and not at all where it stands upright. What hangs below the rest (skirts)
is not told apart: it loses to the rest wherever there is a rest.

Screen error: a sample is in view when its true or its drawn point lies in the frustum; its error is the
distance in pixels between the two points' projections, where the segment between them is cut off at the
near plane. It is infinite where nothing covers the sample.

Prints one JSON object: count (samples in view), uncovered (of them), max, p999 (nearest rank), max_covered
and rms (over the finite errors), worst (row from the north, and column). Pixels; "inf" where infinite, null
where there is nothing to measure. Exit status 0, or 1 with the reason: a file is broken, or the two do not
have the same grid. That the heights are those that the mesh's method was served is for the caller to see to.
"""
import argparse
import json
import math
import sys
import tomllib

import numpy as np

sys.dont_write_bytecode = True  # the source tree stays as it is
from check_mesh import Broken, Mesh, require  # noqa: E402

CHUNK = 1 << 20  # pairs of a triangle and a line of samples, or a sample, that are in memory at a time
UPRIGHT = 16  # metres of rise a metre, from which on a triangle that is all border is a wall


def read_heights(path, mesh):
    """Heights in metres, row 0 the south: the mesh's own order of y."""
    with open(path + ".toml", "rb") as file:
        grid = tomllib.load(file)
    require(grid.get("type") == "float32" and grid.get("endian", "little") == "little"
            and not {"vertical_scale", "vertical_offset", "no_data"} & grid.keys(),
            f"{path} does not hold heights in metres as little-endian float32")
    rows, columns = (int(mesh.numbers(name, 1)[0]) for name in ("rows", "columns"))
    require([grid["rows"], grid["columns"]] == [rows, columns],
            f"{path} has {grid['rows']} x {grid['columns']} samples, the mesh's terrain {rows} x {columns}")
    for ours, theirs in (("spacing", "spacing_m"), ("origin", "origin_m")):
        require(grid[ours] == mesh.numbers(theirs, 2).tolist(), f"{path} and the mesh differ in {ours}")
    heights = np.fromfile(path, "<f4")
    require(len(heights) == rows * columns, f"{path} has {len(heights)} samples, not {rows * columns}")
    require(np.isfinite(heights).all(), f"a sample of {path} is not finite")
    return heights.reshape(rows, columns)[::-1].astype(np.float64)


def spread(first, last):
    """Numbers first[i]..last[i] for all i one after the other, and for each the i that it belongs to."""
    lengths = np.maximum(last - first + 1, 0)
    owner = np.repeat(np.arange(len(first)), lengths)
    starts = np.cumsum(lengths) - lengths
    return first[owner] + np.arange(len(owner)) - starts[owner], owner


def chunks(lengths):
    """Slices of consecutive items whose lengths add up to CHUNK at most, or of one item."""
    ends = np.cumsum(np.maximum(lengths, 0))
    begin = 0
    while begin < len(lengths):
        done = ends[begin - 1] if begin else 0
        end = max(int(np.searchsorted(ends, done + CHUNK, side="right")), begin + 1)
        yield slice(begin, end)
        begin = end


class Triangles:
    """A mesh's triangles relative to the eye, counter-clockwise in plan; without those that stand upright."""

    def __init__(self, mesh, samples):
        eye = mesh.numbers("camera_position_m", 3)
        corner = mesh.vertices[mesh.faces] - eye
        plan = corner[:, :, :2]
        first, second = plan[:, 1] - plan[:, 0], plan[:, 2] - plan[:, 0]
        doubled_area = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
        corner[doubled_area < 0] = corner[doubled_area < 0][:, [0, 2, 1]]
        doubled_area = np.abs(doubled_area)
        # Position, matrix and feedback round once each, and the ends of an edge may round apart. A corner
        # beyond the terrain moves the part of its sides that lies on the terrain by less than itself.
        farthest = max(np.abs(samples.x).max(), np.abs(samples.y).max())
        uncertain = 8 * 2.0**-24 * np.minimum(np.abs(plan).max(axis=(1, 2)), farthest)
        side = np.roll(corner, -1, axis=1) - corner  # from corner i to the next one
        longest = np.sqrt((side[:, :, :2]**2).sum(axis=2).max(axis=1))
        wide = doubled_area > uncertain * longest
        upright = ~wide & (np.hypot(*np.cross(side[:, 0], side[:, 1])[:, :2].T) >= UPRIGHT * doubled_area)
        self.corner, self.side = corner[~upright], side[~upright]
        self.doubled_area = doubled_area[~upright]
        self.uncertain = uncertain[~upright]  # metres in plan
        self.wide = wide[~upright]


class Samples:
    """Where the terrain's samples stand in plan, relative to the eye."""

    def __init__(self, mesh):
        self.rows, self.columns = (int(mesh.numbers(name, 1)[0]) for name in ("rows", "columns"))
        origin, spacing = mesh.numbers("origin_m", 2), mesh.numbers("spacing_m", 2)
        eye = mesh.numbers("camera_position_m", 3)
        self.x = origin[0] - eye[0] + spacing[0] * np.arange(self.columns)
        self.y = origin[1] - eye[1] + spacing[1] * np.arange(self.rows)
        self.step = spacing

    def between(self, axis, low, high):
        """First and last index of the samples from low to high, and it may be one more on either side."""
        start, count = (self.x[0], self.columns) if axis == 0 else (self.y[0], self.rows)
        hair = 1e-6  # of a cell: rounding must lose no sample, what is too many is tested again
        first = np.ceil((low - start) / self.step[axis] - hair)
        last = np.floor((high - start) / self.step[axis] + hair)
        return np.clip(first, 0, count).astype(np.int64), np.clip(last, -1, count - 1).astype(np.int64)


def lines_of(triangles, samples):
    """Candidates: for each triangle and each line of samples that it may reach, the columns between which
    it may reach them. Yields arrays triangle, row, first column, last column."""
    margin = triangles.uncertain
    first_row, last_row = samples.between(1, triangles.corner[:, :, 1].min(axis=1) - margin,
                                          triangles.corner[:, :, 1].max(axis=1) + margin)
    for part in chunks(last_row - first_row + 1):
        row, owner = spread(first_row[part], last_row[part])
        triangle = owner + part.start
        reach = margin[triangle]
        low, high = samples.y[row] - reach, samples.y[row] + reach
        west, east = np.full(len(row), np.inf), np.full(len(row), -np.inf)
        # The strip between low and high cuts a convex figure out of the triangle, and its westernmost and
        # easternmost points lie on the triangle's sides.
        for i in range(3):
            start, side = triangles.corner[triangle, i], triangles.side[triangle, i]
            with np.errstate(divide="ignore", invalid="ignore"):
                at_low, at_high = (low - start[:, 1]) / side[:, 1], (high - start[:, 1]) / side[:, 1]
            level = side[:, 1] == 0
            inside = (start[:, 1] >= low) & (start[:, 1] <= high)
            begin = np.where(level, np.where(inside, 0, 2), np.clip(np.fmin(at_low, at_high), 0, None))
            end = np.where(level, 1, np.clip(np.fmax(at_low, at_high), None, 1))
            touched = begin <= end
            for part_of_side in (begin, end):
                x = start[:, 0] + part_of_side * side[:, 0]
                west = np.where(touched, np.minimum(west, x), west)
                east = np.where(touched, np.maximum(east, x), east)
        met = west <= east
        triangle, row, reach = triangle[met], row[met], reach[met]
        first, last = samples.between(0, west[met] - reach, east[met] + reach)
        yield triangle, row, first, last


def weights(triangles, triangle, x, y):
    """How far each point lies inside of each side, times the side's length."""
    inside = []
    for i in range(3):
        start, side = triangles.corner[triangle, i], triangles.side[triangle, i]
        inside.append(side[:, 0] * (y - start[:, 1]) - side[:, 1] * (x - start[:, 0]))
    return inside


def nearest_on_border(triangles, triangle, x, y):
    """Distance in plan to the triangle's border, and the height of the point there."""
    distance, height = np.full(len(x), np.inf), np.full(len(x), -np.inf)
    for i in range(3):
        start, side = triangles.corner[triangle, i], triangles.side[triangle, i]
        to_x, to_y = x - start[:, 0], y - start[:, 1]
        squared_length = side[:, 0]**2 + side[:, 1]**2
        along = (to_x * side[:, 0] + to_y * side[:, 1]) / np.where(squared_length > 0, squared_length, 1)
        along = np.clip(along, 0, 1)
        here = np.hypot(to_x - along * side[:, 0], to_y - along * side[:, 1])
        z = start[:, 2] + along * side[:, 2]
        better = (here < distance) | ((here == distance) & (z > height))
        distance, height = np.where(better, here, distance), np.where(better, z, height)
    return distance, height


def drawn_heights(triangles, samples):
    """The surface over each sample relative to the eye, row by row from the south; NaN where none."""
    surface = np.full(samples.rows * samples.columns, -np.inf)
    beside = [], []  # candidates whose triangle does not cover them: the sample's number, the triangle
    for line_triangle, line_row, first, last in lines_of(triangles, samples):
        for part in chunks(last - first + 1):
            column, owner = spread(first[part], last[part])
            triangle, row = line_triangle[part][owner], line_row[part][owner]
            number = row * samples.columns + column
            a, b, c = weights(triangles, triangle, samples.x[column], samples.y[row])
            covered = (a >= 0) & (b >= 0) & (c >= 0) & triangles.wide[triangle]
            # Side i ends at corner i + 1, so it weighs the corner after that one.
            z = triangles.corner[triangle, :, 2]
            with np.errstate(divide="ignore", invalid="ignore"):  # what is not wide may have no area
                z = (a * z[:, 2] + b * z[:, 0] + c * z[:, 1]) / triangles.doubled_area[triangle]
            beside[0].append(number[~covered])
            beside[1].append(triangle[~covered])
            higher = covered & (z > surface[number])
            number, z = number[higher], z[higher]
            order = np.argsort(z)  # of several values for one place numpy keeps the last
            surface[number[order]] = z[order]
    if not beside[0]:
        return np.where(np.isinf(surface), np.nan, surface)
    number, triangle = np.concatenate(beside[0]), np.concatenate(beside[1])
    open_still = np.isinf(surface[number])
    number, triangle = number[open_still], triangle[open_still]
    distance, z = nearest_on_border(triangles, triangle, samples.x[number % samples.columns],
                                    samples.y[number // samples.columns])
    near = distance <= triangles.uncertain[triangle]
    number, z = number[near], z[near]
    order = np.argsort(z)
    surface[number[order]] = z[order]
    return np.where(np.isinf(surface), np.nan, surface)


class Eye:
    """The camera's axes and lens, from the header's angles."""

    def __init__(self, mesh):
        w, x, y, z = mesh.numbers("camera_orientation_wxyz", 4)
        require(abs(w * w + x * x + y * y + z * z - 1) < 1e-9, "the orientation is not a unit quaternion")
        self.right = np.array([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)])
        self.up = np.array([2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)])
        self.ahead = -np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
        self.near = mesh.numbers("near_plane_m", 1)[0]
        self.width, self.height = mesh.numbers("viewport_px", 2)
        self.pixels_per_tangent = self.height / (2 * math.tan(mesh.numbers("vertical_fov_rad", 1)[0] / 2))

    def sees(self, seen):
        """Whether points (sideways, upward, depth) lie in the frustum."""
        sideways, upward, depth = seen
        edge = depth / self.pixels_per_tangent
        with np.errstate(invalid="ignore"):  # NaN is not in view
            return ((depth >= self.near) & (np.abs(sideways) <= self.width / 2 * edge)
                    & (np.abs(upward) <= self.height / 2 * edge))

    def turned(self, x, y, z):
        return [axis[0] * x + axis[1] * y + axis[2] * z for axis in (self.right, self.up, self.ahead)]

    def pixels_between(self, one, other):
        """Length in the picture of the part of each segment that lies beyond the near plane; at least one
        end does."""
        ends = []
        for point, far_end in ((one, other), (other, one)):
            behind = point[2] < self.near
            step = np.where(behind, far_end[2] - point[2], 1)
            part = np.where(behind, (self.near - point[2]) / step, 0)
            ends.append([p + part * (q - p) for p, q in zip(point, far_end)])
            ends[-1][2] = np.where(behind, self.near, ends[-1][2])
        (x0, y0, depth0), (x1, y1, depth1) = ends
        return self.pixels_per_tangent * np.hypot(x0 / depth0 - x1 / depth1, y0 / depth0 - y1 / depth1)


def screen_errors(mesh, heights):
    """The error in pixels of each sample in view, and the samples' numbers, row by row from the south."""
    samples = Samples(mesh)
    drawn = drawn_heights(Triangles(mesh, samples), samples)
    true = heights.reshape(-1) - mesh.numbers("camera_position_m", 3)[2]
    x, y = np.tile(samples.x, samples.rows), np.repeat(samples.y, samples.columns)
    eye = Eye(mesh)
    true_seen, drawn_seen = eye.turned(x, y, true), eye.turned(x, y, drawn)
    number = np.nonzero(eye.sees(true_seen) | eye.sees(drawn_seen))[0]
    error = eye.pixels_between([axis[number] for axis in true_seen], [axis[number] for axis in drawn_seen])
    return np.where(np.isnan(drawn[number]), np.inf, error), number


def figures(mesh, heights):
    error, number = screen_errors(mesh, heights)
    finite = error[np.isfinite(error)]
    count = len(error)
    result = {name: mesh.fields[name][0] for name in ("method", "frame") if name in mesh.fields}
    result |= {"count": count, "uncovered": count - len(finite), "max": None, "p999": None,
               "max_covered": None, "rms": None, "worst": None}
    if count:
        rows, columns = heights.shape
        worst = int(number[np.argmax(error)])
        result["max"] = float(error.max())
        # Nearest rank: the least value that at least 99.9 % do not exceed. In whole numbers.
        result["p999"] = float(np.sort(error)[(999 * count + 999) // 1000 - 1])
        result["worst"] = [rows - 1 - worst // columns, worst % columns]
    if len(finite):
        result["max_covered"] = float(finite.max())
        result["rms"] = math.sqrt(float(np.mean(finite**2)))
    return {name: "inf" if isinstance(value, float) and math.isinf(value) else value
            for name, value in result.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("mesh", metavar="MESH.ply")
    parser.add_argument("heights", metavar="HEIGHTS.raw")
    arguments = parser.parse_args()
    try:
        mesh = Mesh(arguments.mesh)
        print(json.dumps(figures(mesh, read_heights(arguments.heights, mesh))))
    except (Broken, OSError) as broken:
        print(f"{arguments.mesh}: {broken}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
