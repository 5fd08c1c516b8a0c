#!/usr/bin/env python3
"""Calls of the kernel, programs and whole DDS systems natively, in real time and on one processor, beside the same binaries under tcs on
one core.

usage: fidelity.py TCSIM NODE CALLS [--rounds N] [--rows calls|programs|samples|pipeline] [--quick] [--json]

Natively over the loopback interface; under tcs as by default, measured and under set costs. In turns: each row natively,
then measured, so many rounds; once under set costs, which are the same in each round, and once without prices. A native run
from which the hypervisor took more than 1 % of the processors' time does not count, and is repeated. docs/VALIDATION.md has
what came out, and what it means.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile

URI = '<CycloneDDS><Domain><General><Interfaces><NetworkInterface name="lo"/></Interfaces></General></Domain></CycloneDDS>'
MOST_STOLEN = 0.01
PERIOD_US = 10_000  # of the pipeline
SIZE = 64 << 10


def processor_times():
    with open("/proc/stat") as stat:
        times = list(map(int, stat.readline().split()[1:9]))
    return sum(times), times[7]


def natively(commands, processor):
    """Runs the programs at once on that processor; their output, in the order of `commands`."""
    for _ in range(5):
        total, stolen = processor_times()
        programs = [subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                                     env={**os.environ, "CYCLONEDDS_URI": URI},
                                     preexec_fn=lambda: os.sched_setaffinity(0, {processor})) for command in commands]
        said = [program.communicate(timeout=120)[0] for program in programs]
        now_total, now_stolen = processor_times()
        if now_stolen - stolen <= MOST_STOLEN * (now_total - total):
            return said
        print("fidelity: the hypervisor took the processors, once more", file=sys.stderr)
    raise SystemExit("fidelity: the hypervisor takes more than 1 % of the processors all the time; try again later")


def under_tcs(tcsim, commands, accounting, *costs, without_rights=False):
    with tempfile.TemporaryDirectory() as folder:
        clients = {f"c{i}": {"command": command} for i, command in enumerate(commands)}
        with open(f"{folder}/s.yaml", "w") as scenario:
            json.dump({"duration": "30s", "robots": {"computer": {"clients": clients}}}, scenario)
        prefix = ["prlimit", "--rtprio=0:0"] if without_rights else []
        if without_rights and os.geteuid() == 0:  # nobody else has more to give up, or may
            prefix += ["setpriv", "--bounding-set=-sys_nice", "--inh-caps=-sys_nice"]
        run = subprocess.run([*prefix, tcsim, "run", f"{folder}/s.yaml", "--accounting", accounting, "--out", f"{folder}/out", *costs],
                             capture_output=True, text=True, timeout=600)
        said = []
        for i in range(len(commands)):
            with open(f"{folder}/out/computer-c{i}.out.log") as log:
                said.append(log.read())
        if run.returncode not in (0, 3):
            raise SystemExit(f"fidelity: {run.stdout}{run.stderr}")
        return said


class Samples:
    """One writer, some readers."""

    def __init__(self, node, size, hz, reliable=True, readers=1, count=None):
        count = str(count or int(hz))
        kind = str(int(reliable))
        self.name = (f"{size} B, {hz} Hz" + ("" if reliable else ", best effort") +
                     (f", to {readers}" if readers > 1 else ""))
        self.commands = [[node, "read", count, kind] for _ in range(readers)]
        self.commands.append([node, "write", str(size), str(hz), count, kind, str(readers)])

    columns = ("in dds_write", "in a reader", "latency")

    def figures(self, said):
        readers = [list(map(float, text.split()[1:])) for text in said[:-1]]
        if any(len(reader) != 2 for reader in readers):
            raise SystemExit(f"fidelity: a reader of {self.name} has got less than nine tenths of the samples")
        return [float(said[-1].split()[1])] + [statistics.mean(reader[i] for reader in readers) for i in (0, 1)]


class Pipeline:
    """A source at 100 Hz, three stages that compute, and a sink, on one core."""

    def __init__(self, node, work_us, count=300):
        self.name = f"pipeline, {work_us / PERIOD_US:.1%} of a core computed"
        self.work = work_us
        self.commands = [[node, "sink", "3", str(count), str(2 * PERIOD_US)]]
        self.commands += [[node, "stage", str(i), str(work_us / 3)] for i in range(3)]
        self.commands.append([node, "source", str(SIZE), "100", str(count)])

    columns = ("share within two periods", "median age")

    def figures(self, said):
        return list(map(float, said[0].split()[1:]))


def in_turns(tcsim, commands, processor):
    """The same programs natively, measured, and measured without real-time priority: kind to their output."""
    return {"native": natively(commands, processor), "measured": under_tcs(tcsim, commands, "measured"),
            "unprivileged": under_tcs(tcsim, commands, "measured", without_rights=True)}


def row_of(name, native, by, unit=1):
    """A row: what is native as text, and the medians of the others beside native's."""
    middle, ours, without = (statistics.median(by[kind]) for kind in ("native", "measured", "unprivileged"))
    return f"| {name} | {native} | {ours / unit:,.0f} | {ours / middle:.2f} | {without / unit:,.0f} | {without / middle:.2f} |"


class Calls:
    """What one call takes by its program's own clock, batch by batch."""

    def __init__(self, calls, batches=11):
        self.commands = [[calls, str(batches)]]

    @staticmethod
    def batches(said):
        return {name: list(map(float, values)) for name, *values in map(str.split, said[0].splitlines())}

    @staticmethod
    def print(native, measured, unprivileged):
        """Each: operation to its batches, in ns."""
        print("\nIn ns: native, median and p10 to p90 · measured · ratio · measured without real-time priority · ratio\n")
        print("| operation | native | measured | ratio | without rights | ratio |\n|" + "---|" * 6)
        for name, values in native.items():
            low, *_, high = statistics.quantiles(values, n=10)
            by = {"native": values, "measured": measured[name], "unprivileged": unprivileged[name]}
            print(row_of(name, f"{statistics.median(values):,.0f} ({low:,.0f}–{high:,.0f})", by))


class Programs:
    """What whole programs of Debian take, by a shell's clock."""

    def __init__(self, data, source, quick):
        self.rows = {"a shell that starts 300 programs": "i=0; while [ $i -lt 300 ]; do /bin/true; i=$((i + 1)); done",
                     "three programs at a pipe": f"cat {data} | gzip -1 | wc -c",
                     "xz": f"xz -1 -T1 -c {data} | wc -c",
                     "gcc": f"gcc -O2 -c {source} -o /dev/null",
                     "python": "python3 -c 'print(sum(i * i for i in range(2000000)))'",
                     "tar of the headers of C++": "tar -cf - -C /usr/include/c++ . | wc -c"}
        if quick:
            self.rows = {"python": self.rows["python"]}

    @staticmethod
    def commands(script):
        return [["sh", "-c", f'begun=$(date +%s%N); {script} >&2; ended=$(date +%s%N); echo $((ended - begun))']]

    @staticmethod
    def print(found):
        """By name, by kind: nanoseconds."""
        print("\nIn ms: native · measured · ratio · measured without real-time priority · ratio\n")
        print("| program | native | measured | ratio | without rights | ratio |\n|" + "---|" * 6)
        for name, by in found.items():
            print(row_of(name, text_of([value / 1e6 for value in by["native"]]), by, 1e6))


def measure_programs(tcsim, programs, rounds, processor):
    found = {}
    for name, script in programs.rows.items():
        by = found[name] = {"native": [], "measured": [], "unprivileged": []}
        commands = programs.commands(script)
        natively(commands, processor)  # what it reads is in memory from then on
        for _ in range(rounds):
            for kind, said in in_turns(tcsim, commands, processor).items():
                by[kind].append(int(said[0]))
    return found


def text_of(values):
    """The median, and the range."""
    short = (lambda x: f"{x:.3f}") if max(values) <= 1 else (lambda x: f"{x:,.0f}")
    middle = short(statistics.median(values))
    return middle if len(set(map(short, values))) == 1 else f"{middle} ({short(min(values))}–{short(max(values))})"


def measure_calls(tcsim, calls, rounds, processor):
    """By kind of run: operation to its batches of all rounds."""
    found = {"native": {}, "measured": {}, "unprivileged": {}}
    for _ in range(rounds):
        for kind, said in in_turns(tcsim, calls.commands, processor).items():
            for name, values in calls.batches(said).items():
                found[kind].setdefault(name, []).extend(values)
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("tcsim")
    parser.add_argument("node")
    parser.add_argument("calls")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--rows", choices=("calls", "programs", "samples", "pipeline"), help="these alone")
    parser.add_argument("--quick", action="store_true", help="one round of few rows: that each can be measured")
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    node = os.path.abspath(given.node)
    processor = max(os.sched_getaffinity(0))
    rows = [Samples(node, 1 << 10, 1000, readers=2, count=200), Pipeline(node, 5000, 50)]
    if given.quick:
        given.rounds = 1
    else:
        rows = [Samples(node, size, hz, reliable)
                for reliable in (True, False)
                for size, hz in ((0, 1000), (1 << 10, 1000), (4 << 10, 1000), (16 << 10, 500), (64 << 10, 500), (256 << 10, 200), (1 << 20, 100))]
        rows += [Samples(node, 1 << 10, 1000, readers=2), Samples(node, 1 << 10, 500, readers=8),
                 Samples(node, 64 << 10, 200, readers=8), Samples(node, 1 << 20, 50, readers=2)]
        rows += [Pipeline(node, work) for work in (3000, 6000, 8000, 8400, 8600, 8800, 9000, 9250, 9500, 9750, 10000, 12000)]
    kinds = {"samples": Samples, "pipeline": Pipeline}
    found, columns = {}, None
    if given.rows in (None, "calls"):
        found["calls"] = measure_calls(given.tcsim, Calls(os.path.abspath(given.calls), 3 if given.quick else 11), given.rounds, processor)
        if not given.json:
            Calls.print(**found["calls"])
    if given.rows in (None, "programs"):
        source = os.path.join(os.path.dirname(os.path.abspath(__file__)), "calls.c")
        found["programs"] = measure_programs(given.tcsim, Programs(os.path.abspath(given.tcsim), source, given.quick), given.rounds, processor)
        if not given.json:
            Programs.print(found["programs"])
    rows = [row for row in rows if given.rows is None or isinstance(row, kinds.get(given.rows, ()))]
    for row in rows:
        by = found[row.name] = {"native": [], "measured": []}
        for _ in range(given.rounds):
            by["native"].append(row.figures(natively(row.commands, processor)))
            by["measured"].append(row.figures(under_tcs(given.tcsim, row.commands, "measured")))
        by["set costs"] = [row.figures(under_tcs(given.tcsim, row.commands, "fixed"))]
        by["none"] = [row.figures(under_tcs(given.tcsim, row.commands, "measured", "--set", "robots.computer.cpu.costs=none"))]
        if given.json:
            continue
        if row.columns != columns:
            columns = row.columns
            print(f"\n{'In us' if columns == Samples.columns else 'Shares, and in us'}: native · measured · set costs · measured without prices\n")
            print("| | " + " | ".join(columns) + " |\n|" + "---|" * (len(columns) + 1))
        cells = [" · ".join(text_of([one[i] for one in by[kind]]) for kind in ("native", "measured", "set costs", "none"))
                 for i in range(len(columns))]
        print(f"| {row.name} | " + " | ".join(cells) + " |", flush=True)
    if given.json:
        print(json.dumps(found, indent=1))


main()
