"""How often `lodbench compare` cries wolf, and how often it sees one: A/A comparisons and injected slow-downs.

Flies the test plugin `steady` with its work raised by 0, 2, 5, 10 and 20 %, all settings by turns, many repetitions.
Each comparison takes 18 successive repetitions: nine are BASE, every other one, and nine NEW, so that what the machine
did meanwhile is in it. All five settings are compared together, as five methods would be. For A/A both sides are of
one build; for a slow-down, one setting of NEW is the slower build's. The plugin counts as changed in all of them, so
that no alarm is suppressed. Windows overlap: rates are of the comparisons, not of independent experiments.

usage: alarm_study.py LODBENCH FOLDER_OF_STEADY_SO OUT [--repetitions N] [--comparisons N] [--work N]

OUT/pool holds the flights, and is not flown again where it is there.
"""

import argparse
import json
import pathlib
import shutil
import statistics
import subprocess

SLOWDOWNS = (0, 2, 5, 10, 20)
RUNS = 9
SCENARIO = """name = "study"
[terrain]
synthetic = "ramp"
rows = 17
columns = 17
spacing = 10
[viewport]
width = 32
height = 24
[flight]
kind = "line"
frames = 40
warmup_frames = 3
start = [20, 20, 300]
end = [100, 100, 300]
[measure]
shots = [0]
truth = false
"""


def fly(options):
    pool = options.out / "pool"
    if pool.exists():
        return pool
    options.out.mkdir(parents=True, exist_ok=True)
    scenario = options.out / "study.toml"
    scenario.write_text(SCENARIO)
    subprocess.run([options.lodbench, "run", scenario, "--plugin-dir", options.plugins, "--method", "steady",
                    "--set", f"steady.work={options.work}", "--set", "steady.slowdown=" + ",".join(map(str, SLOWDOWNS)),
                    "--repeat", str(options.repetitions), "--out", pool], check=True)
    return pool


def read(pool):
    """Cells by slow-down and repetition."""
    cells = {slowdown: {} for slowdown in SLOWDOWNS}
    for line in (pool / "cells.jsonl").read_text().splitlines():
        cell = json.loads(line)
        assert cell["status"] == "ok", cell["reason"]
        cells[cell["params"]["slowdown"]][cell["repetition"]] = cell
    whole = set.intersection(*(set(of.keys()) for of in cells.values()))
    return cells, sorted(whole)


class Study:
    def __init__(self, options, pool):
        self.lodbench = options.lodbench
        self.scratch = options.out / "drawn"
        self.run = json.loads((pool / "run.json").read_text())
        self.run["cells"] = []
        self.cells, self.repetitions = read(pool)

    def write(self, side, repetitions, slowed):
        folder = self.scratch / side
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "run.json").write_text(json.dumps(self.run))
        lines = []
        for setting in SLOWDOWNS:
            flown_as = slowed.get(setting, setting)
            for number, repetition in enumerate(repetitions):
                cell = dict(self.cells[flown_as][repetition])
                cell.pop("checksum", None)
                cell.update(cell=f"steady__{setting}__r{number}", params={"work": 1, "slowdown": setting},
                            repetition=number, plugin_checksum=side, frames_checksum=None)
                lines.append(json.dumps(cell))
        (folder / "cells.jsonl").write_text("\n".join(lines) + "\n")
        return folder

    def compare(self, first, swapped, slowed):
        """Verdicts by setting: those of all its times."""
        window = self.repetitions[first:first + 2 * RUNS]
        even, odd = window[::2], window[1::2]
        base = self.write("base", odd if swapped else even, {})
        new = self.write("new", even if swapped else odd, slowed)
        done = subprocess.run([self.lodbench, "compare", base, new, "--json"], capture_output=True, text=True, check=True)
        settings = json.loads(done.stdout)["settings"]
        assert len(settings) == len(SLOWDOWNS)
        return {setting["setting"]: {time["figure"]: time for time in setting["times"]} for setting in settings}


def rate(hits, of):
    return f"{hits}/{of} = {100 * hits / of:.1f} %"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lodbench", type=pathlib.Path)
    parser.add_argument("plugins", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--repetitions", type=int, default=220)
    parser.add_argument("--work", type=int, default=2500, help="of a frame: 2500 is 3.5 ms of a processor of 2.8 GHz")
    parser.add_argument("--comparisons", type=int, default=200)
    options = parser.parse_args()
    study = Study(options, fly(options))
    starts = range(len(study.repetitions) - 2 * RUNS + 1)
    assert len(starts) >= options.comparisons, "fly more repetitions"
    starts = starts[:options.comparisons]

    alarmed = 0
    for first in starts:
        verdicts = study.compare(first, first % 2 == 1, {})
        alarmed += any(time["verdict"] in ("slower", "faster") for times in verdicts.values() for time in times.values())
    print(f"A/A: {len(starts)} comparisons of {len(SLOWDOWNS)} settings: with an alarm {rate(alarmed, len(starts))}")

    for slowdown in SLOWDOWNS[1:]:
        true = {figure: statistics.median(cell[figure]["median"] for cell in study.cells[slowdown].values()) /
                statistics.median(cell[figure]["median"] for cell in study.cells[0].values())
                for figure in ("frame_ms", "cpu_ms")}
        found, others, words, by_figure = 0, 0, {}, {"frame_ms.median": 0, "cpu_ms.median": 0}
        for first in starts:
            # Setting 0 of NEW is the slower build's; the other four are as in BASE.
            verdicts = study.compare(first, first % 2 == 1, {0: slowdown})
            slowed = verdicts.pop("steady slowdown=0")
            found += any(time["verdict"] == "slower" for time in slowed.values())
            for figure in by_figure:
                by_figure[figure] += slowed[figure]["verdict"] == "slower"
            word = slowed["cpu_ms.median"]["verdict"]
            words[word] = words.get(word, 0) + 1
            others += any(time["verdict"] in ("slower", "faster") for times in verdicts.values()
                          for time in times.values())
        print(f"{slowdown} % more work (frame {true['frame_ms'] - 1:+.1%}, CPU {true['cpu_ms'] - 1:+.1%}): called slower "
              f"{rate(found, len(starts))}; by frame time {rate(by_figure['frame_ms.median'], len(starts))}, by CPU time "
              f"{rate(by_figure['cpu_ms.median'], len(starts))}; CPU time's verdicts {words}; an alarm over the other four "
              f"settings {rate(others, len(starts))}")
    shutil.rmtree(study.scratch)


if __name__ == "__main__":
    main()
