"""lodbench view under Xvfb: keys and mouse as a person uses them, and what the window's log says.

usage: view_test.py LODBENCH SOURCE_DIR BROKEN_PLUGINS [unittest argument...]
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

LODBENCH, SOURCE, BROKEN = (pathlib.Path(sys.argv.pop(1)).resolve() for _ in range(3))
PATIENCE_S = 90
SCENARIO = """name = "hills"
[terrain]
synthetic = "ridged"
rows = 257
columns = 257
spacing = 30
[viewport]
width = 480
height = 360
[flight]
kind = "line"
frames = 40
warmup_frames = 2
start = [1000, 1000, 2500]
end = [4000, 4000, 2500]
pitch = -20
[measure]
every = 1
"""


class Display:
    """An X server without a screen."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory()
        reading, writing = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writing), "-screen", "0", "1400x1000x24", "-nolisten", "tcp"],
            pass_fds=[writing], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(writing)
        with open(reading) as number:  # a line, once it listens
            self.name = ":" + number.readline().strip()
        assert self.name != ":", "Xvfb did not start"

    def close(self):
        self.server.terminate()
        self.server.wait()
        self.folder.cleanup()


class Window:
    """lodbench view, and what its log says."""

    def __init__(self, display, folder, *arguments, scenario=None):
        self.folder = pathlib.Path(folder)
        self.scenario = self.folder / "hills.toml"
        self.scenario.write_text(scenario or SCENARIO)
        self.log = self.folder / "log.jsonl"
        self.environment = {**os.environ, "DISPLAY": display.name, "LIBGL_ALWAYS_SOFTWARE": "1"}
        self.process = subprocess.Popen(
            [LODBENCH, "view", self.scenario, "--log", self.log, "--out", self.folder, *map(str, arguments)],
            env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.seen = 0
        self.wait(lambda e: e["event"] == "picture", whole=True)
        self.xdotool("search", "--sync", "--name", "^lodbench view$", "windowfocus", "--sync")

    def xdotool(self, *words):
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True, timeout=PATIENCE_S,
                       stdout=subprocess.DEVNULL)

    def events(self):
        if not self.log.exists():
            return []
        lines = self.log.read_text().split("\n")[:-1]
        return [json.loads(line) for line in lines]

    def state(self):
        return [e for e in self.events() if e["event"] == "state"][-1]

    def wait(self, wanted, whole=False):
        """The first such event since the last key, or of the whole log."""
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            for event in self.events()[0 if whole else self.seen:]:
                if wanted(event):
                    return event
            if self.process.poll() is not None:
                raise AssertionError(f"the window ended: {self.process.stdout.read()}")
            time.sleep(0.05)
        raise AssertionError(f"did not come; last events: {self.events()[-3:]}")

    def wait_state(self, **wanted):
        return self.wait(lambda e: e["event"] == "state" and all(e[k] == v for k, v in wanted.items()))

    def settle(self):
        """Until nothing is under way: no event for a while."""
        count, since = -1, time.monotonic()
        while time.monotonic() - since < 0.7:
            now = len(self.events())
            if now != count:
                count, since = now, time.monotonic()
            time.sleep(0.05)

    def key(self, *names):
        self.seen = len(self.events())
        self.xdotool("key", "--delay", 60, *names)

    def click(self, item, button=1, at=0.5):
        low_x, low_y, high_x, high_y = self.state()["items"][item]
        self.seen = len(self.events())
        self.xdotool("mousemove", int(low_x + at * (high_x - low_x)), (low_y + high_y) // 2)
        time.sleep(0.2)
        self.xdotool("mousedown", button)
        time.sleep(0.2)
        self.xdotool("mouseup", button)

    def close(self):
        if self.process.poll() is None:
            self.process.terminate()
        self.process.wait(PATIENCE_S)
        self.process.stdout.close()


class View(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        for tool in ("Xvfb", "xdotool"):
            assert shutil.which(tool), f"{tool} is missing; scripts/packages names it"
        cls.display = Display()

    @classmethod
    def tearDownClass(cls):
        cls.display.close()

    def window(self, *arguments, **named):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        window = Window(self.display, folder.name, *arguments, **named)
        self.addCleanup(window.close)
        return window

    def finish(self, window):
        """Nothing went wrong, and it closes in good order."""
        self.assertEqual([e for e in window.events() if e["event"] == "gl_error"], [])
        window.key("Escape")
        self.assertEqual(window.process.wait(PATIENCE_S), 0)

    def test_replay_plays_pauses_steps_and_scrubs(self):
        window = self.window("-m", "lindstrom")
        window.key("Right", "Right", "Left")
        first = window.wait_state(frame=1, playing=False)
        window.key("space")
        window.wait_state(playing=True)
        window.wait(lambda e: e["event"] == "state" and e["frame"] > 3)
        window.key("Home")
        window.wait_state(frame=0)
        window.click("frame", at=0.9)
        scrubbed = window.wait(lambda e: e["event"] == "state" and e["frame"] > 25)
        self.assertNotEqual(scrubbed["camera"], first["camera"])
        self.finish(window)

    def test_free_flight_is_recorded_and_run_flies_the_same_cameras_to_the_bit(self):
        window = self.window("-m", "lindstrom")
        window.key("r")
        window.wait_state(recording=True, flying=True)
        window.xdotool("keydown", "w", "keydown", "e")
        time.sleep(1.0)
        window.xdotool("keyup", "w", "keyup", "e")
        window.xdotool("mousemove", 240, 280, "mousedown", 1, "mousemove", 300, 260, "mouseup", 1)
        time.sleep(0.5)
        window.key("r")
        recorded = window.wait(lambda e: e["event"] == "recorded")
        self.assertGreater(recorded["frames"], 20)
        shown = [e["request"]["view"] for e in window.events() if e["event"] == "picture"]
        out = window.folder / "film"
        done = subprocess.run(
            [LODBENCH, "frames", "lindstrom", window.scenario, "--flight", recorded["file"], "--no-reference", "--size",
             "32x24", "-o", out], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(done.returncode, 0, done.stdout)
        flown = json.loads((out / "frames.json").read_text())["cameras"]
        self.assertEqual(len(flown), recorded["frames"])
        self.assertEqual(flown[-1], recorded["camera"])
        among = [camera for camera in shown if camera in flown]
        self.assertGreater(len(set(among)), 3)
        # All that was shown while it was recorded; the first stands on the flight.
        self.assertEqual(set(shown[shown.index(among[0]):]) - set(flown), set())
        self.finish(window)

    def test_camera_is_copied_and_pasted_to_the_bit(self):
        window = self.window("-m", "lindstrom", "--camera", "camera:1200.5,900,1900.25:31.25,-12.5,0:50:2")
        self.assertEqual(window.state()["camera"], "camera:1200.5,900,1900.25:31.25,-12.5,0:50:2")
        window.key("ctrl+c")
        window.wait(lambda e: e["event"] == "message" and e["words"].startswith("copied camera:1200.5"))
        window.xdotool("keydown", "w")
        time.sleep(0.5)
        window.xdotool("keyup", "w")
        window.wait(lambda e: e["event"] == "state" and "1200.5," not in e["camera"])
        window.key("ctrl+v")
        window.wait_state(camera="camera:1200.5,900,1900.25:31.25,-12.5,0:50:2")
        window.key("g")
        window.wait_state(follows=True)
        self.finish(window)

    def test_styles_wireframe_freeze_and_top_view_change_the_picture(self):
        window = self.window("-m", "lindstrom", "--set", "lindstrom.tau=6")
        plain = window.state()
        for style in ("error heat map", "cracks", "colours by level", "shaded"):
            window.key("h")
            window.wait_state(style=style)
            picture = window.wait(lambda e: e["event"] == "picture")
            self.assertEqual(picture["pixel_max_px"] is not None, style in ("error heat map", "cracks"))
        window.key("f")
        window.wait_state(wireframe=True)
        self.assertTrue(window.wait(lambda e: e["event"] == "picture")["request"]["wireframe"])
        window.key("f", "z")
        window.wait_state(frozen=True, wireframe=False)
        window.xdotool("keydown", "s")
        time.sleep(0.5)
        window.xdotool("keyup", "s")
        moved = window.wait(lambda e: e["event"] == "picture" and e["request"]["view"] != e["request"]["selected"])
        self.assertEqual(moved["request"]["selected"], plain["camera"])
        window.settle()
        frozen = [e for e in window.events() if e["event"] == "picture"][-1]
        window.key("x")
        window.wait_state(culling_frozen=False)
        whole = window.wait(lambda e: e["event"] == "picture")
        self.assertEqual(window.state()["settings"][0].get("culling"), "false")
        self.assertGreater(whole["triangles"], frozen["triangles"])
        window.key("x", "z", "t")
        window.wait_state(frozen=False, top=True, culling_frozen=True)
        top = window.wait(lambda e: e["event"] == "picture" and not e["request"]["frozen"] and
                          e["request"]["view"] != e["request"]["selected"])["request"]
        height = [float(top[which].split(":")[1].split(",")[2]) for which in ("view", "selected")]
        self.assertGreater(height[0], height[1] + 500)
        self.finish(window)

    def test_two_methods_stand_side_by_side_split_apart_and_blink(self):
        window = self.window("-m", "lindstrom", "-m", "full-grid")
        self.assertEqual(window.state()["layout"], "split")
        window.wait(lambda e: e["event"] == "picture" and e["side"] == 1, whole=True)
        window.key("o")  # panels are in the way
        window.settle()
        window.seen = len(window.events())
        window.xdotool("mousemove", 240, 200, "mousedown", 1, "mousemove", 300, 200, "mousemove", 336, 200, "mouseup", 1)
        window.wait(lambda e: e["event"] == "state" and abs(e["split"] - 0.7) < 0.01)
        for layout in ("difference", "blink", "single", "side by side"):
            window.key("l")
            window.wait_state(layout=layout)
        half = window.wait(lambda e: e["event"] == "picture" and e["width"] == 240)
        self.assertEqual(half["height"], 360)
        self.finish(window)

    def test_method_is_switched_and_its_parameters_are_set_live(self):
        window = self.window("-m", "lindstrom")
        window.click("method 1")
        window.wait(lambda e: e["event"] == "state" and "choose full-grid" in e["items"])
        window.settle()
        window.click("choose full-grid")
        window.wait(lambda e: e["event"] == "opened" and e["method"] == "full-grid")
        full = window.wait(lambda e: e["event"] == "picture")
        window.key("n")
        previous = window.wait(lambda e: e["event"] == "opened")
        self.assertNotEqual(previous["method"], "full-grid")
        window.key("m")
        window.wait(lambda e: e["event"] == "opened" and e["method"] == "full-grid")
        while window.state()["methods"][0] != "lindstrom":
            window.key("m")
            window.wait(lambda e: e["event"] == "opened")
            window.settle()
        window.key("bracketright")
        coarser = window.wait(lambda e: e["event"] == "opened")
        self.assertIn("tau", coarser["settings"])
        drawn = window.wait(lambda e: e["event"] == "picture")
        self.assertLess(drawn["triangles"], full["triangles"])
        window.settle()
        window.click("1 tau", at=0.2)
        slid = window.wait(lambda e: e["event"] == "opened")
        self.assertNotEqual(slid["settings"]["tau"], coarser["settings"]["tau"])
        self.finish(window)

    def test_measured_frame_and_what_lies_below_the_cursor(self):
        window = self.window("-m", "lindstrom", "--set", "lindstrom.tau=6")
        window.key("Right")
        window.wait_state(frame=1)
        window.key("i")
        measured = window.wait(lambda e: e["event"] == "measured")
        self.assertTrue(measured["flown"])
        out = window.folder / "run"
        subprocess.run([LODBENCH, "run", window.scenario, "-m", "lindstrom", "--set", "lindstrom.tau=6", "--override",
                        "run.repetitions=1", "--override", "measure.every=1", "--out", out], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        header, *rows = next((out / "frames").iterdir()).read_text().splitlines()
        flown = dict(zip(header.split(","), rows[1].split(",")))
        record = dict(zip(header.split(","), measured["record"]))
        for name in ("triangles", "crack_pixels", "draw_calls", "uncovered_samples"):
            self.assertEqual(int(flown[name]), record[name], name)
        for name in ("screen_max_px", "screen_p999_px", "pixel_max_px", "pixel_p999_px", "height_rmse_m", "psnr_db"):
            self.assertEqual(float(flown[name]), record[name], name)
        window.key("o")  # the panel is in the way
        window.settle()
        window.seen = len(window.events())
        window.xdotool("mousemove", 240, 270, "click", 3)
        probed = window.wait(lambda e: e["event"] == "probed")
        self.assertTrue(probed["hit"])
        self.assertGreaterEqual(probed["level"], 0)
        self.finish(window)

    def test_method_that_crashes_falls_alone_and_the_window_says_which_and_why(self):
        window = self.window("-m", "full-grid", "--plugin-dir", BROKEN / "segfaults")
        before = window.wait(lambda e: e["event"] == "opened", whole=True)["process"]
        window.click("method 1")
        window.wait(lambda e: e["event"] == "state" and "choose segfaults" in e["items"])
        window.settle()
        window.click("choose segfaults")
        fell = window.wait(lambda e: e["event"] == "fell")
        self.assertEqual(fell["words"], "'segfaults' of segfaults.so fell: segmentation fault (signal 11), in draw")
        again = window.wait(lambda e: e["event"] == "opened" and e["method"] == "full-grid")
        self.assertNotEqual(again["process"], before)  # how soon, session_gl_test says
        self.finish(window)

    def test_help_overlay_and_screenshot(self):
        window = self.window("-m", "lindstrom")
        window.key("F1", "o")
        window.wait_state(help=True, overlay=False)
        window.key("F12")
        shot = window.wait(lambda e: e["event"] == "screenshot")
        data = pathlib.Path(shot["file"]).read_bytes()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual((int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")), (480, 360))
        self.finish(window)

    def test_window_is_resized_and_scaled(self):
        window = self.window("-m", "lindstrom", "--scale", "2", "--context", "egl")
        self.assertEqual(window.state()["scale"], 2)
        low, high = window.state()["items"]["frame"][1::2]
        self.assertGreater(high - low, 30)  # 19 at scale 1
        window.seen = len(window.events())
        window.xdotool("search", "--name", "^lodbench view$", "windowsize", 640, 400)
        window.wait_state(width=640, height=400)
        window.wait(lambda e: e["event"] == "picture" and (e["width"], e["height"]) == (640, 400))
        self.finish(window)

    def test_idle_window_takes_no_time(self):
        window = self.window("-m", "lindstrom")
        window.settle()
        time.sleep(1)

        def ticks(process):
            fields = pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
            return int(fields[11]) + int(fields[12])

        child = window.wait(lambda e: e["event"] == "opened", whole=True)["process"]
        before = ticks(window.process.pid) + ticks(child)
        time.sleep(3)
        used = (ticks(window.process.pid) + ticks(child) - before) / os.sysconf("SC_CLK_TCK")
        self.assertLess(used, 0.06)  # of 3 s: 2 %
        self.finish(window)


class NoDisplay(unittest.TestCase):
    def test_one_message_names_what_does_without(self):
        environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
        done = subprocess.run([LODBENCH, "view"], env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              timeout=PATIENCE_S)
        self.assertEqual(done.returncode, 4, done.stdout)
        self.assertEqual(done.stdout.count("\n"), 1, done.stdout)
        self.assertIn("DISPLAY", done.stdout)
        self.assertIn("`lodbench run`", done.stdout)


class Linked(unittest.TestCase):
    def test_nothing_but_the_window_knows_a_window_system(self):
        needed = subprocess.run(["ldd", LODBENCH], stdout=subprocess.PIPE, text=True, check=True).stdout
        self.assertIn("libOpenGL", needed)
        for library in ("glfw", "libX11", "imgui"):
            self.assertNotIn(library, needed)
        self.assertNotIn(b"ImGui", LODBENCH.read_bytes())
        view = LODBENCH.parent / "lodbench-view"
        self.assertIn("glfw", subprocess.run(["ldd", view], stdout=subprocess.PIPE, text=True, check=True).stdout)


if __name__ == "__main__":
    unittest.main()
