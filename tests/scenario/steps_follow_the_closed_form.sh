#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A command acts from the instant of its send on: velocity and position follow the closed form of that instant, to
# the integrator's accuracy, with one body, two and 96, and with any drift bound.
# Topics: physics, commands, drift.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/client.py" <<'PY'
import socket, sys, time
commands = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
end = time.monotonic() + 0.05  # some drift bounds
while time.monotonic() < end: pass
for body in range(int(sys.argv[1])):
    before = time.monotonic()
    commands.sendto(b'{"force": [%d, 0, 0]}' % (body + 1), ("127.0.0.1", 27700 + body))
    print(before, time.monotonic(), flush=True)
time.sleep(10)
PY
run() {  # BODIES DRIFT ACCOUNTING
  {
    printf 'duration: 0.5s\ncsv_period: 50ms\ndynamics: {}\nbodies:\n'
    for ((i = 0; i < $1; ++i)); do echo "  b$i: {mass: 2, inertia: [0.1, 0.1, 0.1]}"; done
    printf 'robots: {r: {clients: {c: {command: [python3, client.py, "%s"], fixed_allocation_cost: 0s}}}}\nchannels:\n' "$1"
    for ((i = 0; i < $1; ++i)); do
      echo "  c$i: {type: udp_json, commands: {body: b$i, listen: \"127.0.0.1:$((27700 + i))\"}}"
    done
  } >"$out/s.yaml"
  "$tcsim" run "$out/s.yaml" --accounting "$3" --drift "$2" --out "$out/run" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  python3 - "$out/run" "$1" <<'PY' || fail "$*: $(cat "$out/said")"
import csv, sys
sent = [[float(word) - 1000 for word in line.split()] for line in open(f"{sys.argv[1]}/r-c.out.log")]
assert len(sent) == int(sys.argv[2]), sent
rows = list(csv.DictReader(open(f"{sys.argv[1]}/bodies.csv")))
for body, (before, after) in enumerate(sent):
    own = [(float(r["time_s"]), float(r["x_m"]), float(r["vx_mps"])) for r in rows if r["body"] == f"b{body}"]
    a = (body + 1) / 2
    end, _, v = own[-1]
    at = end - v / a
    assert before - 1e-9 <= at <= after + 1e-9, (body, before, at, after)
    for t, x, v in own:
        pushed = max(0, t - at)
        assert abs(v - a * pushed) < 1e-12 * a, (body, t, v)
        assert abs(x - a * pushed ** 2 / 2) < 1e-11 * a, (body, t, x)
PY
}
for bodies in 1 2 96; do
  for drift in 0.1ms 1ms 20ms; do run $bodies $drift fixed; done
  run $bodies 1ms measured
done
