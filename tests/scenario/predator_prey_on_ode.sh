#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The example flies on ODE as on Simbody: the same commands at the same times move its bodies the
# same way, but for what a first-order step of 1 ms adds. Under set costs the computing is the same,
# so that two runs on ODE are identical, too.
# Topics: examples, physics, determinism.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
fly() {
  "$tcsim" run "$build/examples/predator_prey/scenario.yaml" --set "dynamics.engine=$1" \
    --accounting fixed --duration 1500ms --out "$out/$2" >"$out/$2.said" ||
    fail "on $1: $(cat "$out/$2.said")"
}
fly ode first
fly ode second
fly simbody simbody
cmp "$out/first/bodies.csv" "$out/second/bodies.csv" || fail "two runs on ODE differ"
python3 - "$out" <<'PY' || fail "$(cat "$out"/*.said)"
import csv, json, sys
summary = json.load(open(f"{sys.argv[1]}/first/summary.json"))
assert summary["set"] == ["dynamics.engine=ode"], summary["set"]
assert summary["virtual_ns"] == 1_500_000_000 and summary["drift_ns"] <= 1_000_000, summary
assert summary["commands"] > 250 and summary["dynamics_ns"] > 0, summary
rows = {}
for engine in ("first", "simbody"):
    with open(f"{sys.argv[1]}/{engine}/bodies.csv") as file:
        rows[engine] = [row for row in csv.DictReader(file)]
assert len(rows["first"]) == len(rows["simbody"]) == 302, len(rows["first"])
before, after = rows["first"][1], rows["first"][-1]
assert abs(float(after["x_m"]) - float(before["x_m"])) > 0.05, "the prey has not moved"
# Until the first plan ends the waiting for it nothing depends on what was sensed.
for ode, simbody in zip(rows["first"], rows["simbody"]):
    if float(ode["time_s"]) > 1.0: break
    for key in ("x_m", "y_m", "z_m", "vx_mps", "vy_mps", "vz_mps"):
        assert abs(float(ode[key]) - float(simbody[key])) < 2e-3, (ode, simbody)
assert any(a["x_m"] != b["x_m"] for a, b in zip(rows["first"], rows["simbody"])), "one engine flew both"
PY
# Mistakes in what is set name the option.
said=$("$tcsim" run --set dynamics.engine=odd "$build/examples/predator_prey/scenario.yaml" 2>&1) &&
  fail "an unknown engine was accepted"
[[ $said == "tcsim: --set dynamics.engine=odd: dynamics.engine is the unknown 'odd'; did you mean 'ode'?" ]] ||
  fail "$said"
