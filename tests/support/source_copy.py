"""A copy of the sources, to be changed and built."""

import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]


def sources(work):
    """Paths below ROOT of all that may be a source: neither what was built nor what was measured, nor `work`."""
    found = set()
    for name, folders, files in os.walk(ROOT):
        folder = pathlib.Path(name)
        if folder == work or "CMakeCache.txt" in files:
            folders.clear()
            continue
        skipped = {".git", "__pycache__"} | ({"build", "lodbench-results", "shared"} if folder == ROOT else set())
        folders[:] = [child for child in folders if child not in skipped]
        found.update((folder / file).relative_to(ROOT) for file in files)
    return found


def update(work, changed=None):
    """Brings work/source to the state of ROOT, but for the texts in `changed` (by path below ROOT); returns it. What is
    the same keeps its time, and is not built again."""
    source = work / "source"
    wanted = sources(work)
    for path in [path for path in source.rglob("*") if path.is_file()]:
        if path.relative_to(source) not in wanted:
            path.unlink()
    for name in wanted:
        text = (changed or {}).get(str(name))
        content = (ROOT / name).read_bytes() if text is None else text.encode("utf-8")
        copy = source / name
        if not copy.exists() or copy.read_bytes() != content:
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(content)
            copy.chmod((ROOT / name).stat().st_mode)
    return source
