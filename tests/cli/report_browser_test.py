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
# Of the drawing that a plot shows, the groups of marks that are visible.
VISIBLE = ("[...document.querySelectorAll('#set1-curve-wall_ms > svg [data-toggle]')]"
           ".filter((g) => g.getClientRects().length && g.getBoundingClientRect().width > 0).length")


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
                    figures, shown, empty = self.browser.evaluate(
                        "(() => { const shown = [...document.querySelectorAll('figure.plot > svg')]"
                        ".filter((svg) => svg.getClientRects().length); "
                        "return [document.querySelectorAll('figure.plot').length, shown.length, "
                        "shown.filter((svg) => svg.getBoundingClientRect().height < 60).length]; })()")
                    self.assertGreater(figures, 10)
                    self.assertEqual((shown, empty), (figures, 0))
                    self.check_silence()

    def test_on_paper_tables_fit_and_plots_stay_whole(self):
        paper = 718  # pixels between the margins of A4
        for scheme in ("light", "dark"):
            self.browser.open(self.url, paper, scheme)
            self.browser.call("Emulation.setEmulatedMedia", media="print",
                              features=[{"name": "prefers-color-scheme", "value": scheme}])
            clipped, split, shown, background = self.browser.evaluate(
                "[[...document.querySelectorAll('.scroll, table, .legend')].filter((e) => "
                "e.getBoundingClientRect().right > innerWidth || e.scrollHeight > e.clientHeight + 1 "
                "&& getComputedStyle(e).overflowY !== 'visible').length, "
                "[...document.querySelectorAll('figure, tr')].filter((e) => "
                "getComputedStyle(e).breakInside !== 'avoid').length, "
                "[...document.querySelectorAll('figure.plot')].filter((f) => [...f.querySelectorAll(':scope > svg')]"
                ".filter((svg) => svg.getClientRects().length).length !== 1).length, "
                "getComputedStyle(document.body).backgroundColor]")
            self.assertEqual((clipped, split, shown), (0, 0, 0))
            self.assertEqual(background, "rgb(253, 253, 252)")
        pdf = self.browser.call("Page.printToPDF", printBackground=True)["data"]
        self.assertTrue(base64.b64decode(pdf).startswith(b"%PDF"))

    def test_an_axis_that_counts_is_linear_with_whole_ticks(self):
        self.browser.open(self.url, 1440, "light")
        logarithmic, ticks = self.browser.evaluate(
            "(() => { const svg = [...document.querySelectorAll('#set1-match-probes > svg')]"
            ".find((s) => s.getClientRects().length); const last = (axis) => axis.split(' ').pop(); "
            "return [[last(svg.dataset.x), last(svg.dataset.y)], "
            "[...svg.querySelectorAll('text.mid:not(.title)')].map((t) => t.textContent)]; })()")
        self.assertEqual(logarithmic, ["0", "1"])
        self.assertEqual(ticks, ["0", "1", "2"])

    def test_bars_leave_room_for_what_is_written_behind_their_whiskers(self):
        self.browser.open(self.url, 1440, "light")
        ends = self.browser.evaluate(
            "[...document.querySelectorAll('figure.bars > svg')].filter((s) => s.getClientRects().length).map((s) => "
            "[s.getBoundingClientRect().right, Math.max(...[...s.querySelectorAll('.value')]"
            ".map((t) => t.getBoundingClientRect().right))])")
        self.assertGreater(len(ends), 3)
        for end, most in ends:
            self.assertGreaterEqual(end, most)

    def test_a_point_says_what_it_is(self):
        self.browser.open(self.url, 1440, "light")
        x, y = self.browser.evaluate(
            "(() => { const svg = [...document.querySelectorAll('#set1-trade-time > svg')]"
            ".find((s) => s.getClientRects().length); svg.scrollIntoView({block: 'center'}); "
            "const ring = svg.querySelector('[data-toggle=\"method-2\"] .f').getBoundingClientRect(); "
            "return [ring.x + ring.width / 2, ring.y + ring.height / 2]; })()")
        words = "(() => { const tip = document.querySelector('.tip'); return tip.hidden ? '' : tip.textContent; })()"
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        self.assertRegex(self.browser.evaluate(words), r"^method-2 tau=[0-9.]+: [0-9.]+, [0-9.]+$")
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=1, y=1)
        self.assertEqual(self.browser.evaluate(words), "")
        self.check_silence()

    def test_all_methods_may_be_hidden_and_shown_again(self):
        self.browser.open(self.url, 1440, "light")
        before = self.browser.evaluate(VISIBLE)
        press_all = "document.querySelectorAll('input[data-toggle]').forEach((box) => box.click())"
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
                axis = "document.querySelector('#set1-trade-time').classList.contains('log')"
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
