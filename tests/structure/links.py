#!/usr/bin/env python3
"""Every link of the documents to a file or a heading of the project leads there. A heading's anchor
is made as GitHub makes it."""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")


def pages() -> list[Path]:
    folders = [ROOT, ROOT / "docs", ROOT / "examples"]
    return sorted({*ROOT.glob("*.md"), *(page for folder in folders[1:] for page in folder.rglob("*.md"))})


def without_code(text: str) -> str:
    """Blocks of code and code within lines link nowhere."""
    text = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
    lines = [line for line in text.splitlines() if not line.startswith("    ") or line.lstrip().startswith("- ")]
    return re.sub(r"`[^`]*`", "", "\n".join(lines))


def anchors(page: Path) -> set[str]:
    found: set[str] = set()
    text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
    for heading in re.findall(r"^#+ +(.*?) *$", text, flags=re.MULTILINE):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        anchor = re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")
        number, name = 1, anchor
        while name in found:
            name, number = f"{anchor}-{number}", number + 1
        found.add(name)
    return found


def mistakes() -> list[str]:
    found = []
    for page in pages():
        for link in LINK.findall(without_code(page.read_text())):
            if re.match(r"[a-z]+:", link):
                continue
            path, _, anchor = link.partition("#")
            target = (page.parent / path).resolve() if path else page
            where = f"{page.relative_to(ROOT)}: the link {link}"
            if not target.exists():
                found.append(f"{where} leads to no file; correct it")
            elif anchor and target.suffix == ".md" and anchor not in anchors(target):
                found.append(f"{where} leads to no heading of that page; correct it")
    return found


found = mistakes()
if found:
    print(*found, sep="\n")
sys.exit(1 if found else 0)
