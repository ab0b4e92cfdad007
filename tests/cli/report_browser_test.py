"""A report as a browser shows it: silent, offline, drawn, within its width, and usable with the keyboard alone. Needs
Chromium, which nothing else does; exit status 77 without one.

usage: report_browser_test.py LODBENCH_BINARY
"""

import base64
import pathlib
import shutil
import sys
import tempfile
import unittest

from devtools import Browser
from report_page import cell, economy, flight, match, needed, png, report, searched, write_folder

BINARY = sys.argv.pop(1)
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
CHART = "Chart.getChart(document.querySelector('#set1-curve-wall_ms canvas'))"
VISIBLE = f"{CHART}.data.datasets.filter((_, i) => {CHART}.isDatasetVisible(i)).length"


class Shown(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        folder = write_folder(pathlib.Path(scratch.name) / "run", [
            cell(f"m{i}t{tau}r{r}", method="<script>alert(1)</script>" if i == 0 else f"method-{i}", params={"tau": tau},
                 repetition=r, scenario='"><img src=x onerror=alert(1)>', time=(i + 1) * 7 / tau, error=tau / (i + 1),
                 economy=[economy(10 * k, 9000, (tau, 3000, 3 + k)) for k in range(3)])
            for i in range(3) for tau in (0.5, 1, 2) for r in range(2)],
            match=match([searched("method-1", probes=[(1, 0.05), (4, 90), (2, 2)], taken=2)]),
            flights={'"><img src=x onerror=alert(1)>': flight(needed=[needed(0.5, 90, 30), needed(1, 30, 9)])})
        (folder / "shots" / "m1t1r0__worst.png").write_bytes(png(400, 300))
        status, output = report(BINARY, folder)
        self.assertEqual(status, 0, output)
        self.url = (folder / "report.html").as_uri()
        self.browser = Browser(CHROMIUM)
        self.addCleanup(self.browser.close)

    def check_silence(self):
        for event in self.browser.events:
            self.assertNotIn(event["method"], ("Runtime.exceptionThrown", "Runtime.consoleAPICalled", "Log.entryAdded",
                                               "Page.javascriptDialogOpening"), event)
            if event["method"] == "Network.requestWillBeSent":
                self.assertRegex(event["params"]["request"]["url"], "^(file|data|about):")

    def test_draws_its_plots_without_a_sound_and_fits(self):
        for width in (390, 1440):
            for scheme in ("light", "dark"):
                with self.subTest(width=width, scheme=scheme):
                    self.browser.open(self.url, width, scheme)
                    self.assertTrue(self.browser.evaluate(
                        "document.documentElement.scrollWidth <= document.documentElement.clientWidth"))
                    figures, canvases, blank = self.browser.evaluate(
                        "[document.querySelectorAll('figure.plot').length, document.querySelectorAll('canvas').length, "
                        "[...document.querySelectorAll('canvas')].filter((c) => c.getContext('2d').getImageData(0, 0, "
                        "c.width, c.height).data.every((v) => v === 0)).length]")
                    self.assertGreater(figures, 10)
                    self.assertEqual((canvases, blank), (figures, 0))
                    self.check_silence()

    def test_on_paper_tables_fit_and_plots_stay_whole(self):
        paper = 718  # pixels between the margins of A4
        for scheme in ("light", "dark"):
            self.browser.open(self.url, paper, scheme)
            self.browser.call("Emulation.setEmulatedMedia", media="print",
                              features=[{"name": "prefers-color-scheme", "value": scheme}])
            clipped, split, canvases, background = self.browser.evaluate(
                "[[...document.querySelectorAll('.scroll, table, .legend')].filter((e) => "
                "e.getBoundingClientRect().right > innerWidth || e.scrollHeight > e.clientHeight + 1 "
                "&& getComputedStyle(e).overflowY !== 'visible').length, "
                "[...document.querySelectorAll('figure, tr')].filter((e) => "
                "getComputedStyle(e).breakInside !== 'avoid').length, "
                "[...document.querySelectorAll('canvas')].filter((e) => e.offsetParent).length, "
                "getComputedStyle(document.body).backgroundColor]")
            self.assertEqual((clipped, split, canvases), (0, 0, 0))
            self.assertEqual(background, "rgb(253, 253, 252)")
        pdf = self.browser.call("Page.printToPDF", printBackground=True)["data"]
        self.assertTrue(base64.b64decode(pdf).startswith(b"%PDF"))

    def test_an_axis_that_counts_is_linear_with_whole_ticks(self):
        self.browser.open(self.url, 1440, "light")
        types, ticks = self.browser.evaluate(
            "(() => { const s = Chart.getChart(document.querySelector('#set1-match-probes canvas')).scales; "
            "return [[s.x.type, s.y.type], s.x.ticks.map((t) => t.value)]; })()")
        self.assertEqual(types, ["linear", "logarithmic"])
        self.assertEqual(ticks, [0, 1, 2])

    def test_bars_leave_room_for_what_is_written_behind_their_whiskers(self):
        self.browser.open(self.url, 1440, "light")
        ends = self.browser.evaluate(
            "Object.values(Chart.instances).filter((c) => c.config.type === 'bar' && c.scales.x.type === 'linear')"
            ".map((c) => [c.scales.x.max, Math.max(...c.data.datasets.flatMap((d) => d.marks.map((m) => m[5] || m[0])))])")
        self.assertGreater(len(ends), 3)
        for end, most in ends:
            self.assertGreater(end, 1.1 * most)

    def test_all_methods_may_be_hidden_and_shown_again(self):
        self.browser.open(self.url, 1440, "light")
        before = self.browser.evaluate(VISIBLE)
        press_all = "document.querySelectorAll('[data-toggle]').forEach((box) => box.click())"
        log_all = "document.querySelectorAll('[data-log]').forEach((box) => box.click())"
        self.browser.evaluate(press_all)
        self.assertEqual(self.browser.evaluate(VISIBLE), 0)
        self.browser.evaluate(log_all)
        self.browser.evaluate(press_all)
        self.browser.evaluate(log_all)
        self.assertEqual(self.browser.evaluate(VISIBLE), before)
        self.check_silence()

    def test_keyboard_alone_hides_a_method_and_turns_an_axis(self):
        self.browser.open(self.url, 1440, "light")
        before = self.browser.evaluate(VISIBLE)
        self.assertEqual(before, 9)
        turned = hidden = False
        for _ in range(60):
            self.browser.press("Tab", 9)
            kind, outline = self.browser.evaluate(
                "(() => { const e = document.activeElement; return [e.dataset.toggle ? 'toggle' : e.dataset.log || '', "
                "getComputedStyle(e).outlineStyle]; })()")
            if kind == "toggle" and not hidden:
                self.assertEqual(outline, "solid")
                self.browser.press(" ", 32, " ")
                self.assertEqual(self.browser.evaluate(VISIBLE), before - 3)
                hidden = True
            if kind == "set1-trade-time":
                axis = "Chart.getChart(document.querySelector('#set1-trade-time canvas')).scales.x.type"
                first = self.browser.evaluate(axis)
                self.browser.press(" ", 32, " ")
                self.assertNotEqual(self.browser.evaluate(axis), first)
                turned = True
                break
        self.assertTrue(hidden and turned)
        self.check_silence()


if __name__ == "__main__":
    if CHROMIUM is None:
        print("skipped: there is no chromium")
        sys.exit(77)
    unittest.main()
