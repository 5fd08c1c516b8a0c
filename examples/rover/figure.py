#!/usr/bin/env python3
"""How often the rover and the people collide, on computers of different speeds, and beside another
process on the same computer: drives it and draws the figures. `./dev figure rover` calls it."""
import math
import statistics
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parent.parent))
import sweep

SPEEDS = [0.02, 0.05, 0.12, 0.5]
PERCENT = [0, 50, 100]
SHARED_SPEED = 0.05  # of the computer that the other process eats from
WALKERS = [f"crowd/walker{i}" for i in range(1, 8)]
HALF_LENGTH_M, HALF_WIDTH_M, WALKER_M = 0.2, 0.2, 0.2
TOUCH_M, APART_M = 0.01, 0.1


def gap(rover, walker):
    """Between the rover's sides and a walker."""
    dx, dy = walker["x_m"] - rover["x_m"], walker["y_m"] - rover["y_m"]
    heading = 2 * math.atan2(rover["qz"], rover["qw"])
    ahead = math.cos(heading) * dx + math.sin(heading) * dy
    aside = math.cos(heading) * dy - math.sin(heading) * dx
    return math.hypot(max(0, abs(ahead) - HALF_LENGTH_M), max(0, abs(aside) - HALF_WIDTH_M)) - WALKER_M


def collisions(folder):
    """Where the rover and a walker begin to touch: (time, x, y) of the rover. Who touches collides once, until they are
    apart again."""
    rover = sweep.track(folder, "rover/base_link")
    found = []
    for name in WALKERS:
        touching = False
        for at, walker in zip(rover, sweep.track(folder, name)):
            distance = gap(at, walker)
            if not touching and distance < TOUCH_M:
                found.append((at["time_s"], at["x_m"], at["y_m"]))
            touching = distance < TOUCH_M or (touching and distance < APART_M)
    return found


def collisions_per_minute(folder):
    return 60 * len(collisions(folder)) / sweep.track(folder, "rover/base_link")[-1]["time_s"]


def main():
    build, out = Path(sys.argv[1]), Path(sys.argv[2])
    scenario = build / "examples/rover/scenario.yaml"

    def figure(name, key, values, title, label, options=()):
        sweep.run(build / "bin/tcsim", scenario, out / name, key, values, trials=6, options=options)
        found = {"rover": [(value, [collisions_per_minute(folder) for folder in folders])
                           for value, folders in sweep.folders(out / name, values)]}
        sweep.print_table((label, "collisions a minute"), found)
        sweep.draw(out / f"{name}.svg", title, label, "collisions a minute", found,
                   logarithmic=name == "speed", middle=statistics.mean)

    figure("speed", "robots.rover.cpu.speed", SPEEDS, "A rover among people", "speed of its computer")
    figure("eater", "robots.rover.clients.eater.command.1", PERCENT,
           "A process beside the planner", "percent of the time that the other process eats",
           ["--set", f"robots.rover.cpu.speed={SHARED_SPEED}"])


if __name__ == "__main__":
    main()
