#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A gripper whose fingers a program commands both: one follows the other, the pair has the range that both allow, and what is said
# of the follower is left out with one warning. A sled slides on two casters without friction and on one that has that of
# its file, and stops where the closed form says. On both engines.
# Topics: models, commands, contacts, physics.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cd "$out" || exit 1
python3 - <<'PY'
inertial = '<inertial><origin xyz="0 0 {z}"/><mass value="{m}"/><inertia ixx="{i}" ixy="0" ixz="0" iyy="{i}" iyz="0" izz="{i}"/></inertial>'
finger = '<link name="{n}">' + inertial.format(z=0, m=0.1, i=1e-4) + '</link>'
slide = '''<joint name="{n}_joint" type="prismatic"><parent link="palm"/><child link="{n}"/><axis xyz="0 {y} 0"/>
<limit lower="0" upper="{u}" effort="20" velocity="1"/>{rest}</joint>'''
open("gripper.urdf", "w").write('<robot name="gripper"><link name="palm"/>' + finger.format(n="left") + finger.format(n="right")
    + slide.format(n="left", y=1, u=0.04, rest="") + slide.format(n="right", y=-1, u=0.03, rest='<mimic joint="left_joint"/>') + "</robot>")
foot = '''<link name="{n}"><collision><geometry><sphere radius="0.02"/></geometry></collision></link>
<joint name="{n}_joint" type="fixed"><parent link="sled"/><child link="{n}"/><origin xyz="{x} {y} 0.02"/></joint>
<gazebo reference="{n}"><mu1>{mu}</mu1><mu2>{mu}</mu2></gazebo>'''
open("sled.urdf", "w").write('<robot name="sled"><link name="sled">' + inertial.format(z=0.1, m=1, i=0.01) + "</link>"
    + foot.format(n="left", x=0.1, y=0.1, mu=0) + foot.format(n="right", x=0.1, y=-0.1, mu=0) + foot.format(n="back", x=-0.1, y=0, mu=0.3) + "</robot>")
open("close.py", "w").write('''
import socket, time
s = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
for _ in range(40):
    s.sendto(b'{"left_joint": 0.05, "right_joint": 0.05}', "hand.sock")
    time.sleep(0.02)
''')
PY
engines=(simbody)
for engine in simbody mujoco; do
  cat >"$engine.yaml" <<YAML
duration: 1s
dynamics: {gravity: [0, 0, -9.81], engine: $engine}
models:
  gripper: {urdf: gripper.urdf, fixed_base: true, at: {position: [0, 2, 1]}}
  sled: {urdf: sled.urdf, linear_velocity: [1, 0, 0]}
  floor: {plane: [0, 0, 1]}
channels:
  hand: {type: unix_json, commands: {model: gripper, drive: position, stiffness: 200, damping: 10, listen: hand.sock}}
robots:
  r: {clients: {c: {command: [python3, "\${scenario_dir}/close.py"]}}}
YAML
done
"$tcsim" check mujoco.yaml >/dev/null 2>&1 && engines+=(mujoco)
for engine in "${engines[@]}"; do
  "$tcsim" run "$engine.yaml" --accounting fixed --out "$engine" >said 2>&1 || fail "$engine: $(cat said)"
  (($(grep -c "commands name joint 'right_joint', which follows another one" said) == 1)) || fail "the follower is not said once: $(cat said)"
  grep -q "joint 'right_joint' follows joint 'left_joint' with limits 0 and 0.03, so its leader may go from 0 to 0.03 only" said ||
    fail "the range of the pair is not said: $(cat said)"
  python3 - "$engine/bodies.csv" <<'PY' || fail "on $engine the gripper or the sled is elsewhere"
import csv, sys
last = {row["body"]: row for row in csv.DictReader(open(sys.argv[1]))}
left, right = float(last["gripper/left"]["y_m"]) - 2, float(last["gripper/right"]["y_m"]) - 2
# The load on the caster behind: m g / (2 + mu h / l), with the centre of mass h = l above the floor.
slid = 1 / (2 * 0.3 * 9.81 / 2.3)
sled = float(last["sled/sled"]["x_m"])
print(f"fingers at {left} and {right} m; the sled at {sled} m, closed form {slid} m")
assert abs(left - 0.03) < 2e-4 and abs(right + 0.03) < 2e-4
assert abs(sled / slid - 1) < 0.01
PY
done
