"""The page of `lodbench report`: its numbers are those of cells.jsonl, nothing that is in a results folder gets out of
its place, and what is damaged is refused by file and line.

usage: report_test.py LODBENCH_BINARY
"""

import base64
import csv
import hashlib
import json
import math
import pathlib
import re
import resource
import statistics
import sys
import tempfile
import unittest
import xml.etree.ElementTree

from report_page import (FRAMES, Page, cell, economy, flight, frames, match, needed, png, report, searched, value_of,
                         write_folder)

BINARY = sys.argv.pop(1)
HOSTILE = ['<script>alert(1)</script>', '"><img src=x onerror=alert(1)>', "</title></style></script><svg onload=alert(1)>",
           "a & b 'c' \u2028 \u2029 <!-- <![CDATA[", "]]>--></table></details>", "\u0000\u0007 \ud83d\ude00"]


class Report(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)
        self.out = self.root / "report.html"

    def make(self, *folders, more=()):
        status, output = report(BINARY, *folders, "-o", self.out, *more)
        self.assertEqual(status, 0, output)
        text = self.out.read_text()
        page = Page(text)
        self.assertEqual(page.errors, [])
        self.assertEqual(len(page.ids), len(set(page.ids)), "an id is there twice")
        return page, text

    def cells(self):
        cells = []
        for tau in (0.5, 1, 2, 10):
            for repetition in range(3):
                truth = {} if repetition == 0 else {k: None for k in (
                    "truth_frames", "screen_error_px", "pixel_error_px", "crack_pixels", "popping_px", "bound_honesty")}
                cells.append(cell(f"lindstrom__tau={tau}__demo__r{repetition}", params={"tau": tau, "threads": 2},
                                  repetition=repetition, time=20 / tau + repetition / 7, error=tau / 3, **truth))
        cells.append(cell("full-grid__demo__r0", method="full-grid", time=33.3, error=0, bound_honesty=None,
                          claimed_px=None))
        cells.append(cell("leaky__demo__r0", method="leaky", time=1 / 3, bound_honesty="inf",
                          pixel_error_px={"max": "inf", "p999": "inf", "worst": None}))
        return cells

    def test_every_cell_stands_in_the_page_with_its_exact_numbers(self):
        cells = self.cells()
        page, _ = self.make(write_folder(self.root / "run", cells))
        rows = {row["cell"][0]: row for row in page.rows("cells")}
        self.assertEqual(set(rows), {c["cell"] for c in cells})
        compared = 0
        for record in cells:
            for field, (text, value) in rows[record["cell"]].items():
                if value is None:
                    continue
                expected = value_of(record, field)
                if expected is None:
                    self.assertEqual((text, value), ("-", ""), field)
                else:
                    self.assertEqual(float(value), expected, field)
                    self.assertEqual(text == "∞", math.isinf(expected), field)
                    compared += 1
        self.assertGreater(compared, 150)

    def test_the_tables_of_a_scenario_are_the_medians_of_its_cells(self):
        cells = self.cells()
        page, _ = self.make(write_folder(self.root / "run", cells))
        greatest = {"frame_ms.max", "select_ms.max", "submit_ms.max", "gpu_ms.max", "cpu_ms.max", "peak_rss_bytes"}
        compared = 0
        for table in ("summary", "times", "resources", "bounds", "picture", "economy"):
            rows = page.rows(table, "demo")
            self.assertEqual(len(rows), 6, table)
            for row in rows:
                label = row["method"][0]
                members = [c for c in cells if label in (c["method"], f"{c['method']} tau={c['params'].get('tau')}")]
                self.assertTrue(members, label)
                for field, (_, value) in row.items():
                    if value is None:
                        continue
                    numbers = [n for n in (value_of(c, field) for c in members) if n is not None]
                    if not numbers:
                        self.assertEqual(value, "", (label, field))
                        continue
                    pick = max if field in greatest else statistics.median
                    self.assertEqual(float(value), pick(numbers), (label, field))
                    compared += 1
        self.assertGreater(compared, 100)

    def test_csv_files_hold_the_tables(self):
        cells = self.cells()
        folder = write_folder(self.root / "run", cells)
        page, _ = self.make(folder, more=["--csv", self.root / "csv"])
        names = {table["id"] for table in page.tables}
        self.assertEqual({p.stem for p in (self.root / "csv").iterdir()}, names)
        for name in names:
            with open(self.root / "csv" / f"{name}.csv", newline="") as stream:
                rows = list(csv.DictReader(stream))
            shown = page.rows(name)
            self.assertEqual(len(rows), len(shown), name)
            for row, other in zip(rows, shown):
                self.assertEqual(row["results"], "run")
                for field, (text, value) in other.items():
                    if value is not None:
                        self.assertEqual(row[field], value, (name, field))
                    elif field == "method":
                        self.assertEqual(text, row[field] + (f" tau={row['tau']}" if row.get("tau") else ""), name)
                    elif field not in ("front", "fps.interval"):
                        self.assertEqual(row[field], text, (name, field))

    def read_csv(self, name):
        with open(self.root / "csv" / f"{name}.csv", newline="") as stream:
            return list(csv.DictReader(stream))

    def test_csv_files_are_tidy(self):
        def settings(folder, taus, repetitions=3):
            return write_folder(self.root / folder, [
                cell(f"m{tau}{r}", method="m", params={"tau": tau, "fixed": 7, "status": f"s{tau}"}, time=10 / tau + r,
                     repetition=r) for tau in taus for r in range(repetitions)]
                + [cell("plain", method="plain", params={"fixed": 8})])
        one, many = settings("one", [1]), settings("many", [0.5, 10])
        self.make(one, many, more=["--csv", self.root / "csv"])
        for table in ("summary", "times", "resources", "bounds", "picture", "economy"):
            rows = self.read_csv(table)
            self.assertEqual(list(rows[0])[:3], ["results", "scenario", "method"], table)
            self.assertNotIn("fixed", rows[0])
            self.assertEqual([(row["results"], row["scenario"], row["method"], row["tau"], row["status"]) for row in rows],
                             [("one", "demo", "m", "1", "s1"), ("one", "demo", "plain", "", ""),
                              ("many", "demo", "m", "0.5", "s0.5"), ("many", "demo", "m", "10", "s10"),
                              ("many", "demo", "plain", "", "")], table)
        header = list(self.read_csv("cells")[0])
        self.assertEqual(len(header), len(set(header)))
        self.assertEqual(header[:7], ["results", "scenario", "method", "params.status", "tau", "cell", "params"])
        # One name, one statistic: of the same setting it is the same wherever it stands.
        seen = {}
        for table in ("summary", "times", "resources", "bounds", "picture", "economy"):
            for row in self.read_csv(table):
                for field, value in row.items():
                    key = (row["results"], row["method"], row["tau"], field)
                    self.assertEqual(seen.setdefault(key, value), value, (table, key))
                    if field not in ("results", "scenario", "method", "status", "front"):
                        self.assertTrue(value == "" or not math.isnan(float(value)), (table, key))
        self.assertEqual(float(seen["one", "m", "1", "frame_ms.max"]), 3 * 12)
        self.assertEqual(float(seen["one", "m", "1", "fps.high"]), 100)
        self.assertEqual(float(seen["one", "m", "1", "fps.low"]), 1000 / 12)

    def test_marks_the_front_of_speed_and_accuracy(self):
        page, _ = self.make(write_folder(self.root / "run", [
            cell("a__r0", method="fast", time=10, error=3), cell("b__r0", method="near", time=30, error=1),
            cell("c__r0", method="both-worse", time=31, error=3), cell("d__r0", method="twin", time=10, error=3),
            cell("e__r0", method="unmeasured", time=1, pixel_error_px=None)]))
        marked = {row["method"][0] for row in page.rows("summary") if row["front"][0]}
        self.assertEqual(marked, {"fast", "near", "twin"})
        plot = next(p for p in page.data()["plots"] if p["id"] == "set1-trade-time")
        ringed = {s["name"] for s in plot["series"] for m in s["marks"] if len(m) > 3 and m[3]}
        self.assertEqual(ringed, marked)

    def test_the_hypervolume_is_that_of_the_cells(self):
        cells = [cell(f"{m}{tau}r{r}", method=m, params={"tau": tau}, repetition=r, time=time + r, error=error)
                 for m, settings in {"swift": [(1, 10, 4), (2, 20, 2)], "near": [(1, 30, 1), (2, 25, 3)],
                                     "one": [(1, 40, 8)]}.items() for tau, time, error in settings for r in range(3)]
        # What its pace showed counts, of each repetition on its own.
        cells.append(cell("late0", method="late", time=15, error=1, pixel_error_realtime_px={"p999": 3}))
        cells.append(cell("late1", method="late", time=15, error=1, repetition=1))
        page, _ = self.make(write_folder(self.root / "run", cells))
        rows = {row["method"][0]: {field: value for field, (_, value) in row.items()}
                for row in page.rows("hypervolume")}
        points = {"swift": [(11, 4), (21, 2)], "near": [(31, 1), (26, 3)], "one": [(41, 8)], "late": [(15, 2)]}
        points["all"] = sum(points.values(), [])
        self.assertEqual(set(rows), set(points))
        width, height = 1.1 * 41, 1.1 * 8
        on_front = {"swift": 1, "near": 1, "one": 0, "late": 1, "all": 3}
        for method, mine in points.items():
            row = rows[method]
            self.assertEqual(float(row["settings"]), len(mine), method)
            self.assertEqual(float(row["on_front"]), on_front[method], method)
            self.assertAlmostEqual(float(row["reference.frame_ms"]), width)
            self.assertAlmostEqual(float(row["reference.pixel_error_px"]), height)
            area, ceiling = 0, height
            for time, error in sorted(mine):
                area += (width - time) * max(ceiling - error, 0)
                ceiling = min(ceiling, error)
            self.assertAlmostEqual(float(row["hypervolume"]), area / width / height, msg=method)
        self.assertEqual({row["method"][0] for row in page.rows("summary") if row["front"][0]},
                         {"swift tau=1", "late", "near tau=1"})
        page, _ = self.make(write_folder(self.root / "plain", [cell("a__r0"), cell("b__r0", method="b")]))
        self.assertEqual(page.rows("hypervolume"), [])

    def test_points_carry_the_value_of_their_knob(self):
        cells = [cell(f"m{tau}", method="m", params={"tau": tau}, time=10 / tau, error=tau) for tau in (0.5, 2)]
        cells += [cell(f"two{i}", method="two", params={"a": i, "b": i}, time=20 + i) for i in (3, 4)]
        page, text = self.make(write_folder(self.root / "run", cells))
        marks = [m for p in page.data()["plots"] if p["id"] == "set1-trade-time" for s in p["series"] for m in s["marks"]]
        self.assertEqual({m[2] for m in marks if len(m) > 2}, {"m tau=0.5", "m tau=2", "two a=3 b=3", "two a=4 b=4"})
        svg = text[text.index('aria-label="Error against frame time'):]
        svg = svg[:svg.index("</svg>")]
        self.assertEqual(set(re.findall(r'<text class="value[^>]*>([^<]+)</text>', svg)), {"0.5", "2", "a=3 b=3", "a=4 b=4"})
        for name in ("m tau=0.5", "two a=4 b=4"):
            self.assertIn(f"<title>{name}: ", svg)
        matched = [searched("m", probes=[(1, 2)], taken=1)]
        page, text = self.make(write_folder(self.root / "matched", [cell("m", method="m", params={"tau": 1})],
                                            match=match(matched)))
        self.assertIn("<title>m tau=1: ", text[text.index('aria-label="Error against frame time'):])

    def figure(self, name, *more):
        out = self.root / f"{name}.svg"
        status, output = report(BINARY, self.root / "run", "--figure", name, "-o", out, *more)
        self.assertEqual(status, 0, output)
        self.assertIn(f"figure    {out}", output)
        return out.read_text()

    def test_a_figure_is_an_svg_of_its_own(self):
        cells = [cell(f"m{tau}", method="m&m", params={"tau": tau}, time=10 / tau, error=tau) for tau in (0.5, 2)]
        cells += [cell("other", method="other", time=20)]
        write_folder(self.root / "run", cells)
        svg = self.figure("trade-time")
        space = "{http://www.w3.org/2000/svg}"
        root = xml.etree.ElementTree.fromstring(svg)
        self.assertEqual(root.tag, space + "svg")
        self.assertEqual([float(n) for n in root.get("viewBox").split()],
                         [0, 0, float(root.get("width")), float(root.get("height"))])
        texts = ["".join(e.itertext()) for e in root.iter(space + "text")]
        for words in ("Error against frame time", "mean frame time, ms", "pixel error P99.9, px", "m&m", "other",
                      "Pareto front", "0.5", "2"):
            self.assertIn(words, texts)
        # All of it within its frame.
        for e in root.iter(space + "text"):
            if e.get("y"):
                self.assertLess(float(e.get("y")), float(root.get("height")))
        # Nothing that another program would have to fetch or does not know.
        for foreign in ("var(", "href", "url(", "@import", "<script", "foreignObject"):
            self.assertNotIn(foreign, svg)
        style = root.find(space + "style").text
        used = {c for e in root.iter() for c in e.get("class", "").split()}
        self.assertTrue({"c0", "c1", "ink", "f", "s", "ring"} <= used)
        for name in used - {"d0", "o0"}:
            self.assertRegex(style, rf"\.{name}\b")
        self.assertEqual(svg, self.figure("set1-trade-time"))
        bars = xml.etree.ElementTree.fromstring(self.figure("percentiles"))
        self.assertTrue(list(bars.iter(space + "rect")))

    def test_a_figure_is_refused_with_what_there_is_and_how_to_convert(self):
        write_folder(self.root / "run", [cell("a"), cell("b", scenario="hills")])
        def refused(*more):
            status, output = report(BINARY, self.root / "run", *more)
            self.assertEqual(status, 2, output)
            return output
        self.assertIn("--figure moon: there is no such plot; the report has:\n  set1-trade-time", refused("--figure", "moon"))
        self.assertIn("several scenarios have that plot", refused("--figure", "trade-time"))
        self.assertIn("give --out fig.svg, then convert it: rsvg-convert -f pdf -o fig.pdf fig.svg",
                      refused("--figure", "set1-trade-time", "-o", "fig.pdf"))
        self.assertIn("a figure is an SVG; give --out fig.svg", refused("--figure", "set1-trade-time", "-o", "fig.png"))
        self.assertIn("--csv", refused("--figure", "set1-trade-time", "--csv", self.root / "t"))

    def test_on_paper_no_plot_is_split_and_no_table_cut(self):
        _, text = self.make(write_folder(self.root / "run", self.cells()))
        style = text[text.index("<style>"):text.index("</style>")]
        paper = style[style.index("@media print"):]
        rules = dict(re.findall(r"^  ([^{}\n]+) \{ ([^{}\n]+) \}$", paper, re.MULTILINE))
        self.assertIn("figure", next(k for k, v in rules.items() if "break-inside: avoid" in v).split(", "))
        self.assertIn("tr", next(k for k, v in rules.items() if "break-inside: avoid" in v).split(", "))
        self.assertIn("overflow: visible", rules[".scroll, pre, .warnings ul"])
        self.assertIn("max-height: none", rules[".scroll, pre, .warnings ul"])
        self.assertIn("white-space: normal", rules["th, td, thead th, td[data-field]"])
        # Ink on paper, whatever the screen's scheme.
        self.assertNotRegex(style, r"@media \(prefers-color-scheme: dark\)")

    def test_a_csv_field_is_no_formula_and_numbers_stay_numbers(self):
        failures = ["=1+1", "+cmd", "-2+3", "@SUM(A1)", "-1.5", "+2", "-"]
        methods = [searched(f"m{i}", failure=text) for i, text in enumerate(failures)]
        self.make(write_folder(self.root / "run", [cell("m0", method="m0", time=1)], match=match(methods)),
                  more=["--csv", self.root / "csv"])
        with open(self.root / "csv" / "match.csv", newline="") as stream:
            written = [row["failure"] for row in csv.DictReader(stream)]
        self.assertEqual(written, ["'=1+1", "'+cmd", "'-2+3", "'@SUM(A1)", "-1.5", "+2", "-"])

    def test_equal_accuracy_is_what_match_found_and_what_its_cells_cost(self):
        methods = [searched("lindstrom", probes=[(1.0, 0.9), (4.0, "inf"), (2.125, 2.03125)], taken=2.125),
                   searched("pgm", "grid", [(240.0, 8.5), (2048.0, 3.5), (4096.0, None)], 2048.0, "unreachable", False,
                            "out of memory"), searched("full-grid", None)]
        cells = [cell(f"lindstrom{r}", time=10 + r, repetition=r, error=2.0 + r) for r in range(3)]
        cells += [cell("pgm0", method="pgm", time=30, error=3.5), cell("full", method="full-grid", time=40, error=0)]
        page, text = self.make(write_folder(self.root / "run", cells, match=match(methods)),
                               more=["--csv", self.root / "csv"])
        self.assertIn("Target: p999 of the pixel error = 2 px, within 5 %.", text)
        self.assertLess(text.index('id="set1-match"'), text.index('id="set1-trade"'))
        rows = page.rows("match")
        self.assertEqual([row["method"][0] for row in rows], [m["method"] for m in methods])
        for row, method in zip(rows, methods):
            for field in ("knob_value", "achieved"):
                self.assertEqual(row[field][1], "" if method[field] is None else f"{method[field]:g}", field)
            self.assertEqual(row["probes"][1], str(len(method["probes"])))
            self.assertEqual(row["knob"][0], method["knob"] or "none")
            self.assertEqual(row["outcome"][0], method["outcome"] or "-")
            self.assertEqual(row["monotone"][0], {True: "yes", False: "no", None: "-"}[method["monotone"]])
            self.assertEqual(row["failure"][0], method["failure"] or "-")
        costs = {row["method"][0]: row for row in page.rows("equal_accuracy")}
        for name in ("lindstrom", "pgm", "full-grid"):
            mine = [c for c in cells if c["method"] == name]
            self.assertEqual(float(costs[name]["measured"][1]),
                             statistics.median(c["pixel_error_px"]["p999"] for c in mine))
            for field in ("frame_ms.median", "triangles.mean", "gpu_bytes", "prepare_s"):
                self.assertEqual(float(costs[name][field][1]), statistics.median(value_of(c, field) for c in mine), field)
        plot = next(p for p in page.data()["plots"] if p["id"] == "set1-match-probes")
        drawn = {s["name"]: s["marks"] for s in plot["series"]}
        self.assertEqual(drawn, {
            "target": [[0, 2], [2, 2]],
            "lindstrom": [[0, 0.9, "lindstrom tau=1", False], [2, 2.03125, "lindstrom tau=2.125", True]],
            "pgm": [[0, 8.5, "pgm grid=240", False], [1, 3.5, "pgm grid=2048", True]]})
        self.assertIn("2 of the probes failed or left ground uncovered", text)
        with open(self.root / "csv" / "match.csv", newline="") as stream:
            self.assertEqual([row["achieved"] for row in csv.DictReader(stream)], ["2.03125", "3.5", ""])
        for quantity, field in (("triangles", "triangles.mean"), ("frame_ms", "frame_ms.mean")):
            page, _ = self.make(write_folder(self.root / quantity, cells[-1:], match=match(
                [searched("full-grid", None)], quantity=quantity, metric="mean", target=1000)))
            self.assertEqual(float(page.rows("equal_accuracy")[0]["measured"][1]), value_of(cells[-1], field))
        page, text = self.make(write_folder(self.root / "plain", cells))
        self.assertEqual(page.rows("match") + page.rows("equal_accuracy"), [])
        self.assertNotIn("Equal accuracy", text)

    def test_economy_is_what_was_asked_for_beside_what_the_views_needed(self):
        cells = [cell(f"a{tau}", method="a", params={"tau": tau}, error=tau, samples_served=9_000_000 // tau)
                 for tau in (1, 2)]
        cells.append(cell("b", method="b", error=3, samples_served=50_000, samples_prepared=40_000, tiles_served=11))
        entries = [needed(0.25, 900, 300), needed(0.5, 300, 90), needed(1, 80, 30)]
        folder = write_folder(self.root / "run", cells, flights={"demo": flight(needed=entries)})
        page, text = self.make(folder, more=["--csv", self.root / "csv"])
        for row, record in zip(page.rows("economy"), cells):
            for field in ("screen_error_px.max_covered", "samples_prepared", "samples_served", "tiles_served",
                          "terrain_bytes_read", "gpu_bytes"):
                self.assertEqual(float(row[field][1]), value_of(record, field), field)
        with open(self.root / "csv" / "needed.csv", newline="") as stream:
            self.assertEqual([{k: float(v) for k, v in row.items() if k in entries[0]} for row in csv.DictReader(stream)],
                             entries)
        plot = next(p for p in page.data()["plots"] if p["id"] == "set1-economy-samples")
        self.assertTrue(plot["log"])
        self.assertEqual({s["name"]: [m[:2] for m in s["marks"]] for s in plot["series"]}, {
            "what the views needed": [[e["target_px"], e["samples"]] for e in entries],
            "a": [[2.5, 9_000_000], [5, 4_500_000]], "b": [[7.5, 50_000]]})
        self.assertIn("an upper bound of the least there is", text)
        self.assertIn("how few triangles would do; `lodbench economy --frame N`", text)
        self.assertEqual(page.rows("economy_frames"), [])

    def test_economy_compares_the_triangles_of_frames_with_what_would_do(self):
        first = [economy(50, 9000, (0.5, 3000, 3.0), (4, 1500, 6.0)), economy(10, 8000, (0.25, 1000, 8.0))]
        second = [economy(50, 9100, (0.5, 3000, 5.0), (4, 1500, 6.0))]
        cells = [cell("a0", method="a", economy=first), cell("a1", method="a", repetition=1, economy=second),
                 cell("b0", method="b", economy=[economy(50, 7, (0, 0, None), None)]),
                 cell("c0", method="c")]
        page, text = self.make(write_folder(self.root / "run", cells))
        rows = {(row["method"][0], row["frame"][0]): {field: value for field, (_, value) in row.items() if value}
                for row in page.rows("economy_frames")}
        def fields(frame, triangles, p999, max=None):
            row = {"frame": frame, "triangles": triangles, "full_triangles": 400000}
            for key, figures in (("p999", p999), ("max", max)):
                names = ("target_px", "minimal_triangles", "ratio", "greedy_px")
                figures = (*figures, figures[0]) if figures else ()
                row.update({f"{key}.{name}": value for name, value in zip(names, figures) if value is not None})
            return {key: f"{value:g}" for key, value in row.items()}
        self.assertEqual(rows, {("a", "10"): fields(10, 8000, (0.25, 1000, 8)),
                                ("a", "50"): fields(50, 9050, (0.5, 3000, 4), (4, 1500, 6)),
                                ("b", "50"): fields(50, 7, (0, 0, None))})
        plot = next(p for p in page.data()["plots"] if p["id"] == "set1-economy-ratio")
        self.assertEqual([c["label"] for c in plot["categories"]], ["a", "b", "c"])
        self.assertEqual([m[:2] + m[4:] for m in plot["series"][0]["marks"]], [[6, 0, 4, 8]])
        self.assertIn("They are an upper bound of the fewest there are", text)
        self.assertIn("Not measured: what the views needed; flights/demo.json does not say it", text)
        # An older folder has none of it.
        old = cell("a")
        for field in ("economy", "samples_prepared", "tiles_served", "terrain_bytes_read"):
            del old[field]
        page, text = self.make(write_folder(self.root / "old", [old], flights={"demo": flight()}))
        self.assertEqual(page.rows("economy")[0]["samples_prepared"], ["-", ""])
        self.assertEqual(page.rows("economy")[0]["samples_served"][1], "17")
        self.assertEqual(page.rows("economy_frames") + page.rows("needed"), [])

    def test_nothing_out_of_a_file_becomes_markup_or_script(self):
        reference, _ = self.make(write_folder(self.root / "plain", [
            cell(f"c{i}__r0", method=f"m{i}", scenario=f"s{i}", params={f"p{i}": f"v{i}"},
                 warnings=[f"w{i}"]) for i in range(len(HOSTILE))]
            + [cell(f"f{i}", method=f"m{i}", scenario=f"s{i}", params={f"p{i}": f"u{i}"}, status="failed",
                    reason="r") for i in range(len(HOSTILE))],
            run={"warnings": ["w"], "command_line": "c", "commit": "c", "tool_version": "t"},
            match=match([searched(f"m{i}", f"p{i}", [(1, 2)], 1, failure="f") for i in range(len(HOSTILE))])))
        cells = [cell(f"c{i}__r0", method=h, scenario=h, params={h: "v" + h}, warnings=[h])
                 for i, h in enumerate(HOSTILE)]
        cells += [cell(f"f{i}", method=h, scenario=h, params={h: "u" + h}, status="failed", reason=h)
                  for i, h in enumerate(HOSTILE)]
        everything = "".join(HOSTILE)
        run = {"warnings": [everything], "command_line": everything, "commit": everything, "tool_version": everything,
               "scenarios": [{"name": everything, "text": everything}],
               "gl": {"renderer": everything, "software": True, "timer_verdict": everything}, everything: everything}
        search = match([searched(h, h, [(1, 2)], 1, failure=h) for h in HOSTILE + ["<b>not flown</b>"]])
        page, text = self.make(write_folder(self.root / HOSTILE[1].replace("/", ""), cells, run, match=search))
        tags = {tag for tag, _ in page.elements}
        self.assertLessEqual(tags, {tag for tag, _ in reference.elements} | {"pre", "details", "summary"})
        self.assertNotIn("img", tags)
        for tag, attributes in page.elements:
            for name, value in attributes.items():
                self.assertFalse(name.startswith("on"), (tag, name))
                self.assertNotEqual(name, "style")
                if name in ("src", "href") and value:
                    self.assertTrue(value.startswith("#") or value.startswith("data:image/"), value)
        self.assertEqual(len(page.scripts), 2)  # the data and the page's own
        self.assertEqual(text.count("</script>"), 2)
        self.assertNotRegex(next(s for s in page.scripts if s.startswith("{")), "[<>&\u0080-\U0010ffff]")
        titles = {p["series"][-1]["name"] for p in page.data()["plots"] if p["id"].endswith("-trade-time")}
        for hostile in HOSTILE[:5]:
            self.assertIn(hostile, titles)
            self.assertIn(hostile, [row["method"][0].split(" " + hostile)[0] for row in page.rows("summary")])
        for row, hostile in zip(page.rows("match"), HOSTILE[:5]):
            self.assertEqual([row[field][0] for field in ("method", "knob", "failure")], [hostile] * 3)
        self.assertNotIn("\0", text)

    def test_the_page_asks_for_nothing_and_its_policy_forbids_it(self):
        _, text = self.make(write_folder(self.root / "run", self.cells()))
        policy = re.search(r'http-equiv="Content-Security-Policy" content="([^"]*)"', text).group(1)
        self.assertIn("default-src 'none'", policy)
        self.assertNotIn("unsafe", policy)
        self.assertNotIn("http", policy)
        for kind, start in (("script", "<script>"), ("style", "<style>")):
            for body in re.findall(rf"{re.escape(start)}(.*?)</{kind}>", text, re.DOTALL):
                digest = base64.b64encode(hashlib.sha256(body.encode()).digest()).decode()
                self.assertIn(f"'sha256-{digest}'", policy)
        outside = re.sub(r"<script>.*?</script>", "", text, flags=re.DOTALL)
        self.assertNotRegex(outside, r'(?:src|href)="(?!#|data:)')
        self.assertNotIn("@import", outside)
        self.assertNotIn("url(", outside)

    def test_long_labels_of_bars_keep_both_ends(self):
        _, text = self.make(write_folder(self.root / "run", [
            cell(f"a{tau}", method="größte-Höhen-zuerst-und-weiter", params={"tau": tau}) for tau in (0.25, 0.5)]
            + [cell("b", method="exactly-twenty-chars")]))
        labels = re.findall(r'<text class="end" x="142" [^>]*>([^<]*)<title>', text)
        self.assertEqual(set(labels), {"größte-Höh… tau=0.25", "größte-Höh…r tau=0.5", "exactly-twenty-chars"})

    def test_reads_without_a_script(self):
        page, text = self.make(write_folder(self.root / "run", self.cells()))
        plots = page.data()["plots"]
        self.assertGreaterEqual(len(plots), 12)
        for plot in plots:
            figure = text[text.index(f'id="{plot["id"]}"'):]
            figure = figure[:figure.index("</figure>")]
            self.assertRegex(figure, r'<svg [^>]*role="img" aria-label="[^"]+"')
            self.assertRegex(figure, r"<(?:path class=\"[sf]\"|circle class=\"f\"|rect class=\"f\")")
            self.assertNotRegex(figure, r"\bnan\b|\binf\b")
        tables = [a for tag, a in page.elements if tag == "table"]
        self.assertEqual(text.count("<caption>"), len(tables))
        self.assertEqual(re.findall(r"<th(?! scope=\"(?:row|col)\")[^e>]*>", text), [])

    def test_from_several_folders_each_keeps_its_own(self):
        first = write_folder(self.root / "first", [cell("a__r0", time=10)])
        second = write_folder(self.root / "second", [cell("a__r0", time=40)])
        page, text = self.make(first, second)
        self.assertEqual([row["fps"][1] for row in page.rows("summary")], ["100", "25"])
        self.assertIn("demo (first)", text)
        self.assertIn("demo (second)", text)

    def test_pictures_are_embedded_up_to_a_budget_and_the_rest_is_named(self):
        folder = write_folder(self.root / "run", [cell(f"m{i}__r0", method=f"m{i}") for i in range(4)])
        for i in range(2):
            (folder / "shots" / f"m{i}__r0__worst.png").write_bytes(png(64, 48))
        (folder / "shots" / "m2__r0__worst.png").write_bytes(b"no picture")
        page, text = self.make(folder)
        self.assertEqual(text.count("<img "), 2)
        self.assertIn("shots/m2__r0__worst.png: damaged, or no PNG", text)
        self.assertIn("shots/m3__r0__worst.png: there is no such file", text)
        self.assertNotIn("m1__r0__worst.png", text)
        self.assertNotIn("left out, so that", text)
        for i in range(3):
            (folder / "shots" / f"m{i}__r0__worst.png").write_bytes(png(1800, 1100))
        page, text = self.make(folder)
        shown = text.count("<img ")
        self.assertLess(shown, 3)
        self.assertIn(f"{3 - shown} more pictures are left out", text)
        self.assertLess(len(text), 5_000_000)

    def test_a_flight_is_drawn_over_its_ground(self):
        folder = write_folder(self.root / "run", [cell("a__r0")], flights={"demo": flight()})
        (folder / "flights" / "demo__hillshade.png").write_bytes(png(50, 100))
        _, text = self.make(folder)
        self.assertRegex(text, r'<image href="data:image/(webp|png);base64,')
        # The south-west is bottom left: x grows, y falls along this flight.
        way = re.search(r'<path class="way" d="M([\d.]+) ([\d.]+)L([\d.]+) ([\d.]+)"', text)
        x0, y0, x1, y1 = map(float, way.groups())
        self.assertLess(x0, x1)
        self.assertGreater(y0, y1)

    def test_what_was_not_measured_is_said(self):
        bare = {k: None for k in ("truth_frames", "screen_error_px", "pixel_error_px", "crack_pixels", "popping_px",
                                  "bound_honesty", "gpu_bytes")}
        page, text = self.make(write_folder(self.root / "run", [cell("a__r0", **bare)],
                                            csv=FRAMES + "0,1.5,7,,\n1,1.5,7,,\n"))
        self.assertGreaterEqual(text.count("Not measured:"), 4)
        self.assertEqual(page.rows("summary")[0]["gpu_bytes"], ["-", ""])
        failed = cell("b__r0", status="crashed", reason="signal 11 in draw", frame_ms=None, fps=None, triangles=None)
        page, text = self.make(write_folder(self.root / "failed", [failed]))
        self.assertEqual(page.rows("failures")[0]["reason"][0], "signal 11 in draw")
        page, text = self.make(write_folder(self.root / "empty", []))
        self.assertIn("no cell is finished", text)

    def test_a_run_that_is_not_finished_says_so(self):
        folder = write_folder(self.root / "run", [cell("a__r0")], run={"cells": [{"id": f"{name}__r0"} for name in "abc"]})
        with open(folder / "cells.jsonl", "a") as stream:
            stream.write('{"cell": "b')
        _, text = self.make(folder)
        self.assertIn("2 of the 3 cells that were planned are not flown", text)
        self.assertIn("the last line of cells.jsonl is incomplete", text)

    def test_damaged_and_foreign_folders_are_refused_and_the_page_stays(self):
        def damaged(name, damage):
            folder = write_folder(self.root / name, [cell("a__r0"), cell("b__r0")])
            damage(folder)
            return folder

        def change(file, old, new):
            return lambda folder: (folder / file).write_text((folder / file).read_text().replace(old, new, 1))

        def searched_as(**more):
            return lambda folder: (folder / "match.json").write_text(json.dumps(match([searched("m")]) | more))

        def flown(**more):
            return lambda folder: (folder / "flights" / "demo.json").write_text(json.dumps(flight(**more)))

        def found(**more):
            return searched_as(methods=[searched("m") | more])

        cases = {
            "absent": (lambda f: (f / "run.json").unlink(), "run.json: there is no such file"),
            "no-cells": (lambda f: (f / "cells.jsonl").unlink(), "cells.jsonl: there is no such file"),
            "run-json": (change("run.json", "{", "["), "run.json: this is not JSON"),
            "schema": (change("run.json", '"schema_version": 1', '"schema_version": 99'),
                       "schema_version is 99, expected 1"),
            "line": (lambda f: (f / "cells.jsonl").write_text((f / "cells.jsonl").read_text() + "{oops}\n"),
                     "cells.jsonl:3: this is not JSON"),
            "list": (lambda f: (f / "cells.jsonl").write_text("[]\n"), "cells.jsonl:1: no object"),
            "field": (change("cells.jsonl", '"method"', '"method_"'), "cells.jsonl:1: 'method' is missing"),
            "type": (change("cells.jsonl", '"params": {}', '"params": 7'), "cells.jsonl:1: 'params' is not an object"),
            "figure": (change("cells.jsonl", '"gpu_bytes": ', '"gpu_bytes": "1", "was": '),
                       "cells.jsonl:1: 'gpu_bytes' is not a whole number"),
            "summary": (change("cells.jsonl", '"frame_ms": ', '"frame_ms": {"median": "abc"}, "was": '),
                        "cells.jsonl:1: 'frame_ms.median' is not a number"),
            "economy": (change("cells.jsonl", '"economy": null', '"economy": "q"'),
                        "cells.jsonl:1: 'economy' is not a list"),
            "economy-frame": (change("cells.jsonl", '"economy": null', '"economy": [{"frame": "x"}]'),
                              "cells.jsonl:1: 'economy.frame' is not a whole number"),
            "twice": (change("cells.jsonl", "b__r0", "a__r0"), "cells.jsonl:2: cell 'a__r0' is there twice"),
            "escape": (change("cells.jsonl", "a__r0", "../a__r0"), "cells.jsonl:1: '../a__r0' is no name"),
            "frames": (lambda f: (f / "frames" / "b__r0.csv").unlink(), "b__r0.csv: there is no such file"),
            "number": (lambda f: (f / "frames" / "b__r0.csv").write_text(FRAMES + "0,x,1,,\n"),
                       "b__r0.csv:2: 'x' in column wall_ms is no number"),
            "short": (lambda f: (f / "frames" / "b__r0.csv").write_text(FRAMES + "0,1\n"),
                      "b__r0.csv:2: 2 fields, expected 5"),
            "cut": (lambda f: (f / "frames" / "b__r0.csv").write_text(frames()[:-3]), "b__r0.csv:6: the line has no end"),
            "header": (lambda f: (f / "frames" / "b__r0.csv").write_text("a,b\n1,2\n"), "no column 'frame'"),
            "flight": (lambda f: (f / "flights" / "demo.json").write_text('{"schema_version": 1}'),
                       "demo.json: 'south_west' is missing"),
            "needed": (flown(needed=7), "demo.json: 'needed' is not a list"),
            "needed-entry": (flown(needed=[7]), "demo.json: needed: 'target_px' is missing"),
            "needed-order": (flown(needed=[needed(1, 2, 3), needed(1, 2, 3)]),
                             "demo.json: needed: 'target_px' is not positive and rising"),
            "needed-negative": (flown(needed=[needed(1, -2, 3)]), "most_tiles_in_a_frame' is not at least 0"),
            "needed-text": (flown(needed=[needed(1, 2, "3")]),
                            "demo.json: needed: 'most_tiles_in_a_frame' is not a number"),
            "match-json": (lambda f: (f / "match.json").write_text("{"), "match.json: this is not JSON"),
            "match-schema": (searched_as(schema_version=2), "match.json: schema_version is 2, expected 1"),
            "match-quantity": (searched_as(quantity="beauty"), "match.json: 'quantity' is not pixel_error_px"),
            "match-metric": (searched_as(metric="mean"), "match.json: 'metric' is not p999"),
            "match-mean": (searched_as(quantity="triangles"), "match.json: 'metric' is not mean"),
            "match-target": (searched_as(target=0), "match.json: 'target' is not positive"),
            "match-tolerance": (searched_as(tolerance="5 %"), "match.json: 'tolerance' is not a number"),
            "match-wide": (searched_as(tolerance=1), "match.json: 'tolerance' is not between 0 and 1"),
            "match-methods": (searched_as(methods={}), "match.json: 'methods' is not a list"),
            "match-method": (searched_as(methods=[7]), "match.json: methods: 'method' is missing"),
            "match-knob": (found(knob=1), "match.json: method 'm': 'knob' is not text or null"),
            "match-outcome": (found(outcome=[]), "match.json: method 'm': 'outcome' is not text or null"),
            "match-result": (found(outcome="foo"), "match.json: method 'm': 'outcome' is not met, unreachable"),
            "match-negative": (found(achieved=-1), "match.json: method 'm': 'achieved' is not a number of at least 0"),
            "match-failure": (found(failure={}), "match.json: method 'm': 'failure' is not text or null"),
            "match-value": (found(knob_value="1"), "match.json: method 'm': 'knob_value' is not a number or null"),
            "match-achieved": (found(achieved="x"), "match.json: method 'm': 'achieved' is not a number"),
            "match-monotone": (found(monotone=1), "match.json: method 'm': 'monotone' is not true, false or null"),
            "match-probes": (found(probes=None), "match.json: method 'm': 'probes' is not a list"),
            "match-probe": (found(probes=[[1]]), "match.json: method 'm': 'probes' is not a list of knob value"),
            "match-probed": (found(probes=[[1, "x"]]), "match.json: method 'm': 'probes' is not a list of knob value"),
            "deep": (lambda f: (f / "run.json").write_text("[" * 5000), "run.json: this is not JSON"),
        }
        self.out.write_text("as it was")
        for name, (damage, message) in cases.items():
            with self.subTest(name):
                status, output = report(BINARY, damaged(name, damage), "-o", self.out, "--csv", self.root / "csv")
                self.assertEqual(status, 2, output)
                self.assertIn(message, output)
                self.assertRegex(output, r";|:\d+:|JSON|missing")
                self.assertEqual(len(output.splitlines()), 1, output)
                self.assertEqual(self.out.read_text(), "as it was")
                self.assertFalse((self.root / "csv").exists())
        self.assertEqual(report(BINARY, self.root / "nowhere")[0], 2)
        folder = write_folder(self.root / "good", [cell("a__r0")])
        self.assertEqual(report(BINARY, folder, folder)[0], 2)
        self.assertEqual(report(BINARY, folder, "-o", self.root / "no" / "such" / "r.html")[0], 4)

    def large(self, scenario, count=5000):
        return write_folder(self.root / "large", [
            cell(f"c{i}__r0", method=f"m{i % 7}", scenario=scenario(i), params={"tau": i}, time=1 + i % 97,
                 error=1 / (1 + i % 89), warnings=["a warning of this cell"]) for i in range(count)],
            csv=frames(120))

    def check_large(self, folder):
        # The time that it computes, not that of the clock: other tests run beside this one.
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        page, text = self.make(folder)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
        print(f"{len(text) / 1e6:.1f} MB in {seconds:.1f} s of CPU time", file=sys.stderr)
        self.assertLess(seconds, 10)
        self.assertLess(len(text.encode()), 30_000_000)
        self.assertEqual(len(page.rows("cells")), 5000)
        return text

    def test_5000_settings_of_one_scenario(self):
        text = self.check_large(self.large(lambda i: "demo"))
        self.assertRegex(text, "Drawn are 16 of 5000 settings")
        self.assertIn("The first 400 of 5000 rows", text)

    def test_5000_cells_of_250_scenarios(self):
        text = self.check_large(self.large(lambda i: f"s{i // 20}"))
        self.assertIn("Plotted are the first 12 scenarios", text)


if __name__ == "__main__":
    unittest.main()
