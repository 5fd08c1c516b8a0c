#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Channels say along whose axes commands act and how they lag, bodies have drag in a wind: what the bodies of a run do
# follows the closed forms, on both engines.
# Topics: commands, physics.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/client.py" <<'PY'
import socket, time
commands = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
for port in (27801, 27802):
    commands.sendto(b'{"force": [3, 0, 0]}', ("127.0.0.1", port))
print(time.monotonic() - 1000, flush=True)
time.sleep(10)
PY
cat >"$out/s.yaml" <<'YAML'
duration: 2s
dynamics: {wind: [3, -2, 1], accuracy: 1e-7}
bodies:
  turning: {mass: 2, inertia: [0.1, 0.1, 0.1], angular_velocity: [0, 0, 5]}
  slow: {mass: 2, inertia: [0.1, 0.1, 0.1]}
  leaf: {mass: 2, inertia: [0.1, 0.1, 0.1], drag: {linear: 4}}
robots: {r: {clients: {c: {command: [python3, client.py], body: turning, fixed_call_cost: 1us, fixed_allocation_cost: 0s}}}}
channels:
  thruster: {type: udp_json, commands: {body: turning, listen: "127.0.0.1:27801", axes: body}}
  motor: {type: udp_json, commands: {body: slow, listen: "127.0.0.1:27802", lag: 200ms}}
YAML
for engine in simbody ode; do
  extra=()
  [[ $engine == ode ]] && extra=(--set dynamics.engine=ode --set dynamics.accuracy=null)
  "$tcsim" run "$out/s.yaml" --accounting fixed --out "$out/run" "${extra[@]}" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  python3 - "$out/run" "$engine" <<'PY' || fail "$engine: $(cat "$out/said")"
import csv, math, sys
sent = float(open(f"{sys.argv[1]}/r-c.out.log").read())
assert 0 < sent < 0.1, sent
near = 1e-4 if sys.argv[2] == "simbody" else 5e-3  # the sends are some microseconds before what was printed
rows = list(csv.DictReader(open(f"{sys.argv[1]}/bodies.csv")))
assert len(rows) > 500
for row in rows:
    v = [float(row[f"v{axis}_mps"]) for axis in "xyz"]
    t = float(row["time_s"])
    s = max(0, t - sent)
    if row["body"] == "turning":
        a = 5 * t
        b = a - 5 * s
        wanted = [1.5 / 5 * (math.sin(a) - math.sin(b)), 1.5 / 5 * (math.cos(b) - math.cos(a)), 0]
    elif row["body"] == "slow":
        wanted = [1.5 * (s + 0.2 * math.expm1(-s / 0.2)), 0, 0]
    else:
        wanted = [-w * math.expm1(-t / 0.5) for w in (3, -2, 1)]
    assert all(abs(x - y) < near for x, y in zip(v, wanted)), (row["body"], t, v, wanted)
PY
done
"$tcsim" run "$out/s.yaml" --check --set channels.motor.commands.axes=bdy >"$out/said" 2>&1 && fail "unknown axes were taken"
grep -q "channels.motor.commands.axes is the unknown 'bdy'; did you mean 'body'?" "$out/said" || fail "$(cat "$out/said")"
"$tcsim" run "$out/s.yaml" --check --set 'dynamics.together=[[slow, leef]]' >"$out/said" 2>&1 && fail "an unknown body was taken"
grep -q "names the unknown body 'leef'; did you mean 'leaf'?" "$out/said" || fail "$(cat "$out/said")"
"$tcsim" run "$out/s.yaml" --accounting fixed --out "$out/one" --set 'dynamics.together=[[slow, leaf]]' >"$out/said" 2>&1 || fail "$(cat "$out/said")"
