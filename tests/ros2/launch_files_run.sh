#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Launch files start the nodes of two robots, each in its namespace, and end in order; the command line sees nodes, topics, rates and
# types; a launch file runs a scenario by the action of the package.
build_nodes
set_up_package
out=$(mktemp -d)
trap 'wait; rm -rf "$out"' EXIT
unset ROS_DOMAIN_ID
export ROS_HOME=$out/ros ROS_LOG_DIR=$out/ros/log
scenarios=$ros/install/share/tcs/scenarios
cat >"$out/looks.sh" <<'SH'
sleep 8
ros2 node list --no-daemon | sort
ros2 topic list --no-daemon | sort
ros2 topic info -v --no-daemon /red/odom
timeout -s INT 5 ros2 topic hz /red/scan
ros2 topic echo --once /blue/odom nav_msgs/msg/Odometry
ros2 param get --no-daemon /red/rover speed
echo done
SH
timeout 300 "$tcsim" run "$scenarios/two_rovers.yaml" --out "$out/run" --set duration=30s \
  --set "robots.desk={cpu: {cores: 1}, clients: {looks: {command: [bash, $out/looks.sh], environment: {PYTHONUNBUFFERED: '1'}}}}" >"$out/said" 2>&1 ||
  fail "two rovers: $(cat "$out/said" "$out"/run/*.log)"
! grep -q 'was killed' "$out/said" || fail "two rovers: $(cat "$out/said")"
log=$out/run/desk-looks.out.log
for line in /red/rover /blue/rover /red/odom /blue/scan done 'Double value is: 0.6'; do
  grep -qxF "$line" "$log" || fail "the command line does not tell of $line: $(cat "$log" "${log/out.log/err.log}")"
done
grep -q 'Topic type hash: RIHS01_' "$log" || fail "no hash: $(cat "$log")"
! grep -h 'Failed to parse' "$out"/run/*.log || fail "a type hash is not understood"
python3 - "$log" "$out/run/bodies.csv" <<'PY' || fail "$(cat "$log")"
import re, sys
rates = [float(rate) for rate in re.findall(r"average rate: (\S+)", open(sys.argv[1]).read())]
assert rates and all(abs(rate - 20) < 0.1 for rate in rates), rates
PY
(cd "$out" && timeout 300 ros2 launch tcs hover.launch.py out:="$out/launched") >"$out/said" 2>&1 || fail "hover.launch.py: $(cat "$out/said")"
grep -q 'x real time' "$out/said" && [[ -s $out/launched/summary.json ]] || fail "hover.launch.py: $(cat "$out/said")"
