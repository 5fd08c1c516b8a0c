#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A Cyclone DDS program that knows nothing of tcs reads a pendulum's JointState and holds it where it
# wants by efforts of its own, as ros2_control's forward controllers are told them; twice the same bytes.
# Topics: dds, models, commands, determinism.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/s.yaml" <<YAML
duration: 6s
dynamics: {gravity: [0, 0, -9.81]}
models: {pendulum: {urdf: $source_root/tests/models/pendulum.urdf, fixed_base: true}}
robots: {r: {clients: {c: {command: [$build/bin/robot_probe, "6", "hold:/joint_states:/efforts:0.5"]}}}}
channels:
  states: {type: dds, sensors: {model: pendulum, rate: 200, message: sensor_msgs/msg/JointState, topic: /joint_states}}
  efforts: {type: dds, commands: {model: pendulum, message: std_msgs/msg/Float64MultiArray, topic: /efforts}}
YAML
for run in first second; do
  "$tcsim" run "$out/s.yaml" --accounting fixed --record --out "$out/$run" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
done
cmp "$out/first/bodies.csv" "$out/second/bodies.csv" || fail "a second run moves otherwise"
angle=$(tail -n 1 "$out/first/bodies.csv" | awk -F, '{ printf "%.9f", 2 * atan2($7, $9) }')
python3 "$source_root/tests/scenario/recording.py" topics "$out/first" \
  /joint_states:sensor_msgs/msg/JointState /efforts:std_msgs/msg/Float64MultiArray || fail "the bag is not whole"
awk -v a="$angle" 'BEGIN { exit !(a > 0.4999 && a < 0.5001) }' || fail "the pendulum is held at $angle rad"
