#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Programs whose DDS uses sockets meet the scenario's topics on DDS: each sample, once, when it was written and with its
# timestamp; whoever comes late gets what is kept for it; commands act when they were sent, and do not come back. In both
# accountings; fixed runs repeat to the byte. Nothing of the gateway is in the results, and it outlives no run.
# Topics: dds, udp, ros, determinism.
export CYCLONEDDS_URI='<CycloneDDS><Domain id="any"><General><Interfaces>
  <NetworkInterface name="lo" multicast="true"/></Interfaces></General></Domain></CycloneDDS>'
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cp "$source_root/tests/scenario/craft.urdf" "$out"
cat >"$out/scenario.yaml" <<YAML
duration: 3s
dynamics: {}
bodies:
  ship: {mass: 1, inertia: [0.1, 0.1, 0.1]}
models:
  craft: {urdf: craft.urdf}
robots:
  ship:
    clients:
      early: {command: ["$build/bin/sockets_probe"], dds: sockets, body: ship}
      late: {command: ["$build/bin/sockets_probe", "1500"], dds: sockets}
  shore: {clients: {graph: {command: ["$build/bin/ros_graph", iron], dds: sockets}}}
clock: {rate: 20}
channels:
  odometry: {type: dds, sensors: {bodies: [ship], message: nav_msgs/msg/Odometry, topic: /odom, rate: 100}}
  text: {type: dds, sensors: {kind: description, model: craft}}
  wrench: {type: dds, commands: {body: ship, message: geometry_msgs/msg/Wrench, topic: /wrench}}
YAML
fly() {  # NAME OPTION...
  timeout 200 "$build/bin/in_own_network" "$tcsim" run "$out/scenario.yaml" --out "$out/$1" "${@:2}" >"$out/said" 2>&1 || fail "$1: $(cat "$out/said")"
  ! grep -i 'warning' "$out/said" || fail "$1: $(cat "$out/said")"
}
fly measured
for run in first second; do fly "$run" --accounting fixed; done
for run in measured first; do
  python3 - "$out/$run" "$(stat -c %s "$out/craft.urdf")" <<'PY' || fail "$run: $(head -n 30 "$out/$run"/ship-*.out.log)"
import csv, json, sys
folder, description = sys.argv[1], int(sys.argv[2])
MS = 1_000_000
# How long the first sample may take to a program that is ready, any sample, and most. What programs compute is the host's
# where it is measured.
fixed = folder.endswith("/first")
soon, most, usual = (120 * MS, 3 * MS, MS) if fixed else (250 * MS, 15 * MS, 3 * MS)
lines = {who: [line.split() for line in open(f"{folder}/ship-{who}.out.log")] for who in ("early", "late")}
def of(who, kind): return [tuple(map(int, words[1:])) for words in lines[who] if words[0] == kind]
# Each sample of what a reliable reader has met, in order, with its timestamp, within what a loopback and the program take.
for topic, period in (("odom", 10 * MS), ("clock", 50 * MS)):
    for who in lines:
        samples = of(who, topic)
        [(ready,)] = of(who, "ready")
        assert samples[0][2] - ready < soon, (who, topic, ready, samples[0])
        for (before, *_), (after, *_) in zip(samples, samples[1:]): assert after - before == period, (who, before, after)
        for stamp, written, came in samples:
            assert written == stamp and 0 <= came - stamp < most, (who, topic, stamp, written, came)
        assert sorted(came - stamp for stamp, _, came in samples)[len(samples) // 2] < usual, (who, topic)
    start = of("early", topic)[0][0]
    assert of("early", topic)[-1][0] - of("late", topic)[-1][0] in (0, period, -period)
# What is kept for whoever comes late is the same.
for who in lines: assert [length for length, _ in of(who, "description")] == [description], of(who, "description")
# Each command once, no earlier than it was sent, and as soon as its way takes.
origin = of("early", "odom")[0][0] - of("early", "odom")[0][0] // (10 * MS) * (10 * MS)
commands = [int(row["sent_ns"]) for row in csv.DictReader(open(folder + "/commands.csv"))
            if row["channel"] == "wrench" and row["quantity"] == "force_x"]
sent = sorted(at for who in lines for _, at in of(who, "sent"))
real = json.load(open(folder + "/summary.json"))
print(len(sent), len(commands), sent[:3], commands[:3])
assert 0 <= len(sent) - len(commands) <= 2, (len(sent), len(commands))
first = sent[0] - commands[0]  # the date at the start, but for the way
off = [abs(at - acted - first) for at, acted in zip(sent, commands)]
assert max(off) < (2 * MS if fixed else most) and sorted(off)[len(off) // 2] < usual, (max(off), first)
# It is nobody's program.
assert list(real["clients"]) == ["ship/early", "ship/late", "shore/graph"] and list(real["robots"]) == ["ship", "shore"]
PY
  grep -q '^/ship/tcsim publishes rt/odom nav_msgs::msg::dds_::Odometry_ RIHS01_3cc9' "$out/$run/shore-graph.out.log" ||
    fail "$run: nodes: $(cat "$out/$run/shore-graph.out.log")"
  grep -q '^/ship/tcsim subscribes to rt/wrench geometry_msgs::msg::dds_::Wrench_ RIHS01_' "$out/$run/shore-graph.out.log" ||
    fail "$run: nodes: $(cat "$out/$run/shore-graph.out.log")"
  [[ -z $(find "$out/$run" -name '*gateway*') ]] || fail "$run: $(ls "$out/$run")"
done
for file in bodies.csv commands.csv dispatches.csv activations.csv responses.csv topics.json ship-early.out.log ship-late.out.log; do
  cmp "$out/first/$file" "$out/second/$file" || fail "fixed runs differ: $file"
done
# The run ends with its programs.
cat >"$out/short.yaml" <<YAML
duration: 60s
clock: {}
robots: {r: {clients: {it: {command: [sleep, "0.5"], dds: sockets}}}}
YAML
timeout 200 "$build/bin/in_own_network" "$tcsim" run "$out/short.yaml" --out "$out/short" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
python3 -c 'import json, sys; ns = json.load(open(sys.argv[1]))["virtual_ns"]; assert 500_000_000 <= ns < 600_000_000, ns' "$out/short/summary.json" ||
  fail "a run without programs goes on: $(cat "$out/said")"
