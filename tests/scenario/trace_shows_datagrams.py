"""Holds the trace of a recorded run of the quadrotor (DIR/trace.json.gz) against the run's own tables: an arrow for each
datagram, a counter for each quantity that a sensor measured.

    trace_shows_datagrams.py DIR
"""
import sys

from trace_shows_messages import check, ns_of, read, rows_of


def check_ends(folder):
    """Of the datagrams, what is known of their ends without that table."""
    rows = [(int(r["sent_ns"]), r["sender"], int(r["received_ns"]), r["receiver"], r["channel"])
            for r in rows_of(folder, "datagrams")]
    check(all(sent <= received for sent, _, received, _, _ in rows), "received before it was sent")
    gyroscope = [r for r in rows if r[4] == "drone_gyroscope"]
    check(len(gyroscope) > 800 and {r[1:4:2] for r in gyroscope} == {("dynamics", "drone/rate_loop")}, gyroscope[:3])
    # A sample each millisecond, which nobody gets twice, or in another order.
    sent = [r[0] for r in gyroscope]
    check(all(at % 10**6 == 0 for at in sent) and sent == sorted(set(sent)), sent[:9])
    # A command each, and all that came in.
    motors = [(r[0], r[2]) for r in rows if r[4] == "drone_motors"]
    acted = sorted({int(r["sent_ns"]) for r in rows_of(folder, "commands") if r["channel"] == "drone_motors"})
    check([at for at, _ in motors] == acted and len(acted) > 800, motors[:3], acted[:3])
    check({r[1:4:2] for r in rows if r[4] == "drone_motors"} == {("drone/rate_loop", "dynamics")}, "who commands")
    # From program to program.
    between = {(r[1], r[3], r[4]) for r in rows if "dynamics" not in r}
    check({("drone/attitude_loop", "drone/rate_loop", "@drone/rates"),
           ("drone/position_loop", "drone/attitude_loop", "@drone/thrust"),
           ("drone/planner", "drone/position_loop", "@drone/trajectory")} == between, between)
    return rows


def check_flows(events, threads, rows):
    ends = {}
    for event in events:
        if "bind_id" in event:
            ends.setdefault(event["bind_id"], {})["out" if event.get("flow_out") else "in"] = event
    found = []
    for pair in ends.values():
        names = [threads[pair[end]["pid"], pair[end]["tid"]].split(" #")[0] for end in ("out", "in")]
        times = [ns_of(pair[end]["ts"]) for end in ("out", "in")]
        found.append((times[0], names[0], times[1], names[1], pair["out"]["name"].removeprefix("send ")))
    check(sorted(found) == sorted(rows), len(found), "flows, but", len(rows), "datagrams")


def check_counters(folder, events):
    counters = {}
    for event in events:
        if event["ph"] == "C":
            counters.setdefault(event["name"], []).append(
                (ns_of(event["ts"]), {k: float(v) for k, v in event["args"].items()}))
    rows = rows_of(folder, "sensors")
    names = {(r["channel"], r["of"], r["quantity"]) for r in rows}
    check({name[0] for name in names} == {"drone_gyroscope", "drone_attitude", "drone_pose", "drone_pose_to_plan"}, names)
    for channel, of, quantity in names:
        meant = [(int(r["time_ns"]), {axis: float(r[axis]) for axis in "xyzw" if r[axis]}) for r in rows
                 if (r["channel"], r["of"], r["quantity"]) == (channel, of, quantity)]
        check(counters[f"{channel} {of} {quantity}"] == meant, channel, of, quantity, "is not as in sensors.csv")
    # What was measured is what was so: it has no noise.
    poses = {int(r["time_ns"]): float(r["z"]) for r in rows if (r["channel"], r["quantity"]) == ("drone_pose", "position (m)")}
    bodies = {round(float(r["time_s"]) * 1e9): float(r["z_m"]) for r in rows_of(folder, "bodies")
              if r["body"] == "drone/base_link"}
    both = poses.keys() & bodies.keys()
    check(len(both) > 40 and all(abs(poses[at] - bodies[at]) < 1e-6 for at in both), len(both))


def main(folder):
    events = read(folder)
    threads = {(e["pid"], e["tid"]): e["args"]["name"] for e in events if e.get("name") == "thread_name"}
    check_flows(events, threads, check_ends(folder))
    check_counters(folder, events)


if __name__ == "__main__":
    main(sys.argv[1])
