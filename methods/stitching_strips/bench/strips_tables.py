#!/usr/bin/env python3
"""What the three methods of this room make of the paper's claims: the tables of the room's README.

By default flies scenarios/papers/zhang/zhang-2019.toml once for each method and threshold and prints triangles,
greatest, P99.9 and RMS of the pixel error, popping, cracks and the room's counters. Popping is also told apart for
steps from frame to frame in which a node of the quadtree splits or merges and for those in which none does.

  --views       the height error of the whole terrain in the paper's four views (table 3, figure 17), and triangles
  --thresholds  the same of dss in each of the views at the thresholds 1 to 8 (figure 19)
  --honesty     the approach with the variants of the metric of dss
"""

import argparse
import csv
import json
import math
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
PAPER = ROOT / "scenarios/papers/zhang"
METHODS = ("dss", "tess-pow2", "tess-uniform")
VARIANTS = {
    "as it is": {},
    "straight_down = zero": {"straight_down": "zero"},
    "view_angle = false": {"view_angle": "false"},
    "error = max": {"error": "max"},
    "error = max, view_angle = false": {"error": "max", "view_angle": "false"},
    "error = max, view_angle = false, distance = box": {"error": "max", "view_angle": "false", "distance": "box"},
}


class Flown:
    """One cell: its record, its frames' rows, and where its cameras stood."""

    def __init__(self, options, scenario, method, settings, overrides=()):
        with tempfile.TemporaryDirectory(prefix="lodbench-strips-") as folder:
            out = pathlib.Path(folder) / "out"
            arguments = [options.program, "run", scenario, "--method", method, "--repeat", "1", "--out", out]
            for name, value in settings.items():
                arguments += ["--set", f"{method}.{name}={value}"]
            for override in overrides:
                arguments += ["--override", override]
            subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            (line,) = (out / "cells.jsonl").read_text(encoding="utf-8").splitlines()
            self.cell = json.loads(line)
            with open(next((out / "frames").glob("*.csv")), encoding="utf-8", newline="") as file:
                self.frames = list(csv.DictReader(file))
            self.flight = json.loads(next((out / "flights").glob("*.json")).read_text(encoding="utf-8"))


def number(value, digits=2):
    return "–" if value is None else "inf" if value == "inf" else f"{value:.{digits}f}"


def approach_overrides(options):
    return [f"flight.frames={options.frames}"] if options.frames else []


def flight_row(index, position, direction):
    heading = math.degrees(math.atan2(direction[0], direction[1])) % 360
    pitch = math.degrees(math.asin(direction[2]))
    return f"{index},{position[0]!r},{position[1]!r},{position[2]!r},{heading!r},{pitch!r},0\n"


def changes(options, method, settings, flight, frame):
    """How many nodes split or merge from `frame` to the next: the cut depends on nothing else."""
    with tempfile.TemporaryDirectory(prefix="lodbench-strips-") as folder:
        file = pathlib.Path(folder) / "two.csv"
        rows = [flight_row(i, flight["positions"][frame + i], flight["directions"][frame + i]) for i in (0, 1)]
        file.write_text("frame,x,y,z,heading,pitch,roll\n" + "".join(rows), encoding="utf-8")
        two = Flown(options, PAPER / "zhang-2019.toml", method, settings,
                    ['flight={ kind = "recorded", file = "%s", warmup_frames = 1 }' % file, "measure.truth=false",
                     "measure.every=1", "measure.shots=[]"])
        # The mean of two frames; that of the first, where the camera stood before, is 0.
        return round(2 * two.cell["counters"]["splits_changed"])


def popping_apart(options, method, settings, flown):
    """The greatest and mean P99.9 of a step with changes of the quadtree, and of one without."""
    steps = {True: [], False: []}
    for row in flown.frames:
        if not row["popping_p999_px"]:
            continue
        changed = changes(options, method, settings, flown.flight, int(row["frame"]))
        steps[changed > 0].append(float(row["popping_p999_px"]))
    return steps


def steps_text(values):
    return f"{max(values):.2f}, {sum(values) / len(values):.2f} ({len(values)})" if values else "– (0)"


def print_claims(options):
    print("| method | tau | triangles | max px | P99.9 px | RMS px | popping P99.9 px | crack px "
          "| steps with splits: greatest P99.9, mean (steps) | steps without |")
    print("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|")
    notes = []
    for method in METHODS:
        for tau in options.taus.split(","):
            flown = Flown(options, PAPER / "zhang-2019.toml", method, {"tau": tau}, approach_overrides(options))
            cell, error = flown.cell, flown.cell["pixel_error_px"]
            if method == "tess-uniform":  # has no quadtree
                apart = {True: [], False: [float(row["popping_p999_px"]) for row in flown.frames
                                           if row["popping_p999_px"]]}
            else:
                apart = popping_apart(options, method, {"tau": tau}, flown)
            print(f"| `{method}` | {tau} | {cell['triangles']['mean']:.0f} | {number(error['max'])} "
                  f"| {number(error['p999'])} | {number(error['rms'])} | {number(cell['popping_px']['p999'])} "
                  f"| {cell['crack_pixels']['total']} | {steps_text(apart[True])} | {steps_text(apart[False])} |",
                  flush=True)
            notes.append(f"{method} at {tau}: median {cell['frame_ms']['median']:.2f} ms, select "
                         f"{cell['select_ms']['median']:.3f} ms, slowest over mean "
                         f"{cell['frame_ms']['max'] / cell['frame_ms']['mean']:.2f}; "
                         + ", ".join(f"{name} {value:.4g}" for name, value in cell["counters"].items()))
    print("\n" + "\n".join(notes))


def whole_view(options, method, settings, view):
    cell = Flown(options, PAPER / f"view-{view}.toml", method, settings, ["measure.shots=[]"]).cell
    return cell["height_rmse_whole_m"]["mean"], cell["triangles"]["mean"], cell["counters"].get("m_blocks")


def print_views(options):
    settings = [(method, {"tau": tau}) for tau in options.taus.split(",") for method in METHODS]
    first = None
    print("| method | tau | RMSE of the four views, m | of Method I's first | change between them, of the same "
          "| triangles | blocks |")
    print("|---|---:|---|---|---|---|---|")
    settings.sort(key=lambda setting: setting[0] != "tess-pow2")  # Method I first: all others are divided by it
    for method, values in settings:
        views = [whole_view(options, method, values, view) for view in (1, 2, 3, 4)]
        errors = [view[0] for view in views]
        first = first or errors[0]
        steps = [abs(b - a) / first for a, b in zip(errors, errors[1:])]
        print(f"| `{method}` | {values['tau']} | {' '.join(number(e, 1) for e in errors)} "
              f"| {' '.join(number(e / first) for e in errors)} | {' '.join(number(s) for s in steps)} "
              f"| {' '.join(number(view[1], 0) for view in views)} "
              f"| {' '.join('–' if view[2] is None else number(view[2], 0) for view in views)} |", flush=True)


def print_thresholds(options):
    print("| view | " + " | ".join(f"tau {tau}" for tau in range(1, 9)) + " |")
    print("|---|" + "---|" * 8)
    for view in (1, 2, 3, 4):
        row = []
        for tau in range(1, 9):
            error, triangles, blocks = whole_view(options, "dss", {"tau": tau}, view)
            row.append(f"{triangles:.0f}, {blocks:.0f}, {error:.0f} m")
        print(f"| {view} | " + " | ".join(row) + " |", flush=True)


def print_honesty(options):
    print("| `dss` with | tau | max px | P99.9 px | RMS px | max / tau | P99.9 / tau | triangles |")
    print("|---|---:|---:|---:|---:|---:|---:|---:|")
    for variant, settings in VARIANTS.items():
        for tau in options.taus.split(","):
            cell = Flown(options, PAPER / "zhang-2019.toml", "dss", {"tau": tau, **settings},
                         approach_overrides(options)).cell
            error = cell["pixel_error_px"]
            print(f"| {variant} | {tau} | {number(error['max'])} | {number(error['p999'])} | {number(error['rms'])} "
                  f"| {number(error['max'] / float(tau), 1)} | {number(error['p999'] / float(tau), 1)} "
                  f"| {cell['triangles']['mean']:.0f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/release/bin/lodbench", type=pathlib.Path)
    parser.add_argument("--taus", default="1,2,4,8", help="separated by commas")
    tables = parser.add_mutually_exclusive_group()
    tables.add_argument("--views", action="store_const", dest="table", const=print_views)
    tables.add_argument("--thresholds", action="store_const", dest="table", const=print_thresholds)
    tables.add_argument("--honesty", action="store_const", dest="table", const=print_honesty)
    parser.add_argument("--frames", type=int, help="of the approach; default: the scenario's")
    options = parser.parse_args()
    (options.table or print_claims)(options)


if __name__ == "__main__":
    main()
