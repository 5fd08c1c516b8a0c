#!/usr/bin/env python3
"""docs/COVERAGE.md from coverage.txt (`coverage.py write`), and the test that both are true
(`coverage.py check BUILD`)."""
import re
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PAGE = ROOT / "docs/COVERAGE.md"
HOW = {
    "shim": "virtual",
    "inside": "virtual",
    "vdso": "virtual",
    "code": "virtual",
    "trapped": "virtual",
    "kernel": "**the kernel's**",
}
NOT_VIRTUAL = ("kernel",)


@dataclass
class Row:
    line: int
    how: str
    names: list[str]
    treatment: str
    tests: list[str]


@dataclass
class Family:
    title: str
    rows: list[Row] = field(default_factory=list)


def content_lines(path):
    for number, text in enumerate(path.read_text().splitlines(), 1):
        text = text.split("#")[0].strip()
        if text:
            yield number, text


def read_families():
    families = []
    for number, text in content_lines(HERE / "coverage.txt"):
        if text.startswith("=="):
            families.append(Family(text.strip("= ")))
            continue
        parts = [part.strip() for part in text.split("|")]
        if len(parts) != 4 or not all(parts) or parts[0] not in HOW or not families:
            sys.exit(f"coverage.txt:{number}: not of the form 'how | names | treatment | tests'")
        families[-1].rows.append(Row(number, parts[0], parts[1].split(), parts[2], parts[3].split()))
    return families


def page(families):
    yield "# Coverage"
    yield ""
    yield "What tcs does with every call that reads time, sleeps, waits or arms a timer, and the tests that show it."
    yield "[LIMITATIONS.md](LIMITATIONS.md) says where a treatment is not exact."
    yield "`tests/coverage/coverage.py write` writes this page from `tests/coverage/coverage.txt`: edit that file."
    for family in families:
        yield f"\n## {family.title[0].upper()}{family.title[1:]}\n"
        yield "| call | time | treatment | test |"
        yield "|---|---|---|---|"
        for row in family.rows:
            names = " ".join(f"`{name}`" for name in row.names)
            tests = " ".join(f"`{test}`" for test in row.tests)
            yield f"| {names} | {HOW[row.how]} | {row.treatment} | {tests} |"


def differences(what, expected, found):
    for name in sorted(expected - found):
        yield f"{name} is in {what}, but not in coverage.txt"
    for name in sorted(found - expected):
        yield f"{name} is in coverage.txt, but not in {what}"


def known_tests(build):
    listed = subprocess.run(["ctest", "-N", "--test-dir", build], capture_output=True, text=True, check=True)
    tests = set(re.findall(r"Test +#\d+: (\S+)", listed.stdout))
    return tests | {re.sub(r"^(conformance\..*)\.(native|measured|fixed)$", r"\1", test) for test in tests}


def problems(families, build):
    if PAGE.read_text() != "\n".join(page(families)) + "\n":
        yield f"{PAGE.relative_to(ROOT)} is not what coverage.py writes"
    rows = [row for family in families for row in family.rows]
    first = {}
    for row in rows:
        for name in row.names:
            if name in first:
                yield f"{name} stands in lines {first[name]} and {row.line} of coverage.txt"
            first[name] = row.line

    def named(*hows):
        return {name for row in rows if row.how in hows for name in row.names}

    def found_in(path, pattern):
        return set(re.findall(pattern, (ROOT / path).read_text(), re.MULTILINE))

    exported = found_in("libtcs_preload/exports.map", r"^ +(\w+);$")
    yield from differences("exports.map", exported, named("shim"))
    trapped = found_in("coordinator/calls/futex_calls.cc", r"^    case (FUTEX_\w+):")
    trapped |= found_in("coordinator/os/trap.cc", r"\b(SYS_\w+)") - {"SYS_futex", "SYS_seccomp"}
    yield from differences("futex_calls.cc and trap.cc", trapped, named("trapped"))
    limitations = set(re.findall(r"\w+", (ROOT / "docs/LIMITATIONS.md").read_text()))
    for name in sorted(named(*NOT_VIRTUAL) - limitations):
        yield f"{name} is not virtual, and docs/LIMITATIONS.md does not say so"
    wanted = {name for _, text in content_lines(HERE / "glibc.txt") for name in text.split()}
    for name in sorted(wanted - set(first)):
        yield f"{name} is in glibc.txt, but not in coverage.txt"
    tests = known_tests(build)
    for row in rows:
        for test in row.tests:
            if test not in tests:
                yield f"coverage.txt:{row.line}: there is no test {test}"


def main():
    families = read_families()
    if sys.argv[1:] == ["write"]:
        PAGE.write_text("\n".join(page(families)) + "\n")
        return
    if len(sys.argv) != 3 or sys.argv[1] != "check":
        sys.exit(__doc__)
    found = list(problems(families, sys.argv[2]))
    if found:
        print(*found, sep="\n")
        sys.exit("mend tests/coverage/coverage.txt, then: tests/coverage/coverage.py write")


main()
