#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Robots from URDF files move as their files say: a pendulum with the period of the closed form, a
# rover that drops onto its wheels; twice the same bytes. What is wrong in a file is said with its line.
# Topics: models, physics, failures, determinism.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cp -r "$source_root/tests/models" "$out/models"
sed -i 's|</robot>|<gazebo reference="left_wheel"><kp>1</kp></gazebo><gazebo/></robot>|' "$out/models/rover.urdf"
cat >"$out/s.yaml" <<'YAML'
duration: 10s
dynamics: {gravity: [0, 0, -9.81], accuracy: 1e-7}
models:
  pendulum: {urdf: models/pendulum.urdf, fixed_base: true, at: {position: [5, 0, 2]}, joints: {hinge: 0.1}}
  rover: {urdf: models/rover.urdf, at: {position: [0, 0, 0.02]}}
  floor: {plane: [0, 0, 1]}
robots:
  r: {clients: {c: {command: [sleep, "10"]}}}
YAML
for run in first second; do
  "$tcsim" run "$out/s.yaml" --accounting fixed --out "$out/$run" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
done
cmp "$out/first/bodies.csv" "$out/second/bodies.csv" || fail "a second run moves otherwise"
(($(grep -c '<gazebo> is not understood' "$out/said") == 1)) || fail "what was left out is not said once"
python3 - "$out/first/bodies.csv" <<'PY' || fail "the robots do not move as their files say"
import csv, math, sys
tilts, last = [], {}
for row in csv.DictReader(open(sys.argv[1])):
    last[row["body"]] = row
    if row["body"] == "pendulum/rod":
        tilts.append((float(row["time_s"]), 2 * math.atan2(float(row["qy"]), float(row["qw"]))))
crossings = [t + (u - t) * a / (a - b) for (t, a), (u, b) in zip(tilts, tilts[1:]) if a > 0 >= b]
def mean(a, b):
    while abs(a - b) > 1e-15: a, b = (a + b) / 2, math.sqrt(a * b)
    return a
exact = 2 * math.pi * math.sqrt((1 + 1e-4) / 9.81) / mean(1, math.cos(0.05))
period = (crossings[-1] - crossings[0]) / (len(crossings) - 1)
print(f"period {period} s, closed form {exact} s")
assert len(crossings) == 5 and abs(period / exact - 1) < 1e-6
rover = last["rover/base_link"]
print(f"the rover stands at {rover['z_m']} m")
assert abs(float(rover["z_m"]) - 0.1) < 1e-4 and abs(float(rover["vz_mps"])) < 1e-6
assert abs(float(last["rover/base_footprint"]["z_m"])) < 1e-4
PY
sed -i 's/<mass value="8"/<mass value="heavy"/' "$out/models/rover.urdf"
said=$("$tcsim" run "$out/s.yaml" --check 2>&1) && fail "a mass that is no number was taken"
[[ $said == *"/models/rover.urdf:9: value of <mass> in link 'base_link' is 'heavy'; it must be a finite number" ]] ||
  fail "another sentence: $said"
