#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A Cyclone DDS program drives a rover on a floor by Twist. Where its firmware reckons it from its wheels
# is where it is, but for their slip; a wrong radius makes it reckon wrong by as much.
# Topics: dds, ros, models, sensors.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/s.yaml" <<YAML
duration: 6s
dynamics: {gravity: [0, 0, -9.81]}
models:
  rover: {urdf: $source_root/tests/models/rover.urdf, at: {position: [0, 0, 0.001]}}
  floor: {plane: [0, 0, 1]}
robots: {rover: {clients: {c: {command: [$build/bin/robot_probe, "5.9", "odometry:/truth", "odometry:/wheels", "odometry:/wrong", "twist:/cmd_vel:0.3:0"]}}}}
channels:
  truth: {type: dds, sensors: {kind: odometry, on: rover, rate: 20, topic: /truth}}
  wheels: {type: dds, sensors: {kind: wheel_odometry, model: rover, left: left_wheel_joint, right: right_wheel_joint, separation: 0.35, radius: 0.08, rate: 20, topic: /wheels}}
  wrong: {type: dds, sensors: {kind: wheel_odometry, model: rover, left: left_wheel_joint, right: right_wheel_joint, separation: 0.35, radius: 0.088, rate: 20, topic: /wrong}}
  drive:
    type: dds
    commands: {model: rover, drive: differential, left: left_wheel_joint, right: right_wheel_joint, separation: 0.35, radius: 0.08, damping: 20, message: geometry_msgs/msg/Twist, topic: /cmd_vel}
YAML
"$tcsim" run "$out/s.yaml" --accounting fixed --out "$out/run" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
python3 - "$out/run/rover-c.out.log" <<'PY' || fail "the wheels reckon otherwise"
import json, sys
last = {s["topic"]: s for s in map(json.loads, open(sys.argv[1]))}
went, reckoned, wrong = (last[t]["position"][0] for t in ("/truth", "/wheels", "/wrong"))
print(f"went {went} m, reckoned {reckoned} m, and with a wrong radius {wrong} m")
assert went > 1.5 and abs(reckoned / went - 1) < 0.02
assert abs(wrong / reckoned - 1.1) < 1e-9
assert abs(last["/truth"]["linear"][0] - last["/wheels"]["linear"][0]) < 0.01
PY
