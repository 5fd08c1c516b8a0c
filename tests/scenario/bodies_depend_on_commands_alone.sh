#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# What a body does depends on the commands to it, and not on who has come how far: the same bytes for
# every drift bound, however programs compute, charged by the clock or not, and with others who look.
# Topics: determinism, physics, commands, drift.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/client.py" <<'PY'
import sys, time
end = time.monotonic() + float(sys.argv[1])
while time.monotonic() < end: pass
time.sleep(10)
PY
scenario() {  # DRIFT BUSY_S RATE
  cat <<YAML
duration: 1.5s
drift: $1
dynamics: {gravity: [0, 0, -9.81], region: {half_extent: 2, stiffness: 300, damping: 1}}
bodies:
  ball: {mass: 1.5, inertia: [0.1, 0.2, 0.25], linear_velocity: [3, 1, 0.5], angular_velocity: [0.1, 6, 0.2]}
  other: {mass: 1, inertia: [0.1, 0.1, 0.1], linear_velocity: [-1, 0, 2]}
robots:
  robot:
    clients:
      client: {command: [python3, client.py, "$2"], body: ball, fixed_call_cost: 50us}
channels:
  unheard:
    type: udp_json
    sensors: {bodies: [ball], rate: $3, to: "127.0.0.1:27395"}
YAML
}
run() {  # NAME DRIFT BUSY_S RATE [OPTION...]
  scenario "$2" "$3" "$4" >"$out/$1.yaml"
  "$tcsim" run "$out/$1.yaml" --out "$out/$1" "${@:5}" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  cmp "$out/first/bodies.csv" "$out/$1/bodies.csv" || fail "$1: the bodies move otherwise"
}
run first 1ms 1 100 --accounting fixed
(($(wc -l <"$out/first/bodies.csv") > 250)) || fail "the body states are missing"
run wide 20ms 1 100 --accounting fixed
run idle 1ms 0.1 100 --accounting fixed
run looked_at 0.3ms 1 970 --accounting fixed
run measured 1ms 0.4 100
run measured_wide 15ms 0.9 300
