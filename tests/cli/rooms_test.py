"""What each room of the harness may include: methods are seen by nobody, the report by the command line alone.

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
    "gl": {"api", "common"},
    "platform": {"api", "gl"},
    "terrain": {"api", "base"},
    "scenario": {"api", "base", "terrain"},
    "measure": {"api", "base", "gl"},
    "results": {"api", "base", "measure"},
    "picture": {"api", "base", "measure"},
    "report": {"api", "base", "measure", "results", "picture"},
    "run": {"api", "base", "common", "gl", "platform", "terrain", "scenario", "measure", "results", "picture"},
    "conformance": {"api", "base", "common", "gl", "measure", "results", "run"},
}


def includes(room):
    for path in sorted((SOURCE / "harness" / room).rglob("*")):
        if path.suffix in (".h", ".cpp"):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                found = re.match(r'#include "([\w/.]+)/[\w.]+"', line)
                if found:
                    yield f"{path.relative_to(SOURCE)}:{number}: {line}", found.group(1).split("/")[0]


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


if __name__ == "__main__":
    unittest.main()
