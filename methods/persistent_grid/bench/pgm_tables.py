#!/usr/bin/env python3
"""What pgm's readings and options are worth: the tables of the room's README.

Flies each scenario once per grid and variant and prints greatest, P99.9 and RMS of the pixel error,
popping, uncovered samples and crack pixels. With --fetches instead the CPU time of a frame for the
variants of the paper's table 1, as ratios; no truth is measured then.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
GRIDS = {"320x240": (240, 4 / 3), "150x600": (600, 0.25), "200x800": (800, 0.25),
         "430x430": (430, 1), "300x900": (900, 1 / 3), "600x600": (600, 1), "400x1600": (1600, 0.25)}
VARIANTS = {
    "formula": {"spacing": "formula"},
    "default": {},
    "distance": {"level": "distance", "window": 256},
    "nearest": {"interpolation": "nearest"},
    "bilinear": {"interpolation": "bilinear"},
    "finest-only": {"finest_only": "true", "interpolation": "bilinear"},
    "minimum-near": {"base": "minimum-near"},
    "no-extension": {"extend": "false"},
    "horizon": {"rows": "horizon"},
}
FETCHES = ("multi-texture", "2", "1", "1-with-parent")


def cells(options, scenario, grid, settings, more=()):
    rows, aspect = GRIDS[grid]
    with tempfile.TemporaryDirectory(prefix="lodbench-pgm-") as folder:
        out = pathlib.Path(folder) / "out"
        arguments = [options.program, "run", scenario, "--method", "pgm", "--out", out,
                     "--set", f"pgm.grid={rows}", "--set", f"pgm.aspect={aspect}", *more]
        for name, value in settings.items():
            arguments += ["--set", f"pgm.{name}={value}"]
        subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return [json.loads(line) for line in (out / "cells.jsonl").read_text(encoding="utf-8").splitlines()]


def number(value):
    return "inf" if value == "inf" else f"{value:.2f}"


def print_errors(options, scenario):
    print("| grid | variant | max px | P99.9 px | RMS px | popping P99.9 px | uncovered | crack pixels |")
    print("|---|---|---:|---:|---:|---:|---:|---:|")
    for grid in options.grids.split(","):
        for variant in options.variants.split(","):
            (cell,) = cells(options, scenario, grid, VARIANTS[variant], ["--repeat", "1"])
            error = cell["pixel_error_px"]
            print(f"| {grid} | {variant} | {number(error['max'])} | {number(error['p999'])} "
                  f"| {number(error['rms'])} | {number(cell['popping_px']['p999'])} "
                  f"| {cell['uncovered_samples']} | {cell['crack_pixels']['total']} |", flush=True)


def median(values):
    return sorted(values)[len(values) // 2]


def print_fetches(options, scenario):
    print("| grid | triangles |" + "".join(f" {fetches} |" for fetches in FETCHES))
    print("|---|---:|" + "---:|" * len(FETCHES))
    for grid in options.grids.split(","):
        flown = cells(options, scenario, grid, {"fetches": ",".join(FETCHES)},
                      ["--no-truth", "--frames", str(options.frames), "--repeat", str(options.repeat)])
        ms = {fetches: median([cell["cpu_ms"]["median"] for cell in flown
                               if cell["params"]["fetches"] == fetches]) for fetches in FETCHES}
        print(f"| {grid} | {flown[0]['triangles']['max']} |" +
              "".join(f" {ms[fetches]:.1f} ms, {ms['2'] / ms[fetches]:.2f} |" for fetches in FETCHES), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenarios", nargs="*", type=pathlib.Path,
                        default=[ROOT / "scenarios/trade/high.toml"], help="default: trade/high.toml")
    parser.add_argument("--program", default=ROOT / "build/release/bin/lodbench", type=pathlib.Path)
    parser.add_argument("--grids", default=",".join(GRIDS), help="separated by commas")
    parser.add_argument("--variants", default=",".join(VARIANTS), help="separated by commas")
    parser.add_argument("--fetches", action="store_true", help="times by fetches instead of errors")
    parser.add_argument("--frames", default=12, type=int, help="of --fetches")
    parser.add_argument("--repeat", default=3, type=int, help="of --fetches")
    options = parser.parse_args()
    for scenario in options.scenarios:
        print(f"\n{scenario.stem}\n")
        (print_fetches if options.fetches else print_errors)(options, scenario)


if __name__ == "__main__":
    main()
