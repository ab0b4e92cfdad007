"""What each folder may include: methods are seen by nobody, the report by the command line alone.

usage: rooms_test.py SOURCE_DIR
"""

import pathlib
import re
import sys
import unittest

SOURCE = pathlib.Path(sys.argv.pop(1)).resolve()
# "common" is shaders/common, whose blocks are C++ as well. Only cli is above all of them.
MAY_INCLUDE = {
    "api": set(),
    "base": {"api"},
    "gl": {"api", "common"},  # gl/host is not for methods: see below
    "platform": {"api", "gl"},
    "terrain": {"api", "base"},
    "scenario": {"api", "base", "terrain"},
    "measure": {"api", "base", "gl"},
    "results": {"api", "base", "measure"},
    "compare": {"api", "base", "measure", "results"},
    "picture": {"api", "base", "measure"},
    "trend": {"api", "base", "measure", "results"},
    "report": {"api", "base", "measure", "results", "compare", "picture", "trend"},
    "run": {"api", "base", "common", "gl", "platform", "terrain", "scenario", "measure", "results", "picture"},
    "conformance": {"api", "base", "common", "gl", "measure", "results", "run"},
    "extremes": {"api", "base", "terrain", "scenario", "measure", "results", "report", "run"},
    "window": {"api", "base", "gl", "terrain", "scenario", "measure", "results", "picture", "run"},
    "view": {"api", "base", "scenario", "terrain", "measure", "results", "picture", "run", "window", "cli"},
    "reproduce": {"api", "base", "terrain", "scenario", "measure", "results", "report", "run"},
}


METHODS = {path.parent.name for path in (SOURCE / "methods").glob("*/CMakeLists.txt")} - {"common"}


def sources(folder, *, without=()):
    """The C++ files below a folder, and which they include: place, line and what stands in quotes."""
    for path in sorted((SOURCE / folder).rglob("*")):
        inside = path.relative_to(SOURCE / folder).parts
        if path.suffix in (".h", ".cpp") and not set(without) & set(inside):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                found = re.match(r'#include "([\w/.]+)"', line)
                if found:
                    yield path, f"{path.relative_to(SOURCE)}:{number}: {line}", found.group(1)


def includes(room):
    for _, place, name in sources(f"harness/{room}"):
        if "/" in name:
            yield place, name.split("/")[0]


def ids():
    """What methods are called, and the names of their plugins."""
    for path in (SOURCE / "methods").rglob("*.cpp"):
        yield from re.findall(r'\.id = "([\w-]+)"', path.read_text())
    for path in (SOURCE / "methods").glob("*/CMakeLists.txt"):
        yield from re.findall(r"lodbench_add_method\((\w+)", path.read_text())


class Rooms(unittest.TestCase):
    def test_every_room_is_known(self):
        rooms = {path.name for path in (SOURCE / "harness").iterdir() if path.is_dir()}
        self.assertEqual(rooms, {*MAY_INCLUDE, "cli"})

    def test_no_room_includes_one_above_it(self):
        seen = 0
        for room, allowed in MAY_INCLUDE.items():
            for place, other in includes(room):
                seen += 1
                self.assertIn(other, allowed | {room}, place)
        self.assertGreater(seen, 500)

    def test_nothing_but_methods_includes_a_method(self):
        seen = 0
        for folder in ("harness", "benchmarks", "tests"):
            for path, place, name in sources(folder):
                seen += 1
                elsewhere = any((SOURCE / root / name).exists() for root in ("harness", "shaders", "tests"))
                shared = folder == "tests" and name.startswith("common/")
                self.assertFalse((SOURCE / "methods" / name).exists() and not elsewhere and not shared, place)
                self.assertFalse((path.parent / name).resolve().is_relative_to(SOURCE / "methods"), place)
        self.assertGreater(seen, 1000)

    def test_no_test_of_the_harness_flies_a_method_that_can_be_deleted(self):
        own = set(ids()) - {"template", "template_method"}
        # The demo flies all that there are, and its cluster three of them.
        everything = {"demo_slow_test.cpp", "slurm_test.py"}
        flown = 0
        for path in sorted((SOURCE / "tests").rglob("*")):
            if path.suffix not in (".cpp", ".h", ".py") or path.name in everything:
                continue
            for name in re.findall(r'"--method",\s*"([\w-]+)"|LODBENCH_PLUGINS "/(\w+)\.so', path.read_text()):
                flown += 1
                self.assertFalse(own & set(name), f"{path.relative_to(SOURCE)} flies {name}")
        self.assertGreater(flown, 50)

    def test_a_method_includes_no_other_method(self):
        self.assertGreaterEqual(len(METHODS), 7)
        for method in METHODS | {"common"}:
            for _, place, name in sources(f"methods/{method}"):
                self.assertNotIn(name.split("/")[0], METHODS - {method} if "/" in name else (), place)

    def test_a_plugin_includes_what_is_installed(self):
        seen = 0
        for _, place, name in sources("methods", without=("tests", "bench", "tools")):
            seen += 1
            folder = name.rpartition("/")[0]
            self.assertTrue(folder in {"", "api", "gl", "common"} | METHODS, place)
        self.assertGreater(seen, 100)

    def test_harness_and_benchmarks_name_no_method(self):
        names = set(ids()) - {"template", "template_method"}  # which new-method copies
        self.assertGreater(len(names), 10)
        for folder in ("harness", "benchmarks"):
            for path in sorted((SOURCE / folder).rglob("*")):
                if path.is_file():
                    found = names & set(re.findall(r'"([\w-]+)(?:\.so)?"', path.read_text()))
                    self.assertFalse(found, f"{path.relative_to(SOURCE)} names {found}")


if __name__ == "__main__":
    unittest.main()
