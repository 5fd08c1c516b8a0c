#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A scenario that asks for contact forces gets contacts.csv: what lies on the floor is held up by its weight,
# what falls touches nothing. A run that does not ask for them writes the same bytes otherwise.
# Topics: contacts, physics.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
for engine in simbody mujoco; do
  cat >"$out/$engine.yaml" <<YAML
duration: 2s
dynamics: {engine: $engine, gravity: [0, 0, -9.81]}
models:
  floor: {plane: [0, 0, 1]}
  crate: {box: [0.2, 0.2, 0.2], mass: 3, position: [1, 0, 0.1]}
  stone: {sphere: 0.1, mass: 1, position: [0, 0, 25]}
  dog: {urdf: $source_root/tests/models/quadruped.urdf, at: {position: [0, 3, 0.5]}, joints: {lf_knee: -1.4, rf_knee: -1.4, lh_knee: -1.4, rh_knee: -1.4}}
robots:
  r: {clients: {c: {command: [python3, -c, "import time\nfor i in range(40): time.sleep(0.05)"]}}}
YAML
  "$tcsim" run "$out/$engine.yaml" --accounting fixed --out "$out/$engine" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  [[ ! -e $out/$engine/contacts.csv ]] || fail "nobody asked for contacts"
  "$tcsim" run "$out/$engine.yaml" --accounting fixed --set csv_contacts=true --out "$out/$engine-with" >"$out/said" 2>&1 ||
    fail "$(cat "$out/said")"
  for file in bodies.csv joints.csv scene.json trace.json activations.csv dispatches.csv output.csv; do
    cmp "$out/$engine/$file" "$out/$engine-with/$file" || fail "$engine: $file differs where contacts are read"
  done
  "$tcsim" run "$out/$engine.yaml" --accounting fixed --set csv_contacts=true --host-cpus auto --out "$out/$engine-again" >"$out/said" 2>&1 ||
    fail "$(cat "$out/said")"
  cmp "$out/$engine-with/contacts.csv" "$out/$engine-again/contacts.csv" || fail "$engine: contacts do not repeat"
  python3 - "$out/$engine-with/contacts.csv" <<'PY' || fail "$engine: contacts are not what they should be"
import csv, sys
rows = list(csv.DictReader(open(sys.argv[1])))
by_time = {}
for row in rows:
    by_time.setdefault(row["time_s"], []).append(row)
assert all(row["second"] == "floor" for row in rows), {row["second"] for row in rows}
assert not any(row["first"] == "stone" for row in rows), "it falls"
held = [sum(float(r["force_z_n"]) for r in at if r["first"] == "crate") for time, at in by_time.items() if float(time) > 0.5]
assert len(held) == 150 and all(abs(n - 3 * 9.81) < 0.01 * 3 * 9.81 for n in held), (len(held), min(held), max(held))
limp = {time: at for time, at in by_time.items() if any(r["first"].startswith("dog/") for r in at)}
first = min(map(float, limp))
assert 0.05 < first < 1, first
assert "0.000000000" not in by_time
print(f"the crate is held by {min(held):.3f} to {max(held):.3f} N; the dog lands after {first} s")
PY
done
# A run without them, in the same folder, leaves none behind.
"$tcsim" run "$out/simbody.yaml" --accounting fixed --duration 100ms --out "$out/simbody-with" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
[[ ! -e $out/simbody-with/contacts.csv ]] || fail "the contacts of the run before are left"
"$tcsim" run "$out/simbody.yaml" --accounting fixed --set dynamics.engine=ode --set csv_contacts=true >"$out/said" 2>&1 &&
  fail "ODE takes models"
grep -q "ode" "$out/said" || fail "$(cat "$out/said")"
