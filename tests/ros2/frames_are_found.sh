#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A node finds a robot's frames on /tf, once they are told of the time that it asks for, and waits for others as long as it said, in virtual
# time; also with use_sim_time.
build_nodes
[[ -x $nodes/frames ]] || { echo "this ROS 2 has no tf2_ros"; exit 77; }
out=$(mktemp -d)
trap 'wait; rm -rf "$out"' EXIT
unset ROS_DOMAIN_ID
cp "$source_root/examples/ros2/scenarios/rover.urdf" "$out"
cat >"$out/s.yaml" <<YAML
duration: 5s
clock: {rate: 1000}
dynamics: {gravity: [0, 0, -9.81]}
models:
  floor: {plane: [0, 0, 1]}
  rover: {urdf: rover.urdf}
robots:
  rover:
    clients:
      frames: {command: [$nodes/frames]}
      sim_time: {command: [$nodes/frames, --ros-args, -p, "use_sim_time:=true"]}
channels:
  tf: {type: dds, sensors: {kind: transforms, model: rover, world_frame: world, rate: 50}}
  fixed: {type: dds, sensors: {kind: fixed_transforms, model: rover}}
YAML
for accounting in measured fixed; do
  timeout 300 "$tcsim" run "$out/s.yaml" --accounting "$accounting" --out "$out/run" >"$out/said" 2>&1 || fail "$(cat "$out/said" "$out"/run/*.log)"
  for client in frames sim_time; do
    python3 - "$out/run/rover-$client.out.log" <<'PY' || fail "$accounting, $client: $(cat "$out"/run/*.log)"
import re, sys
text = open(sys.argv[1]).read()
told, waited = re.fullmatch(r"left_wheel found after (\S+) ms\nthird_wheel not found after (\S+) ms\n", text).groups()
assert 0 < float(told) <= 45, told  # 20 ms between two, and what nodes and the buffer's polling take
assert 500 <= float(waited) <= 530, waited
PY
  done
done
