#!/usr/bin/env python3
"""The table of folders in docs/ARCHITECTURE.md is true: every folder of the sources has a row, and
includes what its row says and nothing else. No folder includes one that includes it, whatever is
between them. A name of the last column that is no folder of the
project's is one in coordinator/; words without marks are for readers."""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PAGE = ROOT / "docs/ARCHITECTURE.md"
TOPS = ("shm", "libtcs_preload", "coordinator", "simbody_bridge")
SOURCES = (".h", ".cc", ".c")


def full(name: str) -> str:
    return name if name.split("/")[0] in TOPS else f"coordinator/{name}"


def marked(cell: str) -> list[str]:
    return [full(name) for name in re.findall(r"`([^`]+)`", cell)]


def rules() -> dict[str, list[str]]:
    """For each folder, with a slash at its end, what it may include: folders or files."""
    found = {}
    for line in PAGE.read_text().splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if line.startswith("| `") and len(cells) == 3 and cells[0].endswith("/`"):
            for folder in marked(cells[0]):
                found[folder] = marked(cells[2])
    return found


Sources = dict[str, list[tuple[int, str]]]


def sources() -> Sources:
    """For each source its lines that include something of the project: their numbers, and what."""
    found = {}
    for top in TOPS:
        for path in sorted((ROOT / top).rglob("*")):
            if path.suffix not in SOURCES:
                continue
            included = found.setdefault(str(path.relative_to(ROOT)), [])
            for number, line in enumerate(path.read_text().splitlines(), 1):
                include = re.match(r'\s*#\s*include "([^"]+)"', line)
                if include is not None and include[1].split("/")[0] in TOPS:
                    included.append((number, include[1]))
    return found


def folders_included(of_sources: Sources) -> dict[str, dict[str, str]]:
    """For each folder, the others that it includes, with one line that does. The shim is one, and so is the bridge."""
    def folder_of(path: str) -> str:
        top = path.split("/")[0]
        return top if top in ("libtcs_preload", "simbody_bridge") else path.rpartition("/")[0]

    found = {}
    for name, lines in of_sources.items():
        of = folder_of(name)
        for number, what in lines:
            into = folder_of(what)
            if into != of:
                found.setdefault(of, {}).setdefault(into, f"{name}:{number}")
    return found


def circle(included: dict[str, dict[str, str]]) -> list[str]:
    """The folders of one circle, in order; none if there is none."""
    done, way = set(), []

    def walk(folder: str) -> list[str]:
        if folder in way:
            return way[way.index(folder):]
        if folder in done:
            return []
        way.append(folder)
        for into in included.get(folder, {}):
            if found := walk(into):
                return found
        way.pop()
        done.add(folder)
        return []

    return next((found for folder in included if (found := walk(folder))), [])


def circles(of_sources: Sources) -> list[str]:
    included = folders_included(of_sources)
    found = circle(included)
    if not found:
        return []
    pairs = zip(found, found[1:] + found[:1])
    steps = [f"{of} includes {into} ({included[of][into]})" for of, into in pairs]
    return ["folders include each other in a circle: " + ", ".join(steps)]


def mistakes(of_sources: Sources) -> list[str]:
    allowed = rules()
    if not allowed:
        return [f"{PAGE}: no table of folders was found"]
    found = [f"{PAGE}: there is no folder {folder}" for folder in allowed if not (ROOT / folder).is_dir()]
    for name, lines in of_sources.items():
        of = max((f for f in allowed if name.startswith(f)), key=len, default=None)
        if of is None:
            found.append(f"{name}: its folder has no row in {PAGE}")
            continue
        for number, what in lines:
            if not what.startswith((of, *allowed[of])):
                found.append(f"{name}:{number}: {of} may not include {what}")
    return found


if __name__ == "__main__":
    read = sources()
    found = mistakes(read) + circles(read)
    print("\n".join(found))
    sys.exit(1 if found else 0)
