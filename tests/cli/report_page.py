"""Made-up results folders and a reader of the page that `lodbench report` makes of them."""

import html.parser
import json
import math
import random
import struct
import subprocess
import zlib

VOID = {"area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "track", "wbr"}


class Page(html.parser.HTMLParser):
    """Every element, and the tables as rows of {field: (text, data-value)}."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.elements = []  # (tag, attributes)
        self.tables = []  # {"id", "scenario", "results", "rows"}
        self.scripts = []
        self.text = []
        self.ids = []
        self.errors = []
        self.open = []
        self.field = None
        self.feed(text)
        self.close()
        if self.open:
            self.errors.append(f"never closed: {self.open}")

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.elements.append((tag, attributes))
        if "id" in attributes:
            self.ids.append(attributes["id"])
        if tag not in VOID:
            self.open.append(tag)
        if tag == "table":
            self.tables.append({"id": attributes["data-table"], "scenario": attributes["data-scenario"],
                                "results": attributes["data-results"], "rows": []})
        elif tag == "tr" and self.tables:
            self.tables[-1]["rows"].append({})
        elif tag in ("td", "th") and "data-field" in attributes:
            self.field = attributes["data-field"]
            self.tables[-1]["rows"][-1][self.field] = ["", attributes.get("data-value")]
        elif tag == "script":
            self.scripts.append("")

    def handle_startendtag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.errors.append(f"</{tag}> closes another at {self.getpos()}")
        if tag in ("td", "th"):
            self.field = None

    def handle_data(self, data):
        if self.open and self.open[-1] == "script":
            self.scripts[-1] += data
            return
        self.text.append(data)
        if self.field is not None:
            self.tables[-1]["rows"][-1][self.field][0] += data

    def rows(self, table, scenario=None):
        return [row for t in self.tables if t["id"] == table and scenario in (None, t["scenario"])
                for row in t["rows"] if row]

    def data(self):
        return json.loads(next(s for s in self.scripts if s.startswith("{")))


def png(width, height):
    """Noise, which nothing makes small."""
    noise = random.Random(width)
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    rows = b"".join(b"\0" + noise.randbytes(3 * width) for _ in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def summary(value):
    return {"mean": value, "median": value * 0.99, "p90": value * 1.5, "p95": None, "p99": None,
            "p999": None, "min": value / 2, "max": value * 3, "low1": None, "low1_time": None, "low01": None}


def cell(name, method="lindstrom", scenario="demo", repetition=0, params=None, time=10.1, error=0.3, **more):
    record = {
        "cell": name, "method": method, "scenario": scenario, "params": params or {}, "repetition": repetition,
        "seed": 1, "status": "ok", "reason": None, "frames": 5, "fps": 1000 / time, "frame_ms": summary(time),
        "select_ms": summary(time / 10), "submit_ms": summary(time / 20), "gpu_ms": None,
        "cpu_ms": summary(time * 2), "jank_ms": 1.25, "triangles": {"mean": 1234.5 / time, "min": 1, "max": 9},
        "draw_calls": {"mean": 1, "min": 1, "max": 1}, "uploaded_bytes": {"mean": 10, "min": 1, "max": 90},
        "prepare_s": 0.1 + 0.2, "prepare_cpu_s": 0.4, "upload_s": 0.01,
        "samples_prepared": 8, "samples_served": 17, "tiles_served": 3, "terrain_bytes_read": 65536, "gpu_bytes": 12345678, "peak_rss_bytes": 98765432, "counters": {},
        "claimed_px": 1.0, "warnings": [], "truth_frames": 3, "economy": None,
        "screen_error_px": {"max": error * 3, "p999": error * 2, "max_covered": error * 2.5},
        "pixel_error_px": {"max": error * 2, "p999": error, "worst": {"frame": 2, "row": 1, "column": 1}},
        "pixel_error_realtime_px": None, "crack_pixels": {"total": 0, "max": 0},
        "popping_px": {"max": 0.5, "p999": error / 3, "over_1px": 0}, "bound_honesty": error * 3,
    }
    record.update(more)
    return record


FRAMES = "frame,wall_ms,triangles,pixel_p999_px,popping_p999_px\n"


def frames(count=5, time=10.1):
    return FRAMES + "".join(f"{i},{time + i % 3},{1000 + i},{0.1 if i % 2 == 0 else ''},\n" for i in range(count))


def economy(frame, triangles, p999=None, max=None):
    """A frame that was compared; p999 and max: target_px, minimal_triangles, ratio."""
    def bound(figures):
        if figures is None:
            return None
        target, minimal, ratio = figures
        return {"target_px": target, "minimal_triangles": minimal, "greedy_triangles": minimal + 1, "greedy_px": target,
                "ratio": ratio}
    return {"frame": frame, "triangles": triangles, "full_triangles": 400000, "p999": bound(p999), "max": bound(max)}


def flight(**more):
    record = {"schema_version": 1, "south_west": [0, 0], "north_east": [1000, 2000], "spacing": [10, 10], "rows": 201,
              "columns": 101, "min_height": 0, "max_height": 99, "positions": [[100, 100, 50], [900, 1900, 50]],
              "directions": [[0, 1, 0], [1, 0, 0]]}
    record.update(more)
    return record


def needed(target, tiles, most):
    return {"target_px": target, "tiles": tiles, "samples": tiles * 65 * 65, "most_tiles_in_a_frame": most}


def searched(method, knob="tau", probes=(), taken=None, outcome="met", monotone=True, failure=None):
    """A method of match.json; without a knob it was flown as it is."""
    return {"method": method, "knob": knob, "outcome": outcome if knob else None, "monotone": monotone if knob else None,
            "knob_value": taken, "achieved": dict(probes).get(taken), "failure": failure,
            "probes": [list(probe) for probe in probes]}


def match(methods, **more):
    record = {"schema_version": 1, "quantity": "pixel_error_px", "metric": "p999", "target": 2.0, "tolerance": 0.05,
              "methods": methods}
    record.update(more)
    return record


def write_folder(path, cells, run=None, csv=None, match=None, flights=None):
    """A results folder with these cells, which may hold anything."""
    for part in ("frames", "shots", "flights"):
        (path / part).mkdir(parents=True, exist_ok=True)
    context = {"schema_version": 1, "tool_version": "0.1.0", "seed": 1, "warnings": [], "scenarios": [],
               "gl": {"renderer": "made up", "software": True, "timer_verdict": "believed"}, "cells": []}
    context.update(run or {})
    (path / "run.json").write_text(json.dumps(context))
    (path / "cells.jsonl").write_text("".join(json.dumps(c) + "\n" for c in cells))
    for scenario, record in (flights or {}).items():
        (path / "flights" / f"{scenario}.json").write_text(json.dumps(record))
    if match is not None:
        (path / "match.json").write_text(json.dumps(match))
    for record in cells:
        if record["status"] == "ok":
            (path / "frames" / (record["cell"] + ".csv")).write_text(csv or frames())
    return path


def value_of(record, field):
    """The number at "frame_ms.median", None where there is none."""
    for key in field.split("."):
        record = record.get(key) if isinstance(record, dict) else None
    return math.inf if record == "inf" else record


def report(binary, *arguments, timeout=60):
    done = subprocess.run([binary, "report", *map(str, arguments)], capture_output=True, text=True, timeout=timeout)
    return done.returncode, done.stdout + done.stderr
