#!/usr/bin/env python3
"""What lindstrom's claimed bound is worth, and what keeping it costs.

Flies the path of trade/high.toml over Puget Sound with fields of view and tolerances from small to large,
and prints the greatest measured screen error over tau for each pair of the options that bound it:

  midpoint, euclidean          the paper, lambda by the tangent
  accumulated, euclidean       without the sum of midpoint errors: what is left over 1 is the off-axis angle
  midpoint, planar             without the angle: what is left over 1 is the sum of midpoint errors
  accumulated, planar          neither: at most 1, or method or measurement is wrong (exit status 1)
  accumulated, planar, morph   the same with geomorphing (morph = 2): at most 1 too
  midpoint, euclidean, angle   the paper, lambda by the angle

and the triangles of each as multiples of the first one's at the same tau. A second table has the greatest over
all tau, and the triangles at tau = 1 (or the first one given).
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
# error, metric, morph, lambda
COLUMNS = {
    "midpoint, euclidean": ("midpoint", "euclidean", 1.0, "tan"),
    "accumulated, euclidean": ("accumulated", "euclidean", 1.0, "tan"),
    "midpoint, planar": ("midpoint", "planar", 1.0, "tan"),
    "accumulated, planar": ("accumulated", "planar", 1.0, "tan"),
    "accumulated, planar, morph": ("accumulated", "planar", 2.0, "tan"),
    "midpoint, euclidean, angle": ("midpoint", "euclidean", 1.0, "angle"),
}
BOUNDED = [column for column in COLUMNS if column.startswith("accumulated, planar")]
TOLERANCE = 1e-3  # float32 positions and depths


def scenario(name, fov, frames, every):
    """That flight with another field of view."""
    text = (ROOT / "scenarios/trade/high.toml").read_text(encoding="utf-8")
    changes = {
        "name": f'"{name}"',
        "vertical_fov": fov,
        "frames": frames,
        "every": every,
        "economy": "[]",
        "shots": "[0]",
        "repetitions": 1,
        "file": f'"{ROOT}/scenarios/terrain/puget_sound_1025_160m.png"',
    }
    for key, value in changes.items():
        text, found = re.subn(rf"^{key} = .*$", f"{key} = {value}", text, flags=re.MULTILINE)
        if found != 1:
            sys.exit(f"honesty.py: scenarios/trade/high.toml no longer has just one line of {key!r}")
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
        taus = [float(tau) for tau in options.tau.split(",")]
        cells = {}
        for column, (error, metric, morph, form) in COLUMNS.items():
            out = pathlib.Path(folder) / column.replace(", ", "-")
            settings = [f"tau={options.tau}", f"error={error}", f"metric={metric}", f"morph={morph}",
                        f"lambda={form}"]
            subprocess.run([options.program, "run", *files, "--method", "lindstrom",
                            *(word for setting in settings for word in ("--set", f"lindstrom.{setting}")),
                            "--size", options.size, "--out", out], check=True, stdout=subprocess.DEVNULL)
            for line in (out / "cells.jsonl").read_text(encoding="utf-8").splitlines():
                cell = json.loads(line)
                cells[cell["scenario"], cell["params"]["tau"], column] = cell

    def field(fov, tau, column, honesty):
        paper = cells[f"fov{fov}", tau, next(iter(COLUMNS))]["triangles"]["mean"]
        return f"{honesty:.3f} ({cells[f'fov{fov}', tau, column]['triangles']['mean'] / paper:.2f} x)"

    def honesty(fov, tau, column):
        return float(cells[f"fov{fov}", tau, column]["bound_honesty"])

    heads = "| " + " | ".join(COLUMNS) + " |"
    rule = "---:|" * len(COLUMNS)
    print("greatest measured screen error / tau, and triangles (of the paper's)\n")
    print(f"| fov | tau {heads}\n|---:|---:|{rule}")
    for fov in fovs:
        for tau in taus:
            fields = [field(fov, tau, column, honesty(fov, tau, column)) for column in COLUMNS]
            print(f"| {fov} | {tau:g} | " + " | ".join(fields) + " |")
    shown = 1.0 if 1.0 in taus else taus[0]
    print(f"\nthe greatest over all tau, and triangles at tau = {shown:g}\n")
    print(f"| fov {heads}\n|---:|{rule}")
    for fov in fovs:
        fields = [field(fov, shown, column, max(honesty(fov, tau, column) for tau in taus))
                  for column in COLUMNS]
        print(f"| {fov} | " + " | ".join(fields) + " |")
    if not all(honesty(fov, tau, column) <= 1 + TOLERANCE
               for fov in fovs for tau in taus for column in BOUNDED):
        sys.exit("honesty.py: accumulated errors with the planar metric do not keep their bound")


if __name__ == "__main__":
    main()
