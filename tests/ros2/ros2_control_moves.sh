#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# ros2_control's controller manager moves an arm of the world along a trajectory, by the hardware interface of examples/ros2.
ros2 pkg prefix controller_manager >/dev/null 2>&1 && ros2 pkg prefix joint_trajectory_controller >/dev/null 2>&1 ||
  { echo "this ROS 2 has no ros2_control (controller_manager, joint_trajectory_controller)"; exit 77; }
build_nodes
set_up_package
out=$(mktemp -d)
trap 'wait; rm -rf "$out"' EXIT
unset ROS_DOMAIN_ID
timeout 300 "$tcsim" run "$ros/install/share/tcs/scenarios/arm.yaml" --out "$out/run" >"$out/said" 2>&1 ||
  fail "status $?: $(cat "$out/said" "$out"/run/*.log)"
grep -q 'Goal finished with status: SUCCEEDED' "$out/run/arm-control.out.log" || fail "$(cat "$out/said" "$out"/run/*.log)"
! grep -q 'was killed' "$out/said" || fail "$(cat "$out/said")"
