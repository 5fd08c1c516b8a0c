#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The dynamics lead while a program computes on and on. What it commands meanwhile acts from the very
# moment of the send all the same: the push between two commands is as long as the time between them. Another
# robot never rests, so that the program sends at times that others have not come to.
# Topics: commands, udp, physics.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/client.py" <<'PY'
import socket, sys, time
commands = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
commands.connect(("127.0.0.1", int(sys.argv[1])))
for i in range(10):
    end = time.monotonic() + 0.0937  # some drift bounds: long enough to be seen computing
    while time.monotonic() < end: pass
    force = b'{"force": [%d, 0, 0]}' % ((i + 1) % 2)
    before = time.monotonic()
    commands.send(force)
    print(before, time.monotonic(), flush=True)
time.sleep(10)
PY
cat >"$out/restless.py" <<'PY'
import time
while True: time.sleep(0.0003)
PY
cat >"$out/scenario.yaml" <<'YAML'
duration: 1.2s
drift: 20ms
dynamics: {}
bodies:
  body: {mass: 1.0, inertia: [0.1, 0.1, 0.1]}
robots:
  robot:
    clients:
      client: {command: [python3, client.py, "27391"], body: body, fixed_call_cost: 100us, fixed_allocation_cost: 0s}
  other:
    clients:
      restless: {command: [python3, restless.py], fixed_call_cost: 20us, fixed_allocation_cost: 0s}
channels:
  commands:
    type: udp_json
    commands: {body: body, listen: "127.0.0.1:27391"}
YAML
for accounting in measured fixed; do for bound_ms in 1 20; do
  "$tcsim" run "$out/scenario.yaml" --accounting "$accounting" --drift "${bound_ms}ms" --out "$out/$accounting" >"$out/said"
  python3 - "$out/$accounting" "$bound_ms" <<'PY' || fail "$accounting, $bound_ms ms: $(cat "$out/said")"
import csv, json, sys
sent = [[float(word) - 1000 for word in line.split()]
        for line in open(f"{sys.argv[1]}/robot-client.out.log")]
rows = [(float(row["time_s"]), float(row["vx_mps"]))
        for row in csv.DictReader(open(f"{sys.argv[1]}/bodies.csv"))]
def velocity(at): return next(v for t, v in rows if t >= at)
assert len(sent) == 10, sent
for on, off in zip(sent[::2], sent[1::2]):
    push = velocity(off[1]) - velocity(on[0] - 0.01)
    assert off[0] - on[1] - 1e-9 <= push <= off[1] - on[0] + 1e-9, (on, off, push)
drift = json.load(open(f"{sys.argv[1]}/summary.json"))["drift_ns"]
bound = int(sys.argv[2]) * 1_000_000
assert bound / 2 < drift <= bound, drift
PY
done; done
