#!/usr/bin/env python3
"""Draws the picture of README.md anew: the rover's tracks among people in four drives on each of three computers, and what
the first of each says.
    docs/images/effect.py BUILD [FOLDER]    BUILD: build/release; FOLDER: keeps the runs, and takes those that are there
The picture has the colours of light and of dark pages."""
import json
import subprocess
import sys
import tempfile
import textwrap
from html import escape
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path += [str(ROOT / "examples"), str(ROOT / "examples/rover")]
sys.dont_write_bytecode = True
import figure
import sweep

SPEEDS = {0.5: "half as fast as the host", 0.05: "ten times slower", 0.02: "25 times slower"}
SEEDS = [1, 2, 3, 4]  # how people walk
PLANNER = "rover/local_planner"
WIDTH, PANEL, GAP, LINE = 960, 306, 21, 17
SCALE = PANEL / 15  # pixels a metre: the hall is 15 m by 6 m
HALL, TOP, LETTERS = 6 * SCALE, 86, 40

STYLE = """
  svg { font: 14px Helvetica, Arial, sans-serif; }
  .page { fill: #ffffff; } text { fill: #1f2328; } .small { fill: #59636e; }
  .hall { fill: #f3f5f8; stroke: #8a94a0; } .walk { stroke: #b9c1ca; } .track { stroke: #0a5fb4; }
  .said { font: 12.5px ui-monospace, Menlo, Consolas, monospace; }
  .hit { stroke: #c2271d; } .bad { fill: #c2271d; } .good { fill: #17753a; }
  @media (prefers-color-scheme: dark) {
    .page { fill: #0d1117; } text { fill: #e6edf3; } .small { fill: #9ba6b2; }
    .hall { fill: #1a212b; stroke: #6b7683; } .walk { stroke: #434d59; } .track { stroke: #62b0ff; }
    .hit { stroke: #ff7b72; } .bad { fill: #ff7b72; } .good { fill: #56d364; }
  }"""


def drive(build, folder, speed, seed):
    """Runs the example at that speed; returns its summary."""
    if not (folder / "summary.json").exists():
        subprocess.run([build / "bin/tcsim", "run", build / "examples/rover/scenario.yaml", "--out", folder,
                        "--seed", str(seed), "--set", "expect={}", "--set", f"robots.rover.cpu.speed={speed}"], check=True)
    return json.loads((folder / "summary.json").read_text())


def path(rows, left, kind):
    points = " ".join(f"{left + (row['x_m'] + 7.5) * SCALE:.1f},{TOP + (3 - row['y_m']) * SCALE:.1f}"
                      for row in rows[::20] + rows[-1:])
    return f'<polyline class="{kind}" points="{points}" fill="none" stroke-width="{1.8 if kind == "track" else 1}"/>'


def sentences(summary):
    """The verdict on the planner, word by word; without one, what its silence means."""
    said = [(f"! {line}", "said bad") for line in summary["verdict"] if PLANNER in line]
    if said:
        return said
    deadline = summary["clients"][PLANNER]["deadline"]
    return [(f"nothing: {PLANNER} met all {deadline['judged']} of its deadlines ({deadline['deadline_ns'] // 10**6} ms for each message)",
             "said good")]


def panel(folders, left, speed, words, summary):
    hits = [hit for folder in folders for hit in figure.collisions(folder)]
    drives = f"{len(folders)} drives of {summary['virtual_ns'] / 1e9:.0f} s"
    svg = [f'<text x="{left}" y="58"><tspan font-weight="bold">cpu.speed: {speed:g}</tspan> · {words}</text>',
           f'<text x="{left}" y="77" class="small">{len(hits) or "no"} collision{"" if len(hits) == 1 else "s"} '
           f'in {drives}</text>',
           f'<rect class="hall" x="{left}" y="{TOP}" width="{PANEL}" height="{HALL:.1f}"/>']
    svg += [path(sweep.track(folders[0], name), left, "walk") for name in figure.WALKERS]
    svg += [path(sweep.track(folder, "rover/base_link"), left, "track") for folder in folders]
    for _, x_m, y_m in hits:
        x, y = left + (x_m + 7.5) * SCALE, TOP + (3 - y_m) * SCALE
        svg.append(f'<path class="hit" d="M{x - 6:.1f} {y - 6:.1f}l12 12m-12 0l12 -12" stroke-width="3"/>')
    y = TOP + HALL + 22
    svg.append(f'<text x="{left}" y="{y:.0f}" class="small">What tcs says of the first drive:</text>')
    y += LINE + 2
    for sentence, kind in sentences(summary):
        for line in textwrap.wrap(sentence, LETTERS, subsequent_indent="  " if sentence[0] == "!" else ""):
            svg.append(f'<text x="{left}" y="{y:.0f}" class="{kind}" xml:space="preserve">{escape(line)}</text>')
            y += LINE
    return svg, y


def draw(build, runs, target):
    svg, bottom = [], 0
    for i, (speed, words) in enumerate(SPEEDS.items()):
        folders = [runs / f"{speed:g}" / f"seed-{seed}" for seed in SEEDS]
        summaries = [drive(build, folder, speed, seed) for folder, seed in zip(folders, SEEDS)]
        drawn, y = panel(folders, i * (PANEL + GAP), speed, words, summaries[0])
        svg += drawn
        bottom = max(bottom, y)
    head = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-12 0 {WIDTH + 24} {bottom:.0f}" role="img" '
            'aria-labelledby="title text">', '<title id="title">One robot, one program, three computers</title>',
            '<desc id="text">The tracks of a rover among seven walkers on computers of three speeds, its collisions, and '
            'what tcs says of a drive.</desc>', f"<style>{STYLE}</style>",
            f'<rect class="page" x="-12" width="{WIDTH + 24}" height="{bottom:.0f}"/>',
            '<text x="0" y="26" font-size="18" font-weight="bold">The same planner, the same robot, the same people: '
            'only the rover\'s computer is slower</text>']
    target.write_text("\n".join(head + svg + ["</svg>\n"]))


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as scratch:
        draw(Path(sys.argv[1]), Path(sys.argv[2] if len(sys.argv) == 3 else scratch), Path(__file__).with_suffix(".svg"))


if __name__ == "__main__":
    main()
