#!/usr/bin/env python3
"""How many parts the arm misses, on computers of different speeds with one, two and four cores: runs it
and draws the figure. `./dev figure arm` calls it."""
import re
import statistics
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parent.parent))
import sweep

SPEEDS = [0.02, 0.03, 0.05, 0.08, 0.12]
CORES = [1, 2, 4]


def result(folder):
    """What the belt sums up: how many parts it offered, and how many were missed."""
    said = (Path(folder) / "line-belt.out.log").read_text()
    found = re.search(r"^parts offered (\d+), taken (\d+), in the bin \d+, missed (\d+)", said, re.MULTILINE)
    offered, taken, missed = map(int, found.groups())
    assert offered == taken + missed, found[0]
    return offered, missed


def percent_missed(folder):
    offered, missed = result(folder)
    return 100 * missed / offered


def main():
    build, out = Path(sys.argv[1]), Path(sys.argv[2])
    found = {}
    for cores in CORES:
        folder = out / f"{cores}-cores"
        sweep.run(build / "bin/tcsim", build / "examples/arm/scenario.yaml", folder, "robots.arm.cpu.speed",
                  SPEEDS, options=["--set", f"robots.arm.cpu.cores={cores}"])
        found[f"{cores} core{'s' if cores > 1 else ''}"] = [
            (speed, [percent_missed(trial) for trial in trials])
            for speed, trials in sweep.folders(folder, SPEEDS)]
    sweep.print_table(("cpu.speed", "parts missed [%]"), found)
    sweep.draw(out / "missed.svg", "An arm at a running belt", "speed of its computer", "parts missed [%]", found,
               middle=statistics.mean)


if __name__ == "__main__":
    main()
