#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# ros2_control's controller manager moves an arm of the world along a trajectory, by the hardware interface of examples/ros2: its loop
# keeps 100, 500 and 1,000 Hz, and fixed runs repeat to the byte.
ros2 pkg prefix controller_manager >/dev/null 2>&1 && ros2 pkg prefix joint_trajectory_controller >/dev/null 2>&1 ||
  { echo "this ROS 2 has no ros2_control (controller_manager, joint_trajectory_controller)"; exit 77; }
build_nodes
set_up_package
out=$(mktemp -d)
trap 'wait; rm -rf "$out"' EXIT
unset ROS_DOMAIN_ID
moves() {  # HZ OPTIONS...
  local hertz=$1
  shift
  timeout 300 "$tcsim" run "$ros/install/share/tcs/scenarios/arm.yaml" "$@" --out "$out/run" --set channels.measured.sensors.rate="$hertz" \
    --set "robots.arm.clients.control.command=[ros2, launch, tcs, arm.launch.py, 'update_rate:=$hertz']" >"$out/said" 2>&1 ||
    fail "$hertz Hz, $*: status $?: $(cat "$out/said" "$out"/run/*.log)"
  grep -q 'Goal finished with status: SUCCEEDED' "$out/run/arm-control.out.log" || fail "$hertz Hz, $*: $(cat "$out/said" "$out"/run/*.log)"
  ! grep -q 'was killed' "$out/said" || fail "$hertz Hz, $*: $(cat "$out/said")"
  ! grep -hi 'overrun' "$out"/run/*.log || fail "$hertz Hz, $*: the loop is too slow"
  python3 - "$out/run/topics.json" "$hertz" <<'PY' || fail "$hertz Hz, $*"
import json, sys
file, hertz = sys.argv[1], float(sys.argv[2])
rate = {topic["topic"]: topic["rate_hz"] for topic in json.load(open(file))["topics"]}["/arm/commands"]
assert abs(rate / hertz - 1) < 0.001, rate
PY
}
for hertz in 100 500 1000; do moves "$hertz"; done
for run in first second; do
  moves 1000 --accounting fixed
  mkdir "$out/$run"
  cp "$out"/run/*.csv "$out/$run"
done
for file in bodies joints commands dispatches activations; do
  cmp "$out/first/$file.csv" "$out/second/$file.csv" || fail "fixed runs differ: $file.csv"
done
