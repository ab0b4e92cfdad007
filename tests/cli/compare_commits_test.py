"""scripts/compare-commits: two commits built side by side and flown by turns. In place of the compiler stands a `cmake`
that puts the test plugin of the commit's choice there: what is built is for other tests.

usage: compare_commits_test.py SOURCE_DIR LODBENCH_BINARY FOLDER_OF_TEST_PLUGINS
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE, BINARY, PLUGINS = (pathlib.Path(sys.argv.pop(1)).resolve() for _ in range(3))

SCENARIO = """name = "tiny"
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
frames = 2
warmup_frames = 0
start = [20, 20, 300]
end = [100, 100, 300]
[measure]
shots = [0]
"""

# A "build" is a lodbench that flies the plugin that the commit's file `flies` names.
CMAKE = """#!/bin/sh
case "$1" in --build) exit 0 ;; esac
mkdir -p build/release/bin
cat >build/release/bin/lodbench <<END
#!/bin/sh
if [ "\\$1" = run ]; then exec {binary} "\\$@" --plugin-dir {plugins}/$(cat flies) --method steady; fi
exec {binary} "\\$@"
END
chmod +x build/release/bin/lodbench
"""


class CompareCommits(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        root = pathlib.Path(scratch.name)
        self.root = root / "repository"
        shutil.copytree(SOURCE / "scripts", self.root / "scripts")
        (self.root / "scripts/packages").write_text("")
        (self.root / "scenarios").mkdir()
        (self.root / "scenarios/demo.toml").write_text(SCENARIO)
        (self.root / ".gitignore").write_text("/build/\n/lodbench-results/\n")
        tools = root / "tools"
        tools.mkdir()
        (tools / "cmake").write_text(CMAKE.format(binary=BINARY, plugins=PLUGINS))
        (tools / "cmake").chmod(0o755)
        self.environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "HOME": str(root)}
        self.git("init", "--quiet")
        self.first, self.same, self.more = (self.commit(*text) for text in (
            ("steady", "first"), ("steady", "same"), ("steady_more", "more")))

    def git(self, *words):
        return subprocess.run(["git", "-c", "user.name=t", "-c", "user.email=t@example.org", *words], cwd=self.root,
                              check=True, capture_output=True, text=True, env=self.environment).stdout.strip()

    def commit(self, flies, message):
        (self.root / "flies").write_text(flies)
        self.git("add", "--all")
        self.git("commit", "--quiet", "--allow-empty", "--message", message)
        return self.git("rev-parse", "HEAD")

    def compare(self, *words):
        done = subprocess.run([self.root / "scripts/compare-commits", *words], cwd="/", capture_output=True, text=True,
                              env=self.environment, timeout=300)
        return done.returncode, done.stdout + done.stderr

    def test_a_change_between_two_commits_is_named_and_equal_ones_are_equal(self):
        out = self.root / "lodbench-results/mine"
        status, text = self.compare(self.first, self.more, "--repetitions", "2", "--out", out,
                                    "--markdown", self.root / "comment.md", "--junit", self.root / "junit.xml")
        self.assertEqual(status, 1, text)
        self.assertIn("steady, tiny: frame 1: triangles 10 before, 11 after (in 1 of 2 frames)", text)
        self.assertIn("frame 1: triangles 10 before, 11 after", (self.root / "comment.md").read_text())
        self.assertIn("<failure", (self.root / "junit.xml").read_text())
        began = []
        for side in ("base", "head"):
            cells = [json.loads(line) for line in (out / side / "cells.jsonl").read_text().splitlines()]
            self.assertEqual([cell["repetition"] for cell in cells], [0, 1])
            began += [(cell["began"], side) for cell in cells]
        self.assertEqual([side for _, side in sorted(began)], ["base", "head", "head", "base"])
        work = self.root / "build/compare-commits"
        self.assertEqual({path.name for path in work.iterdir()}, {self.first, self.more})
        self.assertEqual(self.git("-C", work / self.more, "rev-parse", "HEAD"), self.more)

        status, text = self.compare(self.first, self.same, "--repetitions", "1")
        self.assertEqual(status, 0, text)
        self.assertIn("gate      holds", text)

    def test_what_it_did_not_make_is_left_alone(self):
        mine = self.root / "build/compare-commits" / self.first
        mine.mkdir(parents=True)
        (mine / "thesis.tex").write_text("all of it")
        status, text = self.compare(self.first, self.more, "--repetitions", "1")
        self.assertEqual(status, 2)
        self.assertIn("is no clean worktree of commit", text)
        self.assertEqual((mine / "thesis.tex").read_text(), "all of it")
        full = self.root / "full"
        full.mkdir()
        (full / "x").write_text("")
        status, text = self.compare(self.first, self.more, "--out", full)
        self.assertEqual(status, 2)
        self.assertIn("this folder is not empty", text)

    def test_wrong_words_are_refused(self):
        for words, message in (((self.first,), "two commits are compared, 1 are named"),
                               ((self.first, "nowhere"), "'nowhere' is no commit of this repository"),
                               ((self.first, self.more, "--repetitions", "0"), "expected a whole number"),
                               ((self.first, self.more, "--scenario", "/none"), "there is no such file")):
            status, text = self.compare(*words)
            self.assertEqual(status, 2, words)
            self.assertIn(message, text)
        self.assertFalse((self.root / "build").exists())


if __name__ == "__main__":
    if not shutil.which("git"):
        print("skipped: there is no git")
        sys.exit(77)
    unittest.main()
