#!/usr/bin/env python3
"""What the tile quadtrees' tolerance is worth, by each reading of Yang et al.'s (12), beside fu.

Flies each scenario in lockstep with dltq by all readings and with fu, at tolerances from small to
large, and prints triangles and measured error; and where dltq's error exceeds fu's at equal tau
(section 6.2: "can not miss the terrain features").
"""

import argparse
import json
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]


def fly(options, out):
    """The cells, by scenario, name and tau."""
    arguments = [options.program, "run", *options.scenarios, "--out", out, "--repeat", "1",
                 "--frames", str(options.frames), "--size", options.size]
    for method in ["dltq", "fu"]:
        arguments += ["--method", method, "--set", f"{method}.tau={options.tau}"]
    arguments += ["--set", f"dltq.shared_height={options.readings}"]
    subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL)
    cells = {}
    for line in (out / "cells.jsonl").read_text(encoding="utf-8").splitlines():
        cell = json.loads(line)
        params = cell["params"]
        name = "fu" if cell["method"] == "fu" else "dltq, " + params["shared_height"]
        cells[cell["scenario"], name, params["tau"]] = cell
    return cells


def row(name, tau, cell):
    refused = cell["counters"]["splits_refused"] > 0
    return (f"| {name} | {tau:g} | {cell['triangles']['mean']:,.0f}{' (pool full)' if refused else ''} "
            f"| {cell['pixel_error_px']['p999']:.2f} | {cell['pixel_error_px']['max']:.2f} "
            f"| {cell['bound_honesty']:.2f} | {cell['crack_pixels']['total']} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenarios", nargs="*", type=pathlib.Path,
                        default=[ROOT / "scenarios/trade/high.toml"], help="default: trade/high.toml")
    parser.add_argument("--program", default=ROOT / "build/release/bin/lodbench", type=pathlib.Path)
    parser.add_argument("--tau", default="1,2,4,8,16,32", help="pixels, separated by commas")
    parser.add_argument("--readings", default="none,triangle,range",
                        help="of (12), separated by commas")
    parser.add_argument("--frames", default=65, type=int, help="frames of the flight")
    parser.add_argument("--size", default="640x480")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="lodbench-tiles-") as folder:
        cells = fly(options, pathlib.Path(folder) / "out")
    tolerances = [float(tau) for tau in options.tau.split(",")]
    for scenario in dict.fromkeys(key[0] for key in cells):
        print(f"\n{scenario}\n\n| method | tau | triangles | P99.9 px | max px | honesty | crack pixels |")
        print("|---|---:|---:|---:|---:|---:|---:|")
        names = ["fu", *("dltq, " + reading for reading in options.readings.split(","))]
        for name in names:
            for tau in tolerances:
                print(row(name, tau, cells[scenario, name, tau]))
        for name in names[1:]:
            worse = [f"{tau:g}" for tau in tolerances
                     if cells[scenario, name, tau]["pixel_error_px"]["max"] >
                     cells[scenario, "fu", tau]["pixel_error_px"]["max"]]
            print(f"{name}: greatest error above fu's at tau {', '.join(worse) if worse else 'none'}")


if __name__ == "__main__":
    main()
