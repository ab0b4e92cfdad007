#!/usr/bin/env python3
"""Checks the raster of `lodbench-terrain-errors`, sharing no code with lodbench (numpy only).

check_errors.py HEIGHTS.raw ERRORS.exr SIZE SPACING_X SPACING_Y [accumulated]

HEIGHTS.raw as `lodbench terrain import` writes it (32-bit floats), SIZE x SIZE samples, SIZE = 2^n + 1.
Decodes the OpenEXR file (scan lines, ZIP), computes error and radius of every vertex of longest-edge
bisection anew, level by level, and compares: lodbench rounds up by at most 2^-22 a level.
"""
import struct
import sys
import zlib

import numpy as np


def read_exr(path):
    """Channels by name, as arrays of float32."""
    data = open(path, "rb").read()
    magic, version = struct.unpack_from("<II", data)
    assert magic == 20000630 and version == 2, "no OpenEXR file of one part with scan lines"
    at, header = 8, {}

    def text(at):
        end = data.index(b"\0", at)
        return data[at:end].decode(), end + 1

    while data[at]:
        name, at = text(at)
        _, at = text(at)
        (size,) = struct.unpack_from("<I", data, at)
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    at += 1
    names, channel = [], 0
    while header["channels"][channel]:
        end = header["channels"].index(b"\0", channel)
        names.append(header["channels"][channel:end].decode())
        assert struct.unpack_from("<I", header["channels"], end + 1) == (2,), "a channel is not float"
        channel = end + 17
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
    rows, columns = bottom - top + 1, right - left + 1
    lines = {2: 1, 3: 16}[header["compression"][0]]  # ZIPS, ZIP
    values = np.zeros((rows, len(names), columns), np.float32)
    for offset in struct.unpack_from(f"<{-(-rows // lines)}Q", data, at):
        row, size = struct.unpack_from("<iI", data, offset)
        row -= top
        count = min(lines, rows - row)
        block = data[offset + 8:offset + 8 + size]
        expected = count * len(names) * columns * 4
        if size < expected:
            deltas = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
            deltas[1:] -= 128
            halves = (np.cumsum(deltas) % 256).astype(np.uint8)
            raw = np.empty(expected, np.uint8)
            middle = (expected + 1) // 2
            raw[0::2], raw[1::2] = halves[:middle], halves[middle:]
            block = raw.tobytes()
        values[row:row + count] = np.frombuffer(block, "<f4").reshape(count, len(names), columns)
    return {name: values[:, i] for i, name in enumerate(names)}


def shifted(array, row, column, fill):
    """array[r + row, c + column], `fill` outside."""
    wide = np.pad(array, ((abs(row),) * 2, (abs(column),) * 2), constant_values=fill)
    return wide[abs(row) + row:abs(row) + row + array.shape[0],
                abs(column) + column:abs(column) + column + array.shape[1]]


def criteria(heights, spacing, accumulated):
    size = len(heights)
    z = heights.astype(np.float64)
    error, radius = np.zeros_like(z), np.zeros_like(z)
    row, column = np.indices(z.shape)
    lowest = (row | column) & -(row | column)

    def level(at, ends, children):
        delta = np.full_like(z, np.inf)
        for (a, b), where in ends:
            middle = (shifted(z, *a, 0) + shifted(z, *b, 0)) / 2
            delta = np.where(where, np.abs(z - middle), delta)
        below, reach = np.zeros_like(z), np.zeros_like(z)
        for y, x in children:
            distance = np.sqrt((y * spacing[1]) ** 2 + (x * spacing[0]) ** 2 + (z - shifted(z, y, x, 0)) ** 2)
            inside = shifted(np.ones_like(z), y, x, 0) > 0
            below = np.maximum(below, np.where(inside, shifted(error, y, x, 0), 0))
            reach = np.maximum(reach, np.where(inside, distance + shifted(radius, y, x, 0), 0))
        combined = delta + below if accumulated else np.maximum(delta, below)
        error[at], radius[at] = combined[at], reach[at]

    step = 1
    while step < size - 1:
        half = step // 2
        odd_row, odd_column = (row & step) > 0, (column & step) > 0
        here = (lowest == step)
        corners = [(y, x) for y in (-half, half) for x in (-half, half)] if half else []
        level(here & (odd_row ^ odd_column),
              [(((0, -step), (0, step)), odd_column), (((-step, 0), (step, 0)), odd_row)], corners)
        falling = ((row - step) + (column - step)) & (2 * step) == 0
        level(here & odd_row & odd_column,
              [(((-step, -step), (step, step)), falling), (((-step, step), (step, -step)), ~falling)],
              [(-step, 0), (step, 0), (0, -step), (0, step)])
        step *= 2
    return {"error": error, "radius": radius}


def main():
    heights_path, errors_path, size, spacing_x, spacing_y = sys.argv[1:6]
    size = int(size)
    heights = np.fromfile(heights_path, "<f4").reshape(size, size)
    found = read_exr(errors_path)
    expected = criteria(heights, (float(spacing_x), float(spacing_y)), "accumulated" in sys.argv[6:])
    levels = 2 * (size - 1).bit_length()
    for name, values in expected.items():
        wrong = ~((found[name] >= values * (1 - 2.0**-50)) & (found[name] <= values * (1 + levels * 2.0**-22)))
        if wrong.any():
            row, column = np.argwhere(wrong)[0]
            print(f"{name}: {wrong.sum()} differ, first at row {row}, column {column}: "
                  f"{found[name][row, column]}, expected {values[row, column]}")
            return 1
    print(f"{size} x {size} samples: error up to {expected['error'].max():.6g}, "
          f"radius up to {expected['radius'].max():.6g}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
