"""What the pages and --help say of the commands is the same, and true.

usage: documents_test.py SOURCE_DIR LODBENCH_BINARY
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv.pop(1)).resolve()
BINARY = str(pathlib.Path(sys.argv.pop(1)).resolve())
STAND_INS = str(pathlib.Path(BINARY).parents[1] / "broken-plugins/stand_ins")
PAGES = {path: path.read_text() for path in
         [SOURCE / "README.md", SOURCE / "CONTRIBUTING.md", *sorted((SOURCE / "docs").glob("*.md"))]}


def run(*arguments):
    done = subprocess.run([BINARY, *arguments], capture_output=True, text=True, timeout=60)
    return done.returncode, done.stdout + done.stderr


def subcommands(help_text):
    _, _, listed = help_text.partition("Subcommands:")
    return re.findall(r"^  ([a-z][a-z-]*)", listed, re.MULTILINE)


def commands():
    """Every command as a list of words: ['run'], ['terrain', 'info'], ..."""
    for name in subcommands(run("--help")[1]):
        inner = subcommands(run(name, "--help")[1])
        yield from ([name, word] for word in inner) if inner else ([[name]])


def page(name):
    return PAGES[SOURCE / name]


def code_lines():
    for text in PAGES.values():
        for block in re.findall(r"^```(?:sh|console)?\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
            yield from block.splitlines()


class Documents(unittest.TestCase):
    def test_readme_is_read_in_one_go(self):
        self.assertLessEqual(len(page("README.md").encode()), 8000)

    def test_manual_lists_the_commands_that_help_lists(self):
        table = re.findall(r"^\| `lodbench ([a-z -]+?)(?= [^a-z]|`)", page("docs/manual.md"),
                           re.MULTILINE)
        self.assertEqual(sorted(table), sorted(" ".join(command) for command in commands()))

    def test_every_command_has_help(self):
        for command in [[], ["terrain"], ["trend"], *commands()]:
            status, text = run(*command, "--help")
            self.assertEqual(status, 0, text)
            self.assertIn("--help", text, command)

    def test_what_is_no_command_is_refused_with_status_2(self):
        for words in [["fly"], ["--fly"], ["terrain", "fly"], ["run", "--fly"], []]:
            status, text = run(*words)
            self.assertEqual(status, 2, (words, text))
            self.assertLessEqual(len(text.splitlines()), 3, text)

    def test_pages_use_options_that_exist(self):
        used = 0
        for line in code_lines():
            call = re.match(r"^(?:\S*/)?lodbench ((?:terrain |trend )?[a-z-]+)(.*)", line)
            if not call:
                continue
            help_text = run(*call.group(1).split(), "--help")[1]
            for option in re.findall(r"(?<=\s)(--?[a-z][a-z-]*)", re.split("#|&&", call.group(2))[0]):
                used += 1
                self.assertRegex(help_text, rf"(?<![\w-]){option}(?![\w-])", line)
        self.assertGreater(used, 5)

    def test_results_page_names_every_field_of_a_cell(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "out"
            status, text = run("run", str(SOURCE / "scenarios/trade/high.toml"), "--method", "template", "--frames", "2", "--size", "64x48",
                               "--repeat", "1", "--out", str(out))
            self.assertEqual(status, 0, text)
            cell = json.loads((out / "cells.jsonl").read_text().splitlines()[0])
            for name in re.findall(r"`([\w./]+)`", page("docs/results.md").split("In cells.jsonl")[0]):
                if "/" not in name.rstrip("/"):
                    self.assertTrue((out / name).exists(), name)
        fields = page("docs/results.md").split("## Fields of a cell")[1].split("\nIn ")[0]
        self.assertEqual(sorted(re.findall(r"^\| `(\w+)` \|", fields, re.MULTILINE)), sorted(set(cell) - {"checksum"}))

    def test_snippets_of_the_results_page_run_on_the_tables_of_a_sweep(self):
        scenario = ('[terrain]\nsynthetic = "ridged"\nrows = 65\ncolumns = 65\nspacing = 10\n[viewport]\nwidth = 64\n'
                    'height = 48\n[flight]\nkind = "line"\nframes = 2\nwarmup_frames = 0\nstart = [320, 50, 400]\n'
                    'end = [320, 300, 400]\npitch = -30\n[run]\nrepetitions = 1\n')
        system = shutil.which("python3", path="/usr/bin") or sys.executable  # whose modules are those of packages
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "s.toml").write_text(scenario)
            for command in (["sweep", "s.toml", "--method", "refined", "--method", "every-sample", "--points", "3"],
                            ["report", "sweep", "--csv", "tables"]):
                out = ["-o", "sweep" if command[0] == "sweep" else "page.html"]
                done = subprocess.run([BINARY, *command, *out], cwd=folder, capture_output=True, text=True,
                                      env={**os.environ, "LODBENCH_PLUGIN_PATH": STAND_INS})
                self.assertEqual(done.returncode, 0, done.stderr)
            snippets = re.findall(r"^```(python|gnuplot)\n(.*?)^```", page("docs/results.md"), re.MULTILINE | re.DOTALL)
            self.assertEqual(sorted(language for language, _ in snippets), ["gnuplot", "python", "python"])
            for language, code in snippets:
                with self.subTest(language=language, code=code):
                    if language == "gnuplot" and shutil.which("gnuplot") is None:
                        self.skipTest("no gnuplot")
                    if "pandas" in code and subprocess.run([system, "-c", "import pandas"],
                                                           capture_output=True).returncode != 0:
                        self.skipTest("no pandas")
                    program = ["gnuplot", "-"] if language == "gnuplot" else [system, "-"]
                    done = subprocess.run(program, input=code, cwd=folder, capture_output=True, text=True)
                    self.assertEqual((done.returncode, done.stderr), (0, ""))
                    if language == "python":
                        self.assertIn("every-sample", done.stdout)
                    else:
                        self.assertIn("</svg>", (folder / "error.svg").read_text())

    def test_pages_point_at_files_that_exist(self):
        linked = set()
        for path, text in PAGES.items():
            for target in re.findall(r"\]\(([^)#:]+)\)", text):
                self.assertTrue((path.parent / target).exists(), f"{path}: {target}")
                linked.add((path.parent / target).resolve())
            for folder in re.findall(r"^\| `([a-z.][\w./]*/)` \|", text, re.MULTILINE):
                self.assertTrue((SOURCE / folder).is_dir(), f"{path}: {folder}")
        self.assertEqual([p for p in PAGES if p.name != "README.md" and p not in linked], [], "pages that none names")

    def test_scripts_have_help(self):
        for script in ["demo", "test", "check-clean", "update-baseline", "compare-commits"]:
            done = subprocess.run([SOURCE / "scripts" / script, "--help"], capture_output=True,
                                  text=True, timeout=60, cwd="/")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertTrue(done.stdout.startswith(f"usage: scripts/{script}"), done.stdout)


if __name__ == "__main__":
    unittest.main()
