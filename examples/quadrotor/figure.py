#!/usr/bin/env python3
"""How much height the quadrotor loses to a push, on computers of different speeds: flies it and draws
the figure. `./dev figure quadrotor` calls it."""
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parent.parent))
import sweep

PUSHED_AT_S = 6
SPEEDS = [0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.5, 1]


def height_lost(folder):
    heights = [(row["time_s"], row["z_m"]) for row in sweep.track(folder, "drone/base_link")]
    before = max(z for t, z in heights if t <= PUSHED_AT_S)  # it may not even have taken off
    return max(before, 2) - min(z for t, z in heights if t >= PUSHED_AT_S)


def main():
    build, out = Path(sys.argv[1]), Path(sys.argv[2])
    sweep.run(build / "bin/tcsim", build / "examples/quadrotor/scenario.yaml", out,
              "robots.drone.cpu.speed", SPEEDS)
    lost = [(speed, [height_lost(folder) for folder in trials])
            for speed, trials in sweep.folders(out, SPEEDS)]
    sweep.print_table(("cpu.speed", "height lost [m]"), {"quadrotor": lost})
    sweep.draw(out / "height_lost.svg", "A push of 2.5 N s downwards", "speed of its computer",
               "height lost [m]", {"quadrotor": lost})


if __name__ == "__main__":
    main()
