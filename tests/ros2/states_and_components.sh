#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A lifecycle node of ROS 2's demos goes through all its states when they say so, and is heard at once; component containers load and
# unload the demos' components, in both accountings, by endpoints and by sockets.
ros2 pkg prefix lifecycle >/dev/null 2>&1 && ros2 pkg prefix composition >/dev/null 2>&1 && ros2 component -h >/dev/null 2>&1 ||
  { echo "this ROS 2 has no demos of lifecycle nodes and components (lifecycle, composition, ros2component)"; exit 77; }
out=$(mktemp -d)
trap 'wait; rm -rf "$out"' EXIT
use_folder "$out"
demos=$(ros2 pkg prefix lifecycle)/lib/lifecycle
containers=$(ros2 pkg prefix rclcpp_components)/lib/rclcpp_components
cat >"$out/states.sh" <<SH
$demos/lifecycle_talker & talker=\$!
$demos/lifecycle_listener & listener=\$!
timeout 100 $demos/lifecycle_service_client
kill -INT \$talker \$listener
wait
SH
cat >"$out/components.sh" <<SH
$containers/\$1 & container=\$!
sleep 1
ros2 component load /ComponentManager composition composition::Talker
ros2 component load /ComponentManager composition composition::Listener
sleep 1.5
ros2 component unload /ComponentManager 1
ros2 component list --no-daemon
kill -INT \$container
wait
SH
under_tcs() {  # WHAT COMMAND...
  for accounting in $accountings; do
    for dds in $ways; do
      timeout 300 "$tcsim" exec --cores 2 --accounting "$accounting" --dds "$dds" -- bash "${@:2}" >"$out/said" 2>"$out/errors" ||
        fail "$*, $accounting, $dds: $(cat "$out/said" "$out/errors")"
      "$1" || fail "$*, $accounting, $dds: $(cat "$out/said" "$out/errors")"
    done
  done
}
goes_through_its_states() {
  python3 - "$out/errors" <<'PY'
import re, sys
heard = re.findall(r"\[([\d.]+)\] \[lc_listener\]: notify callback: Transition from state \w+ to (\w+)", open(sys.argv[1]).read())
start = float(heard[0][0])
got = [(round(float(time) - start, 1), state) for time, state in heard]
# The client waits for 10 s between two, and activating takes the talker 2 s. The first is heard some ms late by sockets.
assert got == [
    (0, "configuring"), (0, "inactive"), (10, "activating"), (12, "active"), (20, "deactivating"), (20, "inactive"), (30, "activating"),
    (32, "active"), (40, "deactivating"), (40, "inactive"), (50, "cleaningup"), (50, "unconfigured"), (60, "shuttingdown"),
    (60, "finalized")], got
PY
}
loads_and_unloads() {
  [[ $(cat "$out/said") == "Loaded component 1 into '/ComponentManager' container node as '/talker'
Loaded component 2 into '/ComponentManager' container node as '/listener'
Unloaded component 1 from '/ComponentManager' container node
/ComponentManager
  2  /listener" ]] && grep -q 'I heard: \[Hello World: ' "$out/errors"
}
accountings="measured fixed" ways="endpoints sockets"
under_tcs goes_through_its_states "$out/states.sh"
under_tcs loads_and_unloads "$out/components.sh" component_container
ways=endpoints
under_tcs loads_and_unloads "$out/components.sh" component_container_mt
under_tcs loads_and_unloads "$out/components.sh" component_container_isolated
