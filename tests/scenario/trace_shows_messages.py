"""Holds a run's trace for Perfetto (DIR/trace.json.gz) against the run's own tables.

    trace_shows_messages.py DIR
"""
import csv
import gzip
import json
import sys
from decimal import Decimal


def check(true, *what):
    if not true:
        sys.exit("FAILED: " + " ".join(str(w) for w in what))


def rows_of(folder, name):
    with open(f"{folder}/{name}.csv") as file:
        return list(csv.DictReader(file))


def ns_of(microseconds):
    return int(microseconds * 1000)


def read(folder):
    with gzip.open(folder + "/trace.json.gz") as file:
        trace = json.load(file, parse_float=Decimal)
    with open(folder + "/trace.json") as file:
        schedule = json.load(file, parse_float=Decimal)
    events = trace["traceEvents"]
    check(events[:len(schedule["traceEvents"])] == schedule["traceEvents"], "the schedule is another one")
    return events


def check_flows(folder, events, threads):
    busy = {}
    for row in rows_of(folder, "dispatches"):
        busy.setdefault(row["row"], []).append((int(row["virtual_start_ns"]), int(row["virtual_end_ns"])))
    ends = {"flow_out": {}, "flow_in": {}}
    for event in events:
        if "bind_id" not in event:
            continue
        (direction,) = [d for d in ends if event.get(d)]
        check(event["ph"] == "X" and event["dur"] == 0, event)
        check(event["bind_id"] not in ends[direction], "a flow has two such ends:", event)
        ends[direction][event["bind_id"]] = event
    check(ends["flow_out"].keys() == ends["flow_in"].keys(), "flows have one end only")
    found = []
    for flow, out in ends["flow_out"].items():
        into = ends["flow_in"][flow]
        check(out["name"].startswith("send ") and out["name"][5:] == into["name"].removeprefix("receive "), out, into)
        names = [threads[event["pid"], event["tid"]] for event in (out, into)]
        times = [ns_of(event["ts"]) for event in (out, into)]
        check(times[0] <= times[1], "it is received before it is sent:", out, into)
        for name, time in zip(names, times):
            at_work = any(start <= time <= end for start, end in busy[name])
            check(name == "dynamics" or at_work, name, "does nothing at", time, out["name"])
        found.append((times[0], names[0].split(" #")[0], times[1], names[1].split(" #")[0], out["name"][5:]))
    messages = [(int(r["sent_ns"]), r["sender"], int(r["received_ns"]), r["receiver"], r["topic"])
                for r in rows_of(folder, "messages")]
    check(len(messages) > 300 and sorted(found) == sorted(messages), len(found), "flows, but", len(messages), "messages")
    # Both ways through the world, and between two programs.
    check({("dynamics", "predator/controller"), ("predator/controller", "dynamics"),
           ("predator/controller", "predator/planner"), ("predator/planner", "predator/controller")} <=
          {(sender, receiver) for _, sender, _, receiver, _ in messages}, "who sends whom")
    # Each odometry sample reaches the one reader, and none before it was taken.
    odometry = [m for m in messages if m[4] == "/predator/odom"]
    check([m[0] for m in odometry] == [10**7 * i for i in range(1, len(odometry) + 1)] or
          [m[0] for m in odometry] == [10**7 * i for i in range(len(odometry))], odometry[:3])


def check_counters(folder, events):
    counters = {}
    for event in events:
        if event["ph"] == "C":
            check(event["pid"] > 3 and event["args"], event)
            counters.setdefault(event["name"], []).append((ns_of(event["ts"]), event["args"]))
    bodies = rows_of(folder, "bodies")
    for body in "predator", "prey":
        rows = [row for row in bodies if row["body"] == body]
        for name, columns in (("position (m)", {"x": "x_m", "y": "y_m", "z": "z_m"}),
                              ("orientation", {"x": "qx", "y": "qy", "z": "qz", "w": "qw"}),
                              ("velocity (m per s)", {"x": "vx_mps", "y": "vy_mps", "z": "vz_mps"})):
            told = [(at, {k: float(v) for k, v in values.items()}) for at, values in counters[f"{body} {name}"]]
            meant = [(round(float(row["time_s"]) * 1e9), {k: float(row[c]) for k, c in columns.items()}) for row in rows]
            check(told == meant, body, name, "is not as in bodies.csv")
    meant = [(int(r["acts_ns"]), {r["quantity"]: float(r["value"])}) for r in rows_of(folder, "commands")
             if r["channel"] == "prey_commands"]
    told = [(at, {k: float(v) for k, v in values.items()}) for at, values in counters["prey by prey_commands"]]
    check(len(meant) > 100 and told == meant, "commands are not as in commands.csv")
    ages = [(at, float(values["age (ms)"])) for at, values in counters["/predator/plan_request at predator/planner"]]
    meant = [(int(r["received_ns"]), (int(r["received_ns"]) - int(r["sent_ns"])) * 1e-6)
             for r in rows_of(folder, "messages") if r["topic"] == "/predator/plan_request"]
    check(ages == meant, ages[:2], meant[:2])


def check_output(folder, events, threads):
    said = [e for e in events if e["ph"] == "i" and e.get("cat") == "output"]
    with open(folder + "/predator-planner.err.log") as file:
        lines = file.read().splitlines()
    rows = [r for r in rows_of(folder, "output") if r["client"] == "predator/planner"]
    check(lines and [e["name"] for e in said] == lines, [e["name"] for e in said], lines)
    for event, row in zip(said, rows):
        check(threads[event["pid"], event["tid"]] == "predator/planner", event)
        check(ns_of(event["ts"]) == int(row["time_ns"]) // 1000 * 1000, event, row)


def main(folder):
    events = read(folder)
    threads = {(e["pid"], e["tid"]): e["args"]["name"] for e in events if e.get("name") == "thread_name"}
    check_flows(folder, events, threads)
    check_counters(folder, events)
    check_output(folder, events, threads)


if __name__ == "__main__":
    main(sys.argv[1])
