#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# ROS 2's graph tools find a node for each robot, with its publishers and subscriptions by the GUIDs
# that DDS has for them; who comes late finds it, too, in the form of the release that the scenario
# names; a tool of the other one finds none.
# Topics: ros, dds.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/scenario.yaml" <<YAML
duration: 1s
dynamics: {}
bodies:
  ship: {mass: 1, inertia: [0.1, 0.1, 0.1]}
  wreck: {mass: 1, inertia: [0.1, 0.1, 0.1]}
robots:
  7-seas: {clients: {captain: {command: [sleep, "1"], body: ship}}}
  tools:
    clients:
      humble: {command: ["$build/bin/ros_graph", humble]}
      iron: {command: ["$build/bin/ros_graph", iron]}
clock: {}
channels:
  odometry: {type: dds, sensors: {bodies: [ship], message: nav_msgs/Odometry, topic: /odom}}
  drifting: {type: dds, sensors: {bodies: [wreck], message: nav_msgs/Odometry, topic: /adrift}}
  wrench: {type: dds, commands: {body: ship, message: geometry_msgs/Wrench, topic: /wrench}}
YAML
graph='/robot_7_seas/tcsim
/robot_7_seas/tcsim publishes rt/odom nav_msgs::msg::dds_::Odometry_
/robot_7_seas/tcsim subscribes to rt/wrench geometry_msgs::msg::dds_::Wrench_
/tcsim
/tcsim publishes rt/adrift nav_msgs::msg::dds_::Odometry_
/tcsim publishes rt/clock rosgraph_msgs::msg::dds_::Clock_'
shows() {  # RELEASE FORM OTHER_FORM
  "$tcsim" run "$out/scenario.yaml" --set "ros=$1" --out "$out/run" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  diff -u <(echo "$graph") "$out/run/tools-$2.out.log" || fail "of $1"
  ! grep '^/' "$out/run/tools-$3.out.log" || fail "a tool of the other form has read nodes"
}
shows humble humble iron  # where the older form reads as one without nodes
shows jazzy iron humble
grep -q 'a sample of DDS topic ros_discovery_info cannot be read.*ros: humble' "$out/run/tools-humble.err.log" ||
  fail "not told: $(cat "$out/run/tools-humble.err.log")"
