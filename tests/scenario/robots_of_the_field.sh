#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# What robots' files of the field have beside the letter of URDF is loaded, said in one sentence, and moves on both engines
# as it should: an arm that swings once round in the time of the closed form, whatever else is in its file.
# Topics: models, physics, failures.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cd "$out" || exit 1
engines=(simbody)
body='<inertial><origin xyz="0 0 -1"/><mass value="1"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>'
ends='<parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>'

# robot NAME 'ATTRIBUTES OF <robot>' 'INERTIAL AND SHAPES OF arm' 'TYPE' 'REST OF ITS JOINT' 'MORE' [KEYS OF THE MODEL]
robot() {
  echo "<robot $2><link name='base'/><link name='arm'>$3</link><joint name='j' type='$4'>$ends$5</joint>$6</robot>" >"$1.urdf"
  for engine in "${engines[@]}"; do
    cat >"$1.$engine.yaml" <<YAML
duration: 1s
dynamics: {gravity: [0, 0, -9.81], engine: $engine}
models:
  r: {urdf: $1.urdf, fixed_base: true, self_collision: true${7:-}}
robots:
  c: {clients: {i: {command: [sleep, "1"]}}}
YAML
  done
}

robot no_mujoco 'name="r"' "$body" continuous '' ''
sed 's/engine: simbody/engine: mujoco/' no_mujoco.simbody.yaml >no_mujoco.yaml
"$tcsim" check no_mujoco.yaml >/dev/null 2>&1 && engines+=(mujoco)

# moves NAME 'SENTENCE' ANGLE: what is said, and the arm's angle about y after 1 s (none: it need only be finite).
moves() {
  for engine in "${engines[@]}"; do
    said=$("$tcsim" run "$1.$engine.yaml" --accounting fixed --out "$1.$engine" 2>&1) || fail "$1 on $engine: $said"
    [[ $said == *"$2"* ]] || fail "$1: another sentence: $said"
    (($(grep -c warning <<<"$said") == $([[ -n $2 ]] && echo 1 || echo 0))) || fail "$1: more is said: $said"
    python3 - "$1.$engine/bodies.csv" "${3:-}" <<'PY' || fail "$1 on $engine moves otherwise"
import csv, math, sys
row = [r for r in csv.DictReader(open(sys.argv[1])) if r["body"] == "r/arm"][-1]
angle = 2 * math.atan2(float(row["qy"]), float(row["qw"]))
angle = math.remainder(angle, 2 * math.pi)
print(f"{sys.argv[1]}: {angle} rad")
assert math.isfinite(angle)
if sys.argv[2]:
    assert abs(angle - float(sys.argv[2])) < 1e-4, angle
PY
  done
  if [[ -n $2 ]]; then
    "$tcsim" check "$1.simbody.yaml" --strict >/dev/null 2>&1 && fail "$1: --strict lets the warning through"
  fi
  return 0
}

# The pendulum of these starts at 1 rad: where it is after 1 s.
start=', joints: {j: 1}'
swings=$(python3 - <<'PY'
w, q, v = 9.81 / 1.01, 1.0, 0.0
import math
h = 1e-5
for _ in range(100000):
    k1 = -w * math.sin(q); q2, v2 = q + h / 2 * v, v + h / 2 * k1
    k2 = -w * math.sin(q2); q3, v3 = q + h / 2 * v2, v + h / 2 * k2
    k3 = -w * math.sin(q3); q4, v4 = q + h * v3, v + h * k3
    k4 = -w * math.sin(q4)
    q += h / 6 * (v + 2 * v2 + 2 * v3 + v4); v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
print(q)
PY
)

robot capsule 'name="r"' "$body<collision><geometry><capsule radius='0.1' length='1'/></geometry></collision>" continuous '' '' "$start"
moves capsule '' "$swings"
robot no_name '' "$body" continuous '' '' "$start"
moves no_name 'this <robot> has no name' "$swings"
robot no_limit 'name="r"' "$body" revolute '' '' "$start"
moves no_limit "joint 'j' has no <limit>" "$swings"
robot no_range 'name="r"' "$body" revolute '<limit effort="10" velocity="10"/>' '' "$start"
moves no_range "joint 'j' has a <limit> without lower and upper" "$swings"
robot no_effort 'name="r"' "$body" revolute '<limit lower="-2" upper="2" velocity="3"/>' '' "$start"
moves no_effort "joint 'j' has a <limit> without effort" "$swings"
robot locked 'name="r"' "$body" revolute '<limit lower="0.5" upper="0.5" effort="1" velocity="1"/>' ''
moves locked "joint 'j' cannot move, because both its limits are 0.5" 0.5
robot beyond 'name="r"' "$body" revolute '<limit lower="1" upper="7" effort="1" velocity="1"/>' ''
moves beyond 'write joints: {j: 1}'
robot lone_link 'name="r"' "$body" continuous '' '<link name="spare"/>' "$start"
moves lone_link "link 'spare' is left out" "$swings"
robot point_contact 'name="r"' "$body<collision><geometry><sphere radius='0'/></geometry></collision>" continuous '' '' "$start"
moves point_contact "the sphere in link 'arm' has a size of 0" "$swings"
robot no_picture 'name="r"' "$body<visual><geometry><mesh filename='package://none/a.dae'/></geometry></visual>" continuous '' '' "$start"
moves no_picture "link 'arm' is drawn without a mesh" "$swings"
# What is fixed to a link only adds to it; a mass of 1e-9 kg adds nothing that is seen here.
tip='<link name="tip"><inertial><mass value="1e-9"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>'
robot fixed_point 'name="r"' "$body" continuous '' "$tip<joint name='f' type='fixed'><parent link='arm'/><child link='tip'/></joint>" "$start"
moves fixed_point '' "$swings"
# A wheel without mass has the least; an arm that is a thousandth heavier at its hinge swings the same.
robot no_mass 'name="r"' "$body" continuous '' "<link name='wheel'/><joint name='w' type='continuous'><parent link='arm'/><child link='wheel'/></joint>" "$start"
moves no_mass "link 'wheel' moves (joint 'w' moves it) but has no mass" "$swings"
robot inertia 'name="r"' '<inertial><mass value="0.024"/><inertia ixx="9e-7" ixy="0" ixz="0" iyy="3e-6" iyz="0" izz="2e-6"/></inertial>' continuous '' ''
moves inertia 'which no body has: the nearest are taken, (9.33e-07, 2.03e-06, 2.97e-06) kg m^2' 0
# Rounded by a draughtsman: MuJoCo refuses it as it is.
robot rounded 'name="r"' '<inertial><mass value="1"/><inertia ixx="0.0068235183" ixy="5.2146031e-05" ixz="0.002882879" iyy="0.0074616169" iyz="-0.00093463897" izz="0.01115064"/></inertial>' continuous '' ''
moves rounded ''
# A clone of a repository of descriptions, in another folder than its package's name: no variable is set.
mkdir -p clone/.git clone/arm/urdf clone/arm/meshes
echo '<package><name>arm_description</name></package>' >clone/arm/package.xml
cp "$source_root/tests/models/zoo_description/meshes/wedge.stl" 'clone/arm/meshes/the wedge.stl'
robot clone/arm/urdf/arm 'name="r"' "$body<collision><geometry><mesh filename='package://arm_description/meshes/the%20wedge.stl'/></geometry></collision>" continuous '' '' "$start"
sed -i 's|urdf: clone/arm/urdf/|urdf: |' clone/arm/urdf/*.yaml
moves clone/arm/urdf/arm '' "$swings"

# All mistakes of a file at once, each with its line.
printf '<robot name="r">\n<link name="a"><inertial><mass value="x"/></inertial></link>\n<link name="b"/>\n<joint name="j" type="hinge"><parent link="a"/><child link="c"/></joint>\n</robot>\n' >wrong.urdf
sed 's/inertia.urdf/wrong.urdf/' inertia.simbody.yaml >wrong.yaml
said=$("$tcsim" check wrong.yaml 2>&1) && fail "mistakes are taken"
for words in "wrong.urdf:2: value of <mass> in link 'a' is 'x'" "wrong.urdf:2: <inertial> in link 'a' has no <inertia>" \
  "wrong.urdf:4: joint 'j' has the child 'c', but there is no such link" "wrong.urdf:4: joint 'j' has the unknown type 'hinge'"; do
  [[ $said == *"$words"* ]] || fail "not said: $words, but: $said"
done
for root in sdf mujoco; do
  echo "<$root/>" >wrong.urdf
  said=$("$tcsim" check wrong.yaml 2>&1) && fail "<$root> is taken"
  [[ $said == *"convert it, as with"* ]] || fail "another sentence: $said"
done
exit 0
