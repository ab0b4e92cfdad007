#!/usr/bin/env python3
"""What multi-context's guarantee is worth at rest and in flight.

Flies level over a terrain at several speeds and prints for each: how many frames behind the errors
were in the timing replay; the greatest measured screen error over delta and the 99.9th percentile in
lockstep, where the errors are those of the frame; and the pixel error in lockstep and at the pace of
real time, where they are as far behind as the machine lets them be. The difference of the last two is
what staleness costs; what is above delta in lockstep is what the metric costs.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]

SCENARIO = """
name = "speed{speed}"
[terrain]
file = "{terrain}"
{terrain_keys}
[camera]
vertical_fov = 60
near = {near}
[viewport]
width = 640
height = 480
[flight]
{flight}
frames = {frames}
rate_hz = {rate}
warmup_frames = 3
[measure]
every = {every}
shots = [0]
[run]
repetitions = 1
cell_time_limit_s = 3600
[[method]]
id = "multi-context"
delta = {delta}
errors = "{errors}"
readback = "{readback}"
"""

LINE = """kind = "line"
start = [{x}, {y}, {height}]
heading = {heading}
speed = {speed}
pitch = {pitch}"""


def flight(speed, folder, options):
    """The [flight] of a speed; a camera that stands still is no line, but a recorded flight."""
    x, y, height = options.start.split(",")
    if float(speed) != 0:
        return LINE.format(x=x, y=y, height=height, heading=options.heading, speed=speed,
                           pitch=options.pitch)
    rows = [f"{frame},{x},{y},{height},{options.heading},{options.pitch},0"
            for frame in range(options.frames)]
    (folder / "still.csv").write_text("\n".join(["frame,x,y,z,heading,pitch,roll", *rows]) + "\n",
                                      encoding="utf-8")
    return 'kind = "recorded"\nfile = "still.csv"'


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/release/bin/lodbench", type=pathlib.Path)
    parser.add_argument("--speeds", default="0,100,1000,10000", help="m/s, separated by commas")
    parser.add_argument("--terrain", type=pathlib.Path, help="default: the embedded Puget Sound")
    parser.add_argument("--start", default="40000,82000,6000", help="x,y,z of the first frame, metres")
    parser.add_argument("--heading", default=97, type=float)
    parser.add_argument("--pitch", default=-20, type=float)
    parser.add_argument("--near", default=10, type=float)
    parser.add_argument("--delta", default=1, type=float)
    parser.add_argument("--errors", default="float")
    parser.add_argument("--readback", default="whole")
    parser.add_argument("--frames", default=25, type=int)
    parser.add_argument("--every", default=4, type=int, help="every n-th is measured")
    parser.add_argument("--rate", default=10, type=float,
                        help="simulated frames a second; near to what the machine draws")
    parser.add_argument("--out", type=pathlib.Path, help="keeps the results in this folder")
    options = parser.parse_args()
    keys = "" if options.terrain else "spacing = 160\nvertical_scale = 0.1"
    terrain = options.terrain or ROOT / "scenarios/terrain/puget_sound_1025_160m.png"
    print("| m/s | m a frame | frames behind: mean, max | screen error / delta, lockstep: max | P99.9 px "
          "| above delta % | worst (frame, row, column) | pixel error px, lockstep: max | P99.9 "
          "| real time: max | P99.9 | crack px a frame | fps | triangles | errors passes in all replays |")
    print("|---:|" + "---:|" * 14)
    with tempfile.TemporaryDirectory(prefix="lodbench-staleness-") as folder:
        for speed in options.speeds.split(","):
            file = pathlib.Path(folder) / f"speed{speed}.toml"
            file.write_text(SCENARIO.format(
                speed=speed, flight=flight(speed, pathlib.Path(folder), options),
                terrain=terrain.resolve(), terrain_keys=keys, near=options.near,
                frames=options.frames, rate=options.rate, every=options.every,
                delta=options.delta, errors=options.errors, readback=options.readback), encoding="utf-8")
            out = (options.out or pathlib.Path(folder)) / f"speed{speed}"
            subprocess.run([options.program, "run", file, "--out", out], check=True,
                           stdout=subprocess.DEVNULL)
            cell = json.loads((out / "cells.jsonl").read_text(encoding="utf-8").splitlines()[-1])
            screen, pixel = cell["screen_error_px"], cell["pixel_error_px"]
            live, counters = cell["pixel_error_realtime_px"], cell["counters"]
            worst = screen["worst"]
            print(f"| {speed} | {float(speed) / options.rate:g} "
                  f"| {counters['staleness_frames_unsettled_mean_so_far']:.1f}, "
                  f"{counters['staleness_frames_unsettled_max_so_far']:.0f} "
                  f"| {float(screen['max']) / options.delta:.3f} | {float(screen['p999']):.3f} "
                  f"| {100 * screen['over_tau']:.3f} "
                  f"| {worst['frame']}, {worst['row']}, {worst['column']} "
                  f"| {float(pixel['max']):.3f} | {float(pixel['p999']):.3f} "
                  f"| {float(live['max']):.3f} | {float(live['p999']):.3f} "
                  f"| {cell['crack_pixels']['max']} | {cell['fps']:.1f} "
                  f"| {cell['triangles']['mean']:.0f} | {counters['errors_passes_so_far']:.0f} |",
                  flush=True)


if __name__ == "__main__":
    main()
