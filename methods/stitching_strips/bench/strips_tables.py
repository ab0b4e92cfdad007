#!/usr/bin/env python3
"""What the three methods of this room make of the paper's claims: the tables of the room's README.

Flies a scenario once for each method and setting and prints frame time, triangles, greatest, P99.9 and RMS of
the pixel error, popping, cracks, the height error of the whole terrain in each measured view, and the room's
counters. --honesty flies dss with the variants of its metric instead.
"""

import argparse
import csv
import json
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
METHODS = ("dss", "tess-pow2", "tess-uniform")
VARIANTS = {
    "faithful": {},
    "straight_down = zero": {"straight_down": "zero"},
    "error = max": {"error": "max"},
    "view_angle = false": {"view_angle": "false"},
    "max, no angle": {"error": "max", "view_angle": "false"},
    "max, no angle, box": {"error": "max", "view_angle": "false", "distance": "box"},
    "strips of a segment": {"strip_width": 0},
}


def fly(options, method, settings):
    """The cell's record, and its frames' rows."""
    with tempfile.TemporaryDirectory(prefix="lodbench-strips-") as folder:
        out = pathlib.Path(folder) / "out"
        arguments = [options.program, "run", options.scenario, "--method", method, "--repeat", "1", "--out", out]
        for name, value in settings.items():
            arguments += ["--set", f"{method}.{name}={value}"]
        if options.frames:
            arguments += ["--frames", str(options.frames)]
        if options.honesty:
            arguments += ["--override", "measure.whole=false"]
        subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        (cell,) = [json.loads(line) for line in (out / "cells.jsonl").read_text(encoding="utf-8").splitlines()]
        with open(next((out / "frames").glob("*.csv")), encoding="utf-8", newline="") as file:
            return cell, list(csv.DictReader(file))


def number(value, digits=2):
    return "–" if value is None else "inf" if value == "inf" else f"{value:.{digits}f}"


def whole_errors(frames):
    return [float(frame["height_rmse_whole_m"]) for frame in frames if frame.get("height_rmse_whole_m")]


def print_claims(options):
    print("| method | tau | ms, median | of a mean frame's time the slowest | triangles | max px | P99.9 px | RMS px "
          "| popping P99.9 px | crack px | RMSE by view, m |")
    print("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|")
    counters = []
    for method in METHODS:
        for tau in options.taus.split(","):
            cell, frames = fly(options, method, {"tau": tau})
            error = cell["pixel_error_px"]
            mean = cell["frame_ms"]["mean"]
            views = " ".join(number(value, 1) for value in whole_errors(frames))
            print(f"| {method} | {tau} | {number(cell['frame_ms']['median'])} | {number(cell['frame_ms']['max'] / mean)} "
                  f"| {cell['triangles']['mean']:.0f} | {number(error['max'])} | {number(error['p999'])} "
                  f"| {number(error['rms'])} | {number(cell['popping_px']['p999'])} "
                  f"| {cell['crack_pixels']['total']} | {views} |", flush=True)
            counters.append((method, tau, cell["counters"]))
    print()
    for method, tau, values in counters:
        print(f"{method} at {tau}: " + ", ".join(f"{name} {value:.4g}" for name, value in values.items()))


def print_honesty(options):
    print("| variant | tau | max px | P99.9 px | RMS px | P99.9 / tau | triangles |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    for variant, settings in VARIANTS.items():
        for tau in options.taus.split(","):
            cell, _ = fly(options, "dss", {"tau": tau, **settings})
            error = cell["pixel_error_px"]
            share = "inf" if error["p999"] == "inf" else number(error["p999"] / float(tau), 1)
            print(f"| {variant} | {tau} | {number(error['max'])} | {number(error['p999'])} | {number(error['rms'])} "
                  f"| {share} | {cell['triangles']['mean']:.0f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenario", nargs="?", type=pathlib.Path, default=ROOT / "scenarios/papers/zhang-2019.toml",
                        help="default: papers/zhang-2019.toml")
    parser.add_argument("--program", default=ROOT / "build/release/bin/lodbench", type=pathlib.Path)
    parser.add_argument("--taus", default="1,2,4,8", help="separated by commas")
    parser.add_argument("--honesty", action="store_true", help="dss with the variants of its metric")
    parser.add_argument("--frames", type=int, help="default: the scenario's")
    options = parser.parse_args()
    (print_honesty if options.honesty else print_claims)(options)


if __name__ == "__main__":
    main()
