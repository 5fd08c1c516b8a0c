#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A Cyclone DDS program that knows nothing of tcs reads the sensors of a rover that stands on blocks in
# a room, and turns its wheels by Twist: all as closed forms have it; twice the same bytes.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/s.yaml" <<YAML
duration: 4s
dynamics: {gravity: [0, 0, -9.81]}
models:
  rover: {urdf: $source_root/tests/models/rover.urdf, fixed_base: true, at: {position: [1, -0.5, 0.3]}}
  floor: {plane: [0, 0, 1]}
  east: {box: [1, 20, 4], static: true, position: [5.5, 0, 0]}
  west: {box: [1, 20, 4], static: true, position: [-5.5, 0, 0]}
  north: {box: [20, 1, 4], static: true, position: [0, 3.5, 0]}
  south: {box: [20, 1, 4], static: true, position: [0, -3.5, 0]}
robots:
  rover:
    clients:
      senses: {command: [$build/bin/robot_probe, "3.9", "imu:/imu", "odometry:/odom", "scan:/scan", "joints:/joint_states"]}
      drives: {command: [$build/bin/robot_probe, "2", "twist:/cmd_vel:0.3:0.2"]}
channels:
  imu: {type: dds, sensors: {kind: imu, on: rover/base_link, rate: 100, topic: /imu}}
  odom: {type: dds, sensors: {kind: odometry, on: rover, at: {position: [0, 0, 0.1]}, rate: 50, topic: /odom, qos: {reliability: reliable}}}
  scan: {type: dds, sensors: {kind: lidar, on: rover/lidar_link, rate: 10, range: [0.1, 12], topic: /scan}}
  joints: {type: dds, sensors: {model: rover, joints: [left_wheel_joint, right_wheel_joint], rate: 50, message: sensor_msgs/msg/JointState, topic: /joint_states}}
  drive:
    type: dds
    commands: {model: rover, drive: differential, left: left_wheel_joint, right: right_wheel_joint, separation: 0.35, radius: 0.08, damping: 2, message: geometry_msgs/msg/Twist, topic: /cmd_vel}
YAML
for run in first second; do
  "$tcsim" run "$out/s.yaml" --accounting fixed --out "$out/$run" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
done
cmp "$out/first/rover-senses.out.log" "$out/second/rover-senses.out.log" || fail "a second run senses otherwise"
python3 - "$out/first/rover-senses.out.log" <<'PY' || fail "the sensors do not say what is so"
import json, math, sys
said = {}
for line in open(sys.argv[1]):
    sample = json.loads(line)
    said.setdefault(sample["topic"], []).append(sample)
def near(a, b, tolerance): assert abs(a - b) <= tolerance, (a, b)

start = said["/imu"][0]["stamp"] // 1
assert abs(len(said["/imu"]) - 390) <= 2 and said["/imu"][0]["frame_id"] == "base_link"
for felt in said["/imu"][1:]:
    assert felt["known"] == "yes"
    for axis, exact in zip(felt["linear_acceleration"], (0, 0, 9.81)): near(axis, exact, 1e-9)

odom = said["/odom"][-1]
assert (odom["frame_id"], odom["child_frame_id"]) == ("world", "base_footprint")
for axis, exact in zip(odom["position"], (1, -0.5, 0.4)): near(axis, exact, 1e-12)

scan = said["/scan"][-1]
assert scan["frame_id"] == "lidar_link" and len(scan["ranges"]) == 360
near(scan["time_increment"], 0.1 / 360, 1e-9)
near(scan["scan_time"], 0.1, 1e-8)
near((scan["stamp"] * 10) % 1, 0, 1e-5)  # the instant of the first ray
for i, range_m in enumerate(scan["ranges"]):
    angle = -math.pi + 2 * math.pi * i / 360
    c, s = math.cos(angle), math.sin(angle)
    walls = [(wall - x) / d for x, d, half in ((1.1, c, 5), (-0.5, s, 3)) for wall in (-half, half) if abs(d) > 1e-12]
    near(range_m, min(w for w in walls if w > 0), 1e-6)

# A servo for the velocity against the joint's damping and friction: 2 (wanted - v) = 0.02 v + 0.01.
driven = [j for j in said["/joint_states"] if 1 < j["stamp"] - start < 1.9][-1]
for velocity, side in zip(driven["velocity"], (-1, 1)):
    near(velocity, (2 * (0.3 + side * 0.2 * 0.35 / 2) / 0.08 - 0.01) / 2.02, 1e-4)
# 0.5 s after the last command the firmware stops the robot.
for velocity in said["/joint_states"][-1]["velocity"]: near(velocity, 0, 1e-3)
late = [j for j in said["/joint_states"] if 2.2 < j["stamp"] - start < 2.4]
assert late and all(j["velocity"][0] > 3 for j in late)
print("all as the closed forms have it")
PY
