#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A snapshot of a run's world is a piece of a scenario: a run with it begins in that state, to 1e-15 of each number,
# and bodies move on as they did. Programs cannot be taken back, which is said in one sentence.
# Topics: scenario files, physics, models.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
run() { "$build/bin/in_own_network" "$tcsim" run "$@" --accounting fixed >"$out/said" 2>&1 || fail "$(cat "$out/said")"; }
refused() {  # what is to be said, arguments
  local said=$1
  shift
  if "$tcsim" "$@" >"$out/said" 2>&1; then fail "tcsim $* went well"; fi
  grep -q -- "$said" "$out/said" && [[ $(wc -l <"$out/said") == 1 ]] || fail "$(cat "$out/said")"
}
compare() { python3 - "$@" <<'PY' || fail "$* is another state"
import csv, math, sys
first, from_s, second, length_s, most = sys.argv[1], *map(float, (sys.argv[2],)), sys.argv[3], *map(float, sys.argv[4:6])
def read(folder, table, key):
    try:
        rows = list(csv.DictReader(open(f"{folder}/{table}.csv")))
    except FileNotFoundError:
        return {}
    return {(round(float(r["time_s"]) * 1e9), r[key]): [float(v) for k, v in r.items() if k not in ("time_s", key, "effort")]
            for r in rows}
worst, compared = 0, 0
for table, key in ("bodies", "body"), ("joints", "joint"):
    before, after = (read(folder, table, key) for folder in (first, second))
    for (at, name), state in after.items():
        if at > length_s * 1e9:
            continue
        there = before[at + round(from_s * 1e9), name]
        compared += 1
        worst = max(worst, *(abs(a - b) / max(1, abs(b)) for a, b in zip(state, there)))
print(f"{compared} states, of which none differs by more than {worst:.2g}")
sys.exit(0 if compared and worst <= most else 1)
PY
}

# The example: what stopped is where it would have been, and a run goes on from there.
example=$build/examples/predator_prey/scenario.yaml
run "$example" --duration 1.5s --out "$out/whole"
run "$example" --stop-at 1.2s --out "$out/stopped"
cmp -n "$(stat -c %s "$out/stopped/bodies.csv")" "$out/whole/bodies.csv" "$out/stopped/bodies.csv" ||
  fail "a run that is to stop moves otherwise; what its threads did first: $(
    for table in activations dispatches; do diff "$out/whole/$table.csv" "$out/stopped/$table.csv" | head -n 12 || true; done)"
[[ $(tail -n 1 "$out/stopped/bodies.csv") == 1.200000000,* && ! -e $out/whole/snapshot.yaml ]] || fail "it stopped elsewhere"
run "$example" --overlay "$out/stopped/snapshot.yaml" --duration 0.1s --out "$out/goes_on"
compare "$out/stopped" 1.2 "$out/goes_on" 0 1e-15
"$tcsim" snapshot "$out/whole@1.2s" --out "$out/same.yaml" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
cmp "$out/same.yaml" "$out/stopped/snapshot.yaml" || fail "the same moment of another run is another one"

# Robots with joints, and bodies of one shape: at any moment that is in the tables, on both engines.
cp -r "$source_root/tests/models" "$out/models"
cat >"$out/s.yaml" <<'YAML'
duration: 1s
dynamics: {gravity: [0, 0, -9.81], accuracy: 1e-9}
models:
  pendulum: {urdf: models/pendulum.urdf, fixed_base: true, at: {position: [5, 0, 2]}, joints: {hinge: [0.1, -2.5]}}
  rover: {urdf: models/rover.urdf, at: {position: [0, 0, 3]}, linear_velocity: [1, 2, 3], angular_velocity: [0.1, 0.2, 0.3]}
  ball: {sphere: 0.1, mass: 2, position: [9, 0, 3], linear_velocity: [0, 0, 4], angular_velocity: [3, 2, 1]}
  floor: {plane: [0, 0, 1]}
robots: {r: {clients: {c: {command: [sleep, "10"]}}}}
YAML
mujoco=(--set dynamics.engine=mujoco --set dynamics.accuracy=null)
engines=(simbody)
"$tcsim" run "$out/s.yaml" --check "${mujoco[@]}" >/dev/null 2>&1 && engines+=(mujoco)
for engine in "${engines[@]}"; do
  set_engine=()
  [[ $engine == simbody ]] || set_engine=("${mujoco[@]}")
  run "$out/s.yaml" "${set_engine[@]}" --out "$out/$engine"
  "$tcsim" snapshot "$out/$engine@0.25s" >"$out/world.yaml" || fail "there is no snapshot of $engine"
  run "$out/s.yaml" "${set_engine[@]}" --overlay "$out/world.yaml" --duration 0.4s --out "$out/$engine-on"
  compare "$out/$engine" 0.25 "$out/$engine-on" 0 1e-15
  # By other steps, which makes a little difference.
  compare "$out/$engine" 0.25 "$out/$engine-on" 0.4 1e-7
done
# What a joint's velocity is at the start is what the scenario says.
awk -F, '$2 == "pendulum/hinge" && $3 == 0.1 && $4 == -2.5 { found = 1; exit } END { exit !found }' "$out/simbody/joints.csv" ||
  fail "$(head -n 4 "$out/simbody/joints.csv")"

refused "programs cannot go back" run --from "$out/whole@1.2s"
refused "programs cannot go back" run "$example" --from "$out/whole@1.2s"
refused "has no line of 1.205s: next to it are 1.2s and 1.21s" snapshot "$out/whole@1.205s"
refused "has no line of 5s: next to it are 1.5s" snapshot "$out/whole@5s"
refused "give the folder of a run that had a world" snapshot "$out/nowhere@1s"
refused "is after the end, 20s" run "$example" --stop-at 21s
refused "at 1.2s and at 1.21s, but not at 1.205s" run "$example" --stop-at 1.205s
refused "is not positive" run "$example" --stop-at 0s
