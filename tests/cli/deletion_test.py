"""Deleting a method deletes its folder and its line, and nothing else has to change.

usage: deletion_test.py WORK_DIR

In a copy of the sources each method is deleted, one after another; what remains is configured with its tests and
benchmarks, program, plugins and benchmarks are built, and `lodbench list` shows the others. The copy and its build stay
in WORK_DIR, so that the next run builds only what has changed.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
import source_copy  # noqa: E402

WORK = pathlib.Path(sys.argv.pop(1)).resolve()
LINE = re.compile(r"^add_subdirectory\((\w+)\)\n", re.MULTILINE)
LINES = (source_copy.ROOT / "methods/CMakeLists.txt").read_text(encoding="utf-8")
# `common` is what methods share, and `template` what new-method copies.
METHODS = [name for name in LINE.findall(LINES) if name not in ("common", "template")]


def ids_of(method):
    return {name for path in (source_copy.ROOT / "methods" / method).glob("*.cpp")
            for name in re.findall(r'\.id = "([\w-]+)"', path.read_text(encoding="utf-8"))}


def run(*command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                          timeout=3600)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: status {done.returncode}\n{done.stdout[-6000:]}")
    return done.stdout


def built_without(method):
    """The ids that are listed once a method has been deleted."""
    source, build = source_copy.update(WORK), WORK / "build"
    if method:
        shutil.rmtree(source / "methods" / method)
        (source / "methods/CMakeLists.txt").write_text(LINES.replace(f"add_subdirectory({method})\n", ""))
    shutil.rmtree(build / "plugins", ignore_errors=True)  # a build leaves the plugin of a method that is gone
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    # Built to be linked and asked for its methods, not to be fast.
    run("cmake", "-S", source, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O0",
        *launcher)
    run("cmake", "--build", build, "--parallel", "2", "--target", "lodbench_and_plugins", "lodbench_benchmarks")
    listed = json.loads(run(build / "bin/lodbench", "list", "--json"))
    return {method["id"] for method in listed["methods"]}


class Deletion(unittest.TestCase):
    def test_of_each_method(self):
        self.assertGreaterEqual(len(METHODS), 6)
        everything = built_without(None)
        for method in METHODS:
            with self.subTest(method=method):
                self.assertTrue(ids_of(method))
                self.assertLessEqual(ids_of(method), everything)
                self.assertEqual(built_without(method), everything - ids_of(method))


if __name__ == "__main__":
    unittest.main(verbosity=2)
