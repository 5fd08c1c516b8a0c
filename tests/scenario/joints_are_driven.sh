#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A program that knows nothing of tcs holds a pendulum of a URDF file where it wants it: by efforts of
# its own, and by one command to the channel's servo. Both as the closed form has it, and twice the same bytes.
# Topics: models, commands, physics, udp, determinism.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/hold.py" <<'PY'
import json, math, socket, sys
states = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
states.bind(("127.0.0.1", 27410))
commands = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
def send(what): commands.sendto(json.dumps({"hinge": what}).encode(), ("127.0.0.1", 27411))
if sys.argv[1] == "servo": send(0.5)
while True:
    hinge = json.loads(states.recv(4096))["joints"]["hinge"]
    if sys.argv[1] == "efforts":
        send(9.81 * math.sin(0.5) + 60 * (0.5 - hinge["position"]) - 12 * hinge["velocity"])
PY
scenario() {  # HOW DRIVE
  cat <<YAML
duration: 6s
dynamics: {gravity: [0, 0, -9.81]}
models: {pendulum: {urdf: $source_root/tests/models/pendulum.urdf, fixed_base: true}}
robots: {r: {clients: {c: {command: [python3, hold.py, $1]}}}}
channels:
  states: {type: udp_json, sensors: {model: pendulum, rate: 200, to: "127.0.0.1:27410"}}
  commands: {type: udp_json, commands: {model: pendulum, listen: "127.0.0.1:27411"$2}}
YAML
}
angle() {  # NAME HOW DRIVE: where the pendulum is at the end
  scenario "$2" "$3" >"$out/$1.yaml"
  "$tcsim" run "$out/$1.yaml" --accounting fixed --out "$out/$1" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  tail -n 1 "$out/$1/bodies.csv" | awk -F, '{ printf "%.9f", 2 * atan2($7, $9) }'
}
first=$(angle first efforts "")
[[ $(angle second efforts "") == "$first" ]] || fail "a second run ends elsewhere"
cmp "$out/first/bodies.csv" "$out/second/bodies.csv" || fail "a second run moves otherwise"
servo=$(angle servo servo ", drive: position, stiffness: 50, damping: 12")
# The servo stands where its stiffness holds the weight: 50 (0.5 - a) = 9.81 sin a.
python3 - "$first" "$servo" <<'PY' || fail "the pendulum is held elsewhere: $first and $servo rad"
import math, sys
held, servo = map(float, sys.argv[1:])
exact = 0.5
for _ in range(200): exact = 0.5 - 9.81 / 50 * math.sin(exact)
print(f"held at {held} rad; by the servo at {servo}, which is to be {exact}")
assert abs(held - 0.5) < 1e-4 and abs(servo - exact) < 1e-6
PY
