#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Nodes of rclcpp and of rclpy fly the drone and drive the rover of examples/ros2 as these scenarios expect, in both accountings; fixed
# runs repeat to the byte; a slow computer misses deadlines.
build_nodes
set_up_package
out=$(mktemp -d)
trap 'wait; rm -rf "$out"' EXIT
unset ROS_DOMAIN_ID
scenarios=$ros/install/share/tcs/scenarios
flies() {  # NAME SCENARIO OPTIONS...
  local name=$1 scenario=$2
  shift 2
  timeout 200 "$tcsim" run "$scenarios/$scenario" "$@" --out "$out/$name" >"$out/said" 2>&1 || fail "$name: status $?: $(cat "$out/said" "$out/$name"/*.log)"
  ! grep -hv '^\[INFO\]' "$out/$name"/*.err.log || fail "$name: $(cat "$out/$name"/*.err.log)"
  grep ' x real time' "$out/said" | sed "s/^/$name: /"
}
hover_py='robots.drone.clients.controller.command=["'$ros'/install/lib/tcs/hover.py"]'
flies hover hover.yaml
flies hover_py hover.yaml --set "$hover_py"
for run in first second; do flies "$run" hover.yaml --accounting fixed --record; done
for file in bodies.csv dispatches.csv activations.csv bag/bag_0.db3; do
  cmp "$out/first/$file" "$out/second/$file" || fail "fixed runs differ: $file"
done
flies hover_py_fixed hover.yaml --accounting fixed --set "$hover_py"
# As with any other middleware.
by_sockets=(--set robots.drone.clients.controller.dds=sockets --set expect.controller=null)
flies hover_sockets hover.yaml "${by_sockets[@]}"
for run in third fourth; do flies "$run" hover.yaml --accounting fixed "${by_sockets[@]}"; done
cmp "$out/third/bodies.csv" "$out/fourth/bodies.csv" || fail "fixed runs by sockets differ"
flies rover rover.yaml
flies rover_fixed rover.yaml --accounting fixed
status=0
"$tcsim" run "$scenarios/hover.yaml" --set robots.drone.cpu.speed=0.01 --out "$out/slow" >"$out/said" 2>&1 || status=$?
{ ((status == 3)) && grep -q 'missed' "$out/said"; } || fail "a slow computer: status $status: $(cat "$out/said")"
