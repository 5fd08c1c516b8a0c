#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Joints that are stiffer than any step run on both engines, and what no step can follow, or an engine
# refuses, ends in one sentence that names the joint: never in an abort. A signal ends a run whose
# physics are on a long way.
# Topics: physics, models, failures, signals.
out=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$out"' EXIT

robot() {  # DYNAMICS: the attributes of a wrist of 1e-4 kg m^2 that turns with 1 rad/s on an arm that falls
  cat <<URDF
<robot name="two">
  <link name="base"/>
  <link name="arm"><inertial><origin xyz="0.1 0 0"/><mass value="1"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
  <link name="hand"><inertial><origin xyz="0.01 0.01 0"/><mass value="0.17"/>
    <inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="2e-4"/></inertial></link>
  <joint name="shoulder" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
    <limit effort="10" velocity="10"/></joint>
  <joint name="wrist" type="continuous"><parent link="arm"/><child link="hand"/><origin xyz="0.2 0 0"/>
    <axis xyz="1 0 0"/><limit effort="10" velocity="10"/><dynamics $1/></joint>
</robot>
URDF
}
cat >"$out/s.yaml" <<'YAML'
duration: 1s
dynamics: {gravity: [0, 0, -9.81], engine: simbody}
models: {robot: {urdf: two.urdf, fixed_base: true, joints: {wrist: [0, 1]}}}
robots: {computer: {clients: {idle: {command: [sleep, "100000000"]}}}}
YAML
robot 'damping="1"' >"$out/two.urdf"
engines=(simbody)
"$tcsim" check "$out/s.yaml" --set dynamics.engine=mujoco >"$out/said" 2>&1 && engines+=(mujoco)
run() {  # ENGINE SETTINGS...
  local engine=$1 set status=0
  shift
  local settings=(--set "dynamics.engine=$engine")
  for set in "$@"; do settings+=(--set "$set"); done
  "$tcsim" run "$out/s.yaml" --accounting fixed --out "$out/run" "${settings[@]}" >"$out/all" 2>&1 || status=$?
  without_waits <"$out/all" >"$out/said"
  return "$status"
}

for engine in "${engines[@]}"; do
  for dynamics in 'damping="10"' 'friction="10"' 'damping="2" friction="1"'; do
    robot "$dynamics" >"$out/two.urdf"
    run "$engine" || fail "$dynamics on $engine: $(cat "$out/said")"
  done

  # No step can follow a wrist that turns so fast that its arm trembles.
  robot 'damping="0" friction="0"' >"$out/two.urdf"
  status=0
  run "$engine" 'models.robot.joints={wrist: [0, 1e8]}' || status=$?
  ((status == 2)) || fail "diverging on $engine ended with status $status: $(cat "$out/said")"
  [[ $(grep -c . "$out/said") == 1 ]] || fail "diverging is not one sentence: $(cat "$out/said")"
  grep -q "^tcsim: model 'robot': .*; joint '[a-z]*' is too fast, too stiff or too light" "$out/said" ||
    fail "diverging on $engine names no joint: $(cat "$out/said")"
done

# The physics alone go on for a million seconds.
"$tcsim" run "$out/s.yaml" --accounting fixed --duration 1000000s --out "$out/long" >"$out/said" 2>&1 &
for _ in $(seq 1000); do [[ -s $out/long/bodies.csv ]] && break; sleep 0.02; done
kill -INT $!
status=0
wait $! || status=$?
((status == 130)) || fail "SIGINT did not end the run: $status: $(cat "$out/said")"
echo passed
