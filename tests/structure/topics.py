#!/usr/bin/env python3
"""Every scenario test has one line `# Topics: ...` at the end of its opening comment, and its topics are those of
tests/scenario/topics.txt, each of which some test has. And whatever has such a line is run."""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
FOLDER = ROOT / "tests/scenario"
LIST = FOLDER / "topics.txt"
LINE = re.compile(r"# Topics: ([a-z][a-z -]*(?:, [a-z][a-z -]*)*)\.")


def registered() -> list[str]:
    lists = re.findall(r"foreach\(\s*name\s+([^)]*)\)", (FOLDER / "CMakeLists.txt").read_text())
    return sorted({name for names in lists for name in names.split()})


def mistakes() -> list[str]:
    list_name = LIST.relative_to(ROOT)
    known = [line.split(":")[0] for line in LIST.read_text().splitlines() if line and not line.startswith("#")]
    found = [f"{list_name}: {topic} stands there twice; remove one" for topic in sorted(set(known)) if known.count(topic) > 1]
    names = registered()
    if not names:
        return ["tests/scenario/CMakeLists.txt: no tests were found; mend tests/structure/topics.py"]
    used: set[str] = set()
    for name in names:
        path = FOLDER / f"{name}.sh"
        where = path.relative_to(ROOT)
        if not path.is_file():
            found.append(f"{where}: there is no such file; remove {name} from tests/scenario/CMakeLists.txt")
            continue
        lines = path.read_text().splitlines()
        numbers = [number for number, line in enumerate(lines) if line.startswith("# Topics:")]
        if len(numbers) != 1:
            found.append(f"{where}: has {len(numbers)} lines '# Topics: ...'; give it one, below what it asserts")
            continue
        at = numbers[0]
        said = LINE.fullmatch(lines[at])
        if said is None:
            found.append(f"{where}:{at + 1}: write it as '# Topics: one, another.'")
            continue
        if not lines[at - 1].startswith("# ") or any(line and line[0] != "#" and not line.startswith("source ") for line in lines[:at]):
            found.append(f"{where}:{at + 1}: move the topics to the end of the opening comment")
        topics = said[1].split(", ")
        used.update(topics)
        for topic in topics:
            if topic not in known:
                found.append(f"{where}:{at + 1}: there is no topic {topic}; take one of {list_name}, or add it there")
            elif topics.count(topic) > 1:
                found.append(f"{where}:{at + 1}: has {topic} more than once; remove one")
    for path in sorted(FOLDER.glob("*.sh")):
        if path.stem not in names and any(LINE.fullmatch(line) for line in path.read_text().splitlines()):
            found.append(f"{path.relative_to(ROOT)}: nobody runs it; name it in tests/scenario/CMakeLists.txt")
    found += [f"{list_name}: no test is about {topic}; remove it, or name it in a test" for topic in known if topic not in used]
    return found


if __name__ == "__main__":
    found = mistakes()
    print(*found, sep="\n", end="\n" if found else "")
    sys.exit(1 if found else 0)
