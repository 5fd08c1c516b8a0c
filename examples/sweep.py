"""What the examples' figures share: a sweep of one key of a scenario with `tcsim trials`, and a
figure of what came of it, as SVG."""
import csv
import math
import statistics
import subprocess
from pathlib import Path


def run(tcsim, scenario, out, key, values, trials=3, options=()):
    """Runs the scenario with each value of the key. What is done already is not done again."""
    command = [tcsim, "trials", scenario, "--trials", str(trials), "--out", out, *options,
               "--vary", f"{key}={','.join(map(str, values))}"]
    # 3: not all values came to what the scenario expects, which is what the figure shows.
    ended = subprocess.run(list(map(str, command)))
    if ended.returncode not in (0, 3):
        ended.check_returncode()


def folders(out, values):
    """For each value the folders of its trials."""
    return [(value, sorted((Path(out) / str(value)).glob("seed-*"))) for value in values]


def track(folder, body):
    """The lines of bodies.csv about a body, as dictionaries of numbers."""
    with open(Path(folder) / "bodies.csv") as lines:
        return [{k: float(v) for k, v in row.items() if k != "body"}
                for row in csv.DictReader(lines) if row["body"] == body]


def print_table(heading, series):
    for name, points in series.items():
        print(f"\n{name}")
        print(f"{heading[0]:>12}  {heading[1]}")
        for x, ys in points:
            print(f"{x:>12g}  {'  '.join(f'{y:.3g}' for y in ys)}")


def draw(path, title, x_label, y_label, series, logarithmic=True, middle=statistics.median):
    """`series`: by name, (x, [y of each trial]) with rising x. Dots are trials, the line goes through
    their middle."""
    width, height, left, bottom, top, right = 640, 400, 70, 50, 40, 20
    colours = ["#1f6fb4", "#d1495b", "#3a8f5c"]
    xs = [x for points in series.values() for x, _ in points]
    most = max(max(y for points in series.values() for _, ys in points for y in ys), 1e-9) * 1.08
    scale = math.log if logarithmic else float
    low, high = scale(min(xs)), scale(max(xs))

    def at(x, y):
        share = (scale(x) - low) / ((high - low) or 1)
        return left + share * (width - left - right), height - bottom - y / most * (height - bottom - top)

    def text(x, y, words, more=""):
        return f'<text x="{x:.1f}" y="{y:.1f}" {more}>{words}</text>'

    step = 10 ** math.floor(math.log10(most))
    step = step / 5 if most / step < 2 else step / 2 if most / step < 5 else step
    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
           'font-family="sans-serif" font-size="13" text-anchor="middle">',
           f'<rect width="{width}" height="{height}" fill="white"/>',
           text(width / 2, 22, title, 'font-size="15"'),
           text((left + width - right) / 2, height - 12, x_label),
           text(18, height / 2, y_label, f'transform="rotate(-90 18 {height / 2})"')]
    for i in range(int(most / step) + 1):
        x, y = at(min(xs), i * step)
        svg.append(f'<path d="M{x:.1f} {y:.1f}H{width - right}" stroke="#dddddd"/>')
        svg.append(text(x - 8, y + 4, f"{i * step:g}", 'text-anchor="end"'))
    for x in sorted(set(xs)):
        svg.append(text(at(x, 0)[0], height - bottom + 18, f"{x:g}"))
    for (name, points), colour in zip(series.items(), colours):
        line = " ".join("%.1f,%.1f" % at(x, middle(ys)) for x, ys in points if ys)
        svg.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        for x, ys in points:
            svg += ['<circle cx="%.1f" cy="%.1f" r="3.5" fill="%s"/>' % (*at(x, y), colour) for y in ys]
        if len(series) > 1:
            row = top + 16 * list(series).index(name)
            svg.append(text(width - right, row, name, f'fill="{colour}" text-anchor="end"'))
    Path(path).write_text("\n".join(svg + ["</svg>\n"]))
    print(f"drawn: {path}")
