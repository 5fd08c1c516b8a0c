#!/usr/bin/env python3
"""Runs the commands of a document as they stand there, one after the other, in one folder and one shell's environment.
    documented_commands.py SOURCE_ROOT FOLDER DOCUMENT...

A line of an indented block that begins with `$ ` is a command; the lines after it, up to the next command or the block's end, are
what it prints: each has to come in its output, with any numbers for its numbers and anything for `…`. documented_commands.txt beside this file names
the commands that a test cannot run as they stand, and why. Commands within lines (`tcsim run --view`) have to name a command and
options that there are."""
import re
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

HERE = Path(__file__).resolve().parent
NUMBER = r"-?\d[\d.,]*"
UNIT = r"(?: ?(?:ns|us|ms|s|%))?"
SAME = [
    (r"missed (?:all \d+|\d+ of \d+) of its", "missed 1 of its"),
    (r"computes (?:[\d.]+ \w+ each time, \d+ % of a core|up to [\d.]+ \w+ at a time)", "computes"),
]
LIKE_A_COMMAND = re.compile(r"    (?:sudo |\./dev|tcsim |docker |apt |export |cd |cmake |git )")


@dataclass
class Command:
    document: str
    line: int
    text: str
    prints: list[str] = field(default_factory=list)

    @property
    def where(self):
        return f"{self.document}:{self.line}: `{self.text}`"


@dataclass
class Exception_:
    line: int
    document: str
    text: str
    instead: str | None  # a command; None: nothing is run
    met: bool = False


def fail(words):
    sys.exit(f"FAILED: {words}")


def commands_of(root, document):
    found, in_block = [], False
    for number, line in enumerate((root / document).read_text().splitlines(), 1):
        if not line.startswith("    "):
            in_block = False
            continue
        if line.startswith("    $ "):
            found.append(Command(document, number, re.sub(r"\s{2,}#.*", "", line[6:]).rstrip()))
            in_block = True
        elif LIKE_A_COMMAND.match(line):
            fail(f"{document}:{number}: a command without `$ `: {line.strip()}")
        elif in_block:
            found[-1].prints.append(line[4:])
    return found


def exceptions():
    """`DOCUMENT | COMMAND | not run: REASON` or `DOCUMENT | COMMAND | instead: COMMAND (REASON)`."""
    found = []
    for number, line in enumerate((HERE / "documented_commands.txt").read_text().splitlines(), 1):
        if not line or line.startswith("#"):
            continue
        parts = line.split(" | ")
        how = re.fullmatch(r"not run: .+|instead: (.+) \(.+\)", parts[2]) if len(parts) == 3 else None
        if not how:
            fail(f"documented_commands.txt:{number}: not as the head of the file says")
        found.append(Exception_(number, parts[0], parts[1], how[1]))
    return found


def pattern(line):
    """A line that was printed, with any numbers and any lengths of spaces; `…` is anything."""
    out = ""
    for piece in re.split(rf"({NUMBER}{UNIT}|…|\s+)", line.strip()):
        if re.fullmatch(NUMBER + UNIT, piece or " "):
            out += NUMBER + UNIT
        elif piece == "…":
            out += ".*"
        else:
            out += r"\s+" if piece and piece.isspace() else re.escape(piece)
    return re.compile(out)


def plain(line):
    """Without what may be said in two ways of like runs: of how many all are, and whether each took as long."""
    for many, one in SAME:
        line = re.sub(many, one, line)
    return line.strip()


def run(command, text, shell):
    shell.stdin.write(f"{text}\nprintf '\\n%s %s\\n' \"$mark\" $?\n")
    shell.stdin.flush()
    said = []
    for line in shell.stdout:
        if line.startswith("@@end-of-command "):
            break
        said.append(line.rstrip("\n"))
    else:
        fail(f"{command.where} ended the shell: " + "\n".join(said[-20:]))
    if line.split()[1] != "0":
        fail(f"{command.where} ended with {line.split()[1]}: " + "\n".join(said[-20:]))
    for wanted in command.prints:
        if wanted.strip() and not any(pattern(plain(wanted)).fullmatch(plain(line)) for line in said):
            fail(f"{command.where} does not print `{wanted.strip()}`, but: " + "\n".join(said[-20:]))
    print(f"{command.where}\n" + "\n".join(said), flush=True)


def check_names(root, document):
    """Commands within lines name a command of tcsim, or of ./dev, and options that it has."""
    helps = {}

    def help_of(*words):
        if words not in helps:
            helps[words] = subprocess.run([*words], capture_output=True, text=True).stdout
        return helps[words]

    for number, line in enumerate((root / document).read_text().splitlines(), 1):
        for code in re.findall(r"`([^`]+)`", line):
            where = f"{document}:{number}: `{code}`"
            words = code.split()
            if words[0] == "./dev" and len(words) > 1 and re.fullmatch("[a-z]+", words[1]):
                if not re.search(rf"^  {words[1]}\b", help_of(str(root / "dev"), "help"), re.MULTILINE):
                    fail(f"{where}: ./dev has no such command")
            if words[0] != "tcsim" or len(words) < 2 or not re.fullmatch("[a-z]+", words[1]):
                continue
            if not re.search(rf"^  {words[1]} ", help_of("tcsim", "--help"), re.MULTILINE):
                fail(f"{where}: tcsim has no such command")
            for option in re.findall(r"(?<= )--[a-z][a-z-]*", code.split(" -- ")[0]):
                if option not in help_of("tcsim", words[1], "--help"):
                    fail(f"{where}: {words[1]} has no {option}")


def main():
    root, folder, documents = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:]
    every = exceptions()
    for document in documents:
        check_names(root, document)
        commands = commands_of(root, document)
        shell = subprocess.Popen(["bash"], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                 text=True)
        shell.stdin.write("mark=@@end-of-command\n")
        for command in commands:
            other = [e for e in every if e.document == document and e.text == command.text]
            for e in other:
                e.met = True
            if other and other[0].instead is None:
                print(f"{command.where} is not run", flush=True)
                continue
            run(command, other[0].instead if other else command.text, shell)
        shell.stdin.close()
        shell.wait()
        for e in every:
            if e.document == document and not e.met:
                fail(f"documented_commands.txt:{e.line}: {document} has no command `{e.text}` any more")


if __name__ == "__main__":
    main()
