#!/usr/bin/env python3
"""What lindstrom's claimed bound is worth, and what keeping it costs.

Flies the demo's path over Puget Sound with fields of view and tolerances from small to large, and
prints the greatest measured screen error over tau for each pair of the options that bound it:

  midpoint, euclidean      the paper
  accumulated, euclidean   without the sum of midpoint errors: what is left over 1 is the off-axis angle
  midpoint, planar         without the angle: what is left over 1 is the sum of midpoint errors
  accumulated, planar      neither: at most 1, or method or measurement is wrong (exit status 1)

and the triangles of each pair as multiples of the paper's.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAIRS = [("midpoint", "euclidean"), ("accumulated", "euclidean"), ("midpoint", "planar"),
         ("accumulated", "planar")]
TOLERANCE = 1e-3  # float32 positions and depths


def scenario(name, fov, frames, every):
    """The demo's flight with another field of view."""
    text = (ROOT / "scenarios/demo.toml").read_text(encoding="utf-8")
    changes = {
        'name = "demo"': f'name = "{name}"',
        "vertical_fov = 45": f"vertical_fov = {fov}",
        "frames = 120": f"frames = {frames}",
        "every = 10": f"every = {every}",
        "shots = [0, 60, 119]": "shots = [0]",
        "repetitions = 3": "repetitions = 1",
        'file = "terrain/': f'file = "{ROOT}/scenarios/terrain/',
    }
    for old, new in changes.items():
        if text.count(old) != 1:
            sys.exit(f"honesty.py: scenarios/demo.toml no longer says {old!r} just once")
        text = text.replace(old, new)
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/release/bin/lodbench", type=pathlib.Path)
    parser.add_argument("--fov", default="30,60,90,120", help="degrees, separated by commas")
    parser.add_argument("--tau", default="0.25,0.5,1,2,4,8,16", help="pixels, separated by commas")
    parser.add_argument("--frames", default=24, type=int, help="frames of the flight")
    parser.add_argument("--every", default=4, type=int, help="every n-th is measured")
    parser.add_argument("--size", default="640x480")
    options = parser.parse_args()
    fovs = options.fov.split(",")
    with tempfile.TemporaryDirectory(prefix="lodbench-honesty-") as folder:
        files = []
        for fov in fovs:
            files.append(pathlib.Path(folder) / f"fov{fov}.toml")
            files[-1].write_text(scenario(files[-1].stem, fov, options.frames, options.every),
                                 encoding="utf-8")
        out = pathlib.Path(folder) / "out"
        subprocess.run([options.program, "run", *files, "--method", "lindstrom",
                        "--set", f"lindstrom.tau={options.tau}",
                        "--set", "lindstrom.error=midpoint,accumulated",
                        "--set", "lindstrom.metric=euclidean,planar",
                        "--size", options.size, "--out", out], check=True,
                       stdout=subprocess.DEVNULL)
        cells = {}
        for line in (out / "cells.jsonl").read_text(encoding="utf-8").splitlines():
            cell = json.loads(line)
            params = cell["params"]
            cells[cell["scenario"], params["tau"], params["error"], params["metric"]] = cell
    heads = [f"{error}, {metric}" for error, metric in PAIRS]
    print("greatest measured screen error / tau, and triangles (of the paper's)\n")
    print("| fov | tau | " + " | ".join(heads) + " |")
    print("|---:|---:|" + "---:|" * len(PAIRS))
    broken = False
    for fov in fovs:
        for tau in options.tau.split(","):
            row = [cells[f"fov{fov}", float(tau), *pair] for pair in PAIRS]
            paper = row[0]["triangles"]["mean"]
            fields = [f"{float(cell['bound_honesty']):.3f} ({cell['triangles']['mean'] / paper:.2f} x)"
                      for cell in row]
            broken |= not float(row[-1]["bound_honesty"]) <= 1 + TOLERANCE
            print(f"| {fov} | {tau} | " + " | ".join(fields) + " |")
    if broken:
        sys.exit("honesty.py: accumulated errors with the planar metric do not keep their bound")


if __name__ == "__main__":
    main()
