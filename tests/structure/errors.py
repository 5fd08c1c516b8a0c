#!/usr/bin/env python3
"""How failures are told, in coordinator/ (CONTRIBUTING.md, "Errors"):

- What a caller has to look at is [[nodiscard]]: a sentence that is empty on success, and what is
  either the result or why there is none.
- Why there is no result is part of what is returned, not put into an argument.
- Only what reads the user's files throws, for itself: the loop and its parts do not.
- Descriptors belong to a type, which closes them."""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
FOLDER = ROOT / "coordinator"

# Of a run, while it goes on.
NEVER_THROW = ("calls", "engine", "host", "network", "os", "policy", "port", "processes", "queues", "tasks", "trace", "world")
CLOSES = {"port/unique_fd.h": "the owner of descriptors", "os/files.cc": "tells whether a file was written whole"}

SENTENCE = re.compile(r"empty on success", re.IGNORECASE)
RESULT = re.compile(r"^\s*(static\s+|virtual\s+)*(LoadResult<|std::variant<[^;]*std::string>\s+\w+\()")
# A declaration of a function that returns a sentence.
DECLARES = re.compile(r"^\s*(static\s+|virtual\s+)*std::string\s+\w+\(")


def comment_above(lines: list[str], number: int) -> str:
    """The lines of comment directly above a line, the declarations that share them included."""
    text = ""
    while number > 0:
        number -= 1
        line = lines[number].strip()
        if not line.startswith("//"):
            break
        text = line.lstrip("/ ") + " " + text
    return text


def mistakes_of(path: Path) -> list[str]:
    name = str(path.relative_to(FOLDER))
    top = name.split("/")[0]
    lines = path.read_text().splitlines()
    found = []

    def note(number: int, what: str) -> None:
        found.append(f"coordinator/{name}:{number + 1}: {what}")

    for number, line in enumerate(lines):
        code = line.split("//")[0]
        if path.suffix == ".h" and "[[nodiscard]]" not in code and "override" not in code:
            if RESULT.match(code) or (DECLARES.match(code) and SENTENCE.search(comment_above(lines, number))):
                note(number, "is not [[nodiscard]], and says whether something has failed")
        if path.suffix == ".h" and re.search(r"std::string\s*\*\s*(error|why|wrong|taken)\b", code):
            note(number, "why there is no result belongs into what is returned")
        if top in NEVER_THROW and re.search(r"\bthrow\b", code):
            note(number, "throws, in a part of the loop")
        if name not in CLOSES and re.search(r"(?<![\w.>])(::)?close\(", code):
            note(number, "closes a descriptor that no UniqueFd owns")
    return found


def main() -> int:
    found = []
    for path in sorted(FOLDER.rglob("*")):
        if path.suffix in (".h", ".cc"):
            found += mistakes_of(path)
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
