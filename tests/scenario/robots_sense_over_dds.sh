#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A Cyclone DDS program that knows nothing of tcs reads the sensors of a rover that stands on blocks in
# a room, and turns its wheels by Twist: all as closed forms have it; twice the same bytes.
# Topics: sensors, dds, ros, models, determinism.
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
      senses:
        command: [$build/bin/robot_probe, "3.9", "imu:/imu", "odometry:/odom", "scan:/scan", "joints:/joint_states", "odometry:/wheels",
                  "transforms:/tf", "cloud:/points", "range:/sonar", "image:/depth", "gnss:/fix", "magnetic:/mag", "pressure:/baro", "bool:/bump"]
      late: {command: [$build/bin/robot_probe, "0.5", "fixed:/tf_static", "text:/robot_description"], start: 3s}
      drives: {command: [$build/bin/robot_probe, "2", "twist:/cmd_vel:0.3:0.2"]}
channels:
  imu: {type: dds, sensors: {kind: imu, on: rover/base_link, rate: 100, topic: /imu}}
  odom: {type: dds, sensors: {kind: odometry, on: rover, at: {position: [0, 0, 0.1]}, rate: 50, topic: /odom, qos: {reliability: reliable}}}
  scan: {type: dds, sensors: {kind: lidar, on: rover/lidar_link, rate: 10, range: [0.1, 12], topic: /scan}}
  joints: {type: dds, sensors: {model: rover, joints: [left_wheel_joint, right_wheel_joint], rate: 50, message: sensor_msgs/msg/JointState, topic: /joint_states}}
  wheels: {type: dds, sensors: {kind: wheel_odometry, model: rover, left: left_wheel_joint, right: right_wheel_joint, separation: 0.35, radius: 0.08, rate: 50, topic: /wheels}}
  tf: {type: dds, sensors: {kind: transforms, model: rover, world_frame: map, rate: 20}}
  tf_static: {type: dds, sensors: {kind: fixed_transforms, model: rover}}
  description: {type: dds, sensors: {kind: description, model: rover}}
  points: {type: dds, sensors: {kind: lidar_3d, on: rover/lidar_link, rate: 5, rays: 36, layers: 2, elevations: [-0.1, 0.1], topic: /points}}
  sonar: {type: dds, sensors: {kind: range, on: rover/base_link, at: {position: [0.2, 0, 0]}, field_of_view: 0.01, range: [0.02, 10], rate: 10, topic: /sonar}}
  depth: {type: dds, sensors: {kind: depth_camera, on: rover/base_link, at: {position: [0.2, 0, 0]}, width: 4, height: 2, field_of_view: 0.2, rate: 5, topic: /depth}}
  fix: {type: dds, sensors: {kind: gnss, on: rover/base_link, origin: [48, 11, 500], rate: 5, topic: /fix}}
  mag: {type: dds, sensors: {kind: magnetometer, on: rover/base_link, rate: 5, topic: /mag}}
  baro: {type: dds, sensors: {kind: barometer, on: rover/base_link, rate: 5, topic: /baro}}
  bump: {type: dds, sensors: {kind: contact, on: rover/left_wheel, rate: 10, topic: /bump}}
  drive:
    type: dds
    commands: {model: rover, drive: differential, left: left_wheel_joint, right: right_wheel_joint, separation: 0.35, radius: 0.08, damping: 2, message: geometry_msgs/msg/Twist, topic: /cmd_vel}
YAML
for run in first second; do
  "$tcsim" run "$out/s.yaml" --accounting fixed --record --out "$out/$run" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
done
cmp "$out/first/rover-senses.out.log" "$out/second/rover-senses.out.log" || fail "a second run senses otherwise"
python3 -B - "$out/first/rover-senses.out.log" "$out/first/rover-late.out.log" "$out/first" "$source_root/tests/scenario" <<'PY' || fail "the sensors do not say what is so"
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

# What the firmware reckons, of wheels that turn in the air.
wheels = said["/wheels"][-1]
assert (wheels["frame_id"], wheels["child_frame_id"]) == ("odom", "base_link")
turned = said["/joint_states"][-1]["position"]
yaw = 0.08 * (turned[1] - turned[0]) / 0.35
near(2 * math.atan2(wheels["orientation"][2], wheels["orientation"][3]), yaw, 1e-6)
assert yaw > 0.2 and math.hypot(*wheels["position"]) > 0.4

tf = said["/tf"][-1]["transforms"]
assert [t["child_frame_id"] for t in tf] == ["base_footprint", "left_wheel", "right_wheel"]
assert (tf[0]["frame_id"], tf[1]["frame_id"]) == ("map", "base_link")
for axis, exact in zip(tf[1]["translation"], (0.1, 0.175, -0.02)): near(axis, exact, 1e-9)

cloud = said["/points"][-1]
assert cloud["fields"] == "x y z time ring " and len(cloud["points"]) == 5 * 72
for i in range(72):
    x, y, z, time, ring = cloud["points"][5 * i:5 * i + 5]
    assert ring == i % 2
    near(time, 0.2 * (i // 2) / 36, 1e-6)
    near(z / math.hypot(x, y), math.tan(0.1 if ring else -0.1), 1e-5)
    height = 0.49 + z  # of the lidar above the floor
    at_wall = min(abs(1.1 + x - 5), abs(1.1 + x + 5), abs(-0.5 + y - 3), abs(-0.5 + y + 3)) < 1e-4
    assert at_wall or abs(height) < 1e-4, (x, y, z)

assert said["/sonar"][-1]["radiation_type"] == 0
near(said["/sonar"][-1]["range"], 5 - 1.2, 1e-5)
image = said["/depth"][-1]
assert (image["width"], image["height"], image["encoding"], image["step"]) == (4, 2, "32FC1", 16)
for depth in image["depths"]: near(depth, 5 - 1.2, 1e-6)
fix = said["/fix"][-1]
near(fix["altitude"], 500.4, 1e-5)
near((fix["longitude"] - 11) * math.pi / 180 * 6388838 * math.cos(math.radians(48)), 1, 1e-3)
for axis, exact in zip(said["/mag"][-1]["field"], (0, 2e-5, -4.4e-5)): near(axis, exact, 1e-15)
near(said["/baro"][-1]["pressure"], 101325 - 1.2252 * 9.80665 * 0.4, 0.01)
assert not any(b["data"] for b in said["/bump"])  # the wheels are in the air

# Whoever comes late has what was said once.
late = {s["topic"]: s for s in map(json.loads, open(sys.argv[2]))}
static = {t["child_frame_id"]: t for t in late["/tf_static"]["transforms"]}
assert sorted(static) == ["base_link", "caster", "lidar_link"]
for axis, exact in zip(static["lidar_link"]["translation"], (0.1, 0, 0.09)): near(axis, exact, 1e-9)
assert late["/robot_description"]["length"] > 3000 and late["/robot_description"]["begins"] == "<?xml"

# The bag has what was read, and what was said; read by the definitions that are in it.
sys.path.insert(0, sys.argv[4])
from recording import Bag
bag = Bag(sys.argv[3])
counts = {name: (type, len(bag.samples[name])) for name, type, *_ in bag.topics if bag.samples[name]}
# Where the rover really was is kept apart from what it says.
assert counts.pop("/world/tf")[0] == "tf2_msgs/msg/TFMessage", counts
types = {"/imu": "sensor_msgs/msg/Imu", "/odom": "nav_msgs/msg/Odometry", "/scan": "sensor_msgs/msg/LaserScan", "/wheels": "nav_msgs/msg/Odometry",
         "/joint_states": "sensor_msgs/msg/JointState", "/points": "sensor_msgs/msg/PointCloud2", "/sonar": "sensor_msgs/msg/Range",
         "/depth": "sensor_msgs/msg/Image", "/fix": "sensor_msgs/msg/NavSatFix", "/mag": "sensor_msgs/msg/MagneticField",
         "/baro": "sensor_msgs/msg/FluidPressure", "/bump": "std_msgs/msg/Bool", "/tf": "tf2_msgs/msg/TFMessage", "/tf_static": "tf2_msgs/msg/TFMessage",
         "/robot_description": "std_msgs/msg/String", "/cmd_vel": "geometry_msgs/msg/Twist"}
assert {name: type for name, (type, _) in counts.items()} == types, counts
for name in said: assert abs(counts[name][1] - len(said[name])) <= 0.2 * len(said[name]), (name, counts[name])
assert counts["/tf_static"][1] == counts["/robot_description"][1] == 1
recorded = lambda topic: {fields[0] + 1e-9 * fields[1]: fields for _, fields in bag.samples[topic]}
def both(topic):
    """Pairs of what the program read and what the bag has with the same stamp."""
    at = recorded(topic)
    pairs = [(one, at[stamp]) for one in said[topic] for stamp in at if abs(stamp - one["stamp"]) < 1e-4]
    assert len(pairs) == len(said[topic]), (topic, len(pairs), len(said[topic]))
    return pairs
for one, fields in both("/imu"): assert fields[2] == "base_link" and fields[28:31] == one["linear_acceleration"], (one, fields)
for one, fields in both("/odom"): assert fields[2:4] == ["world", "base_footprint"] and fields[4:7] == one["position"]
for one, fields in both("/scan"):
    assert fields[10] == 360 and fields[371:] == [0]
    for a, b in zip(one["ranges"], fields[11:371]): near(a, b, 1e-5)
for one, fields in both("/joint_states"):
    assert fields[3:6] == [2, "left_wheel_joint", "right_wheel_joint"] and fields[7:9] == one["position"] and fields[10:12] == one["velocity"]
for one, fields in both("/points"): assert fields[3:5] == [1, 72] and fields[5] == 5 and fields[6] == "x" and len(fields) == 31 + 72 * 18
for one, fields in both("/fix"): near(fields[7], one["altitude"], 1e-9)
(_, (words,)), = bag.samples["/robot_description"]
assert len(words) == late["/robot_description"]["length"]
assert all(fields == [0.3, 0, 0, 0, 0, 0.2] for _, fields in bag.samples["/cmd_vel"])
print("all as the closed forms have it")
PY
