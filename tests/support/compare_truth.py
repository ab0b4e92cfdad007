#!/usr/bin/python3
"""compare_truth.py BEFORE AFTER: whether two results folders hold the same measured figures.

Compares, to the bit, every cell of AFTER with that of the same name in BEFORE: counts, hashes and all that
was measured of the picture and the surface; not times, memory, bytes, or what a pace decides (..._realtime).
Prints how many figures are equal and each that is not; exit status 1 where one is not, or nothing was
compared. For changes that must leave every figure as it was.
"""

import csv
import json
import sys
from pathlib import Path

FIELDS = """screen_error_px visible_error_px pixel_error_px crack_pixels skirt_pixels silhouette_px
uncovered_samples popping_px height_rmse_m image economy clipped_segments unjudged_pixels undecided_pixels
wall_triangles bound_honesty triangles triangles_nondegenerate draw_calls shots_hash""".split()


def cells_of(folder):
    lines = (folder / "cells.jsonl").read_text().splitlines()
    return {cell["cell"]: cell for cell in map(json.loads, lines)}


def frames_of(folder, cell):
    with open(folder / "frames" / (cell + ".csv"), newline="") as file:
        return list(csv.DictReader(file))


def compare(name, before, after):
    """Yields (what, before, after) of each figure."""
    for field in FIELDS:
        if field in before["cell"] or field in after["cell"]:
            yield f"{name}: {field}", before["cell"].get(field), after["cell"].get(field)
    if before["cell"]["seed"] == after["cell"]["seed"]:  # which chooses the frame
        yield f"{name}: depth_hash", before["cell"]["depth_hash"], after["cell"]["depth_hash"]
    for old, new in zip(before["frames"], after["frames"], strict=True):
        for column in new:
            if not column.endswith("_ms") and column != "uploaded_bytes":
                yield f"{name}: frame {new['frame']}, {column}", old.get(column), new[column]


def main():
    before, after = map(Path, sys.argv[1:3])
    equal = differing = 0
    old_cells = cells_of(before)
    for name, cell in cells_of(after).items():
        if name not in old_cells:
            continue
        old = {"cell": old_cells[name], "frames": frames_of(before, name)}
        new = {"cell": cell, "frames": frames_of(after, name)}
        for what, was, now in compare(name, old, new):
            if was == now:
                equal += 1
            else:
                differing += 1
                print(f"{what}: {was} before, {now} after")
    print(f"{equal} figures equal, {differing} not")
    return 1 if differing or not equal else 0


if __name__ == "__main__":
    sys.exit(main())
