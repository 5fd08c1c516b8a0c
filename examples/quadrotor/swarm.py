#!/usr/bin/env python3
"""Prints scenario.yaml with N quadrotors in the place of the one, a metre apart, without the push and what is
expected, and with planners that plan five times a second:

    ./swarm.py 10 >swarm.yaml              rate loops of 1 kHz
    ./swarm.py 30 --hz 250 >swarm.yaml

Whatever is called drone there is called drone0, drone1 … here."""
import argparse
import re
from pathlib import Path

PLANS_HZ = 5  # of one quadrotor's planner, which plans as often as it can, and takes a tenth of this computer


def parts(text):
    """The entries of the scenario's maps (two blanks deep, with what is deeper), and what is between."""
    return re.findall(r"^  \S.*\n(?:   .*\n)*|^.*\n", text, re.MULTILINE)


def one_of_many(entry, number, hz):
    x, y = number % 6, number // 6
    entry = entry.replace("position: [0, 0,", f"position: [{x}, {y},")
    entry = entry.replace('"0", "0", "2"', f'"{x}", "{y}", "2", "{PLANS_HZ}"')
    entry = entry.replace('[./rate_loop, "${run}/drone"]', f'[./rate_loop, "${{run}}/drone", "{hz}"]')
    entry = entry.replace("rate: 1000,", f"rate: {hz},")
    return entry.replace("drone", f"drone{number}")


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("drones", type=int)
    options.add_argument("--hz", type=int, default=1000, help="of the rate loops")
    options = options.parse_args()
    text = (Path(__file__).parent / "scenario.yaml").read_text()
    for entry in parts(text.split("\nexpect:")[0] + "\n"):
        if entry.startswith("  drone") and "push" not in entry.split(":")[0]:
            for number in range(options.drones):
                print(one_of_many(entry, number, options.hz), end="")
        elif not entry.startswith(("  referee", "  drone_push")):
            print(entry, end="")


if __name__ == "__main__":
    main()
