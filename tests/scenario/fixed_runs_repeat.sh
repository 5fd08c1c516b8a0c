#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Two deterministic runs of the example write the same bytes: body states, commands, what programs
# said and when, schedule trace, activations and dispatches.
# Topics: determinism, examples.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
for run in first second; do
  "$tcsim" run "$build/examples/predator_prey/scenario.yaml" --accounting fixed --duration 3s \
    --out "$out/$run" >"$out/$run.said"
done
(($(wc -l <"$out/first/bodies.csv") > 600)) || fail "the body states are missing"
grep -q '"ph":"X"' "$out/first/trace.json" || fail "the trace is empty"
for file in bodies.csv commands.csv output.csv messages.csv scene.json trace.json activations.csv dispatches.csv; do
  cmp "$out/first/$file" "$out/second/$file" || fail "$file differs"
done
(($(wc -l <"$out/first/activations.csv") > 600)) || fail "the activations are missing"
grep -q '^predator/planner,' "$out/first/dispatches.csv" || fail "the dispatches are missing"
# The bytes agree because nothing was measured, not because nothing happened.
python3 - "$out/first/summary.json" <<'PY' || fail "$(cat "$out/first.said")"
import json, sys
planner = json.load(open(sys.argv[1]))["clients"]["predator/planner"]
assert planner["activations"] >= 2 and planner["charged_ns"] > 2_000_000_000, planner
PY
