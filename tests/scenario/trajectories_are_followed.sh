#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A Cyclone DDS program sends a JointTrajectory, and the pendulum's servo follows it: where it is to be
# at each instant, less what the servo lags behind; twice the same bytes, on both engines.
# Topics: dds, ros, commands, models.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
for engine in simbody mujoco; do
  cat >"$out/$engine.yaml" <<YAML
duration: 4s
dynamics: {gravity: [0, 0, 0], engine: $engine}
models: {pendulum: {urdf: $source_root/tests/models/pendulum.urdf, fixed_base: true}}
robots: {r: {clients: {c: {command: [$build/bin/robot_probe, "3.9", "joints:/joint_states", "trajectory:/arm_controller/joint_trajectory:hinge:1:1:-0.5:2.5"]}}}}
channels:
  states: {type: dds, sensors: {model: pendulum, rate: 100, message: sensor_msgs/msg/JointState, topic: /joint_states}}
  follow:
    type: dds
    commands: {model: pendulum, drive: trajectory, stiffness: 4000, damping: 200, rate: 200, message: trajectory_msgs/msg/JointTrajectory, topic: /arm_controller/joint_trajectory}
YAML
  for run in first second; do
    "$tcsim" run "$out/$engine.yaml" --accounting fixed --record --out "$out/$engine-$run" >"$out/said" 2>&1 || {
      grep -q 'built without MuJoCo' "$out/said" && exit 0
      fail "$(cat "$out/said")"
    }
  done
  cmp "$out/$engine-first/bodies.csv" "$out/$engine-second/bodies.csv" || fail "a second run on $engine moves otherwise"
  python3 "$source_root/tests/scenario/recording.py" topics "$out/$engine-first" /joint_states:sensor_msgs/msg/JointState \
    /arm_controller/joint_trajectory:trajectory_msgs/msg/JointTrajectory || fail "the bag is not whole"
  python3 - "$out/$engine-first/r-c.out.log" <<'PY' || fail "on $engine the pendulum goes elsewhere"
import json, sys
states = [json.loads(line) for line in open(sys.argv[1])]
begun = next(s["stamp"] for s in states if abs(s["velocity"][0]) > 0.01)
def wanted(t):  # to 1 in 1 s, to -0.5 in 1.5 s, and stay
    return t if t < 1 else 1 - (t - 1) if t < 2.5 else -0.5
worst = max(abs(s["position"][0] - wanted(s["stamp"] - begun)) for s in states if s["stamp"] > begun)
last = states[-1]
print(f"off by {worst} rad at most, {abs(last['position'][0] + 0.5)} at the end, where it goes at {last['velocity'][0]} rad/s")
assert worst < 0.01 and abs(last["position"][0] + 0.5) < 1e-5 and abs(last["velocity"][0]) < 1e-4
PY
done
