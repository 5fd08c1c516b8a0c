#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# ROS 2's graph tools find a node for each robot, with its publishers and subscriptions by the GUIDs
# that DDS has for them; who comes late finds it, too, in the form of the release that the scenario
# names; a tool of the other one finds none.
# Topics: ros, dds.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/scenario.yaml" <<YAML
duration: 3s
dynamics: {}
bodies:
  ship: {mass: 1, inertia: [0.1, 0.1, 0.1]}
  wreck: {mass: 1, inertia: [0.1, 0.1, 0.1]}
robots:
  7-seas: {clients: {captain: {command: [sleep, "3"], body: ship}}}
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
# Since Iron nodes warn of endpoints that do not say the hash of their type.
graph='/robot_7_seas/tcsim
/robot_7_seas/tcsim publishes rt/odom nav_msgs::msg::dds_::Odometry_ RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0
/robot_7_seas/tcsim subscribes to rt/wrench geometry_msgs::msg::dds_::Wrench_ RIHS01_018e8519d57c16adbe97c9fe1460ef21fec7e31bc541de3d653a35895677ce52
/tcsim
/tcsim publishes rt/adrift nav_msgs::msg::dds_::Odometry_ RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0
/tcsim publishes rt/clock rosgraph_msgs::msg::dds_::Clock_ RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564
nodes are told of by rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_ RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e'
shows() {  # RELEASE FORM OTHER_FORM GRAPH
  "$tcsim" run "$out/scenario.yaml" --set "ros=$1" --out "$out/run" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  diff -u <(echo "$4") "$out/run/tools-$2.out.log" || fail "of $1"
  ! grep '^/' "$out/run/tools-$3.out.log" || fail "a tool of the other form has read nodes"
}
shows humble humble iron "$(sed 's/ RIHS01_.*//' <<<"$graph")"  # where the older form reads as one without nodes
shows jazzy iron humble "$graph"
grep -q 'a sample of DDS topic ros_discovery_info cannot be read.*ros: humble' "$out/run/tools-humble.err.log" ||
  fail "not told: $(cat "$out/run/tools-humble.err.log")"
