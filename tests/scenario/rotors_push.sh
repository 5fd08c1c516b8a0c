#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A program that knows nothing of tcs spins the rotors of a robot and pushes its link: it climbs and turns as the
# closed form has it, on each engine; what was commanded twice, beyond a limit or never is said at the end.
# Topics: models, commands, physics.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cp "$(dirname -- "${BASH_SOURCE[0]}")/craft.urdf" "$out"
cat >"$out/client.py" <<'PY'
import socket, time
commands = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
time.sleep(0.1)
commands.sendto(b'{"left": 0.5}', ("127.0.0.1", 27421))
commands.sendto(b'{"right": 2.0}', ("127.0.0.1", 27421))
commands.sendto(b'{"right": 0.5}', ("127.0.0.1", 27421))
commands.sendto(b'{"force": [6, 0, 0]}', ("127.0.0.1", 27422))
time.sleep(10)
PY
cat >"$out/s.yaml" <<'YAML'
duration: 1s
dynamics: {accuracy: 1e-8}
models:
  craft:
    urdf: craft.urdf
    rotors:
      left: {link: base, thrust: 1e-5, drag: 2e-7, direction: ccw, time_constant: 50ms, limit: 1000}
      right: {link: base, thrust: 1e-5, drag: 1e-7, direction: cw, time_constant: 50ms, limit: 1000}
      idle: {link: base, thrust: 1, time_constant: 50ms, limit: 1000}
robots: {r: {cpu: ideal, clients: {c: {command: [python3, client.py]}}}}
channels:
  motors: {type: udp_json, commands: {model: craft, rotors: [left, right, idle], drive: normalised, listen: "127.0.0.1:27421"}}
  push: {type: udp_json, commands: {on: craft/base, axes: world, limits: {force: 4}, listen: "127.0.0.1:27422"}}
YAML
engines=(simbody)
"$tcsim" run "$out/s.yaml" --check --set dynamics.accuracy=null --set dynamics.engine=mujoco >/dev/null 2>&1 && engines+=(mujoco)
for engine in "${engines[@]}"; do
  extra=()
  [[ $engine == mujoco ]] && extra=(--set dynamics.engine=mujoco --set dynamics.accuracy=null)
  "$tcsim" run "$out/s.yaml" --accounting fixed --out "$out/run" "${extra[@]}" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  for sentence in \
    "rotor 'right' of craft was commanded once at an instant for which it already had a command, first at 0.1" \
    "rotor 'right' of craft was commanded once beyond its limit, first at 0.1" \
    "the speed 2, of which it got 1" "rotor 'idle' of craft was never commanded, though others of channel motors were"; do
    grep -q "$sentence" "$out/said" || fail "$engine: no '$sentence' in: $(cat "$out/said")"
  done
  python3 - "$out/run" <<'PY' || fail "$engine: $(cat "$out/said")"
import csv, math, sys
rows = list(csv.DictReader(open(f"{sys.argv[1]}/bodies.csv")))
assert len(rows) == 101
# The client starts within the first microseconds; it is charged nothing.
start = next(float(r["time_s"]) for r in rows if float(r["vx_mps"]) > 0)
assert 0.1 <= start <= 0.12, start
def square(t): return 500**2 * (t + 0.1 * math.expm1(-t / 0.05) - 0.025 * math.expm1(-2 * t / 0.05))
for row in rows:
    t = max(0, float(row["vx_mps"]) / 2)  # 4 N on 2 kg: since the commands
    vz, wz = float(row["vz_mps"]), float(row["wz_radps"])
    assert abs(vz - 2e-5 / 2 * square(t)) < 1e-6, (t, vz)
    assert abs(wz + 1e-7 / 0.02 * square(t)) < 1e-6, (t, wz)
assert t > 0.85
PY
done
said=$("$tcsim" run "$out/s.yaml" --check --set 'channels.motors.commands.rotors=[left, rigt]' 2>&1) && fail "an unknown rotor was taken"
[[ $said == *"names the unknown rotor 'rigt' of craft; did you mean 'right'?" ]] || fail "another sentence: $said"
