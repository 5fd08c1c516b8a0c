#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# What `tcsim fit` finds in a measured run of the example makes fixed runs charge the same: each
# client within 5 %, its planner does as much in as many plans, within 10 %. And they repeat to the byte.
# Topics: accounting, examples, determinism.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
example=$build/examples/predator_prey/scenario.yaml
# What the example expects is of whole flights: on a slow host the programs' start is too much of this one.
"$tcsim" run "$example" --duration 2.8s --set expect=null --for-fit --out "$out/measured" >"$out/measured.said"
"$tcsim" fit "$out/measured" --out "$out/costs.yaml" >"$out/fit.said" 2>"$out/fit.warnings"
for run in first second; do
  "$tcsim" run "$example" --duration 2.8s --set expect=null --accounting fixed --overlay "$out/costs.yaml" --for-fit \
    --out "$out/$run" >"$out/$run.said"
done
for file in bodies.csv trace.json activations.csv dispatches.csv; do
  cmp "$out/first/$file" "$out/second/$file" || fail "$file differs"
done
python3 - "$out/measured" "$out/first" <<'PY' || fail "$(cat "$out/fit.said" "$out"/*/summary.json)"
import csv, json, sys
measured, fixed = sys.argv[1:]
clients = lambda run: json.load(open(run + "/summary.json"))["clients"]
plans = lambda run: sum(row["client"] == "predator/planner" and row["thread"] == "0" and int(row["charged_ns"]) > 500_000_000
                        for row in csv.DictReader(open(run + "/activations.csv")))
then, now = clients(measured), clients(fixed)
assert len(then) == 3, then
for name in then:
    assert then[name]["charged_ns"] > 10_000_000, name
    ratio = now[name]["charged_ns"] / then[name]["charged_ns"]
    print(name, "is charged", ratio, "of what was measured")
    assert abs(ratio - 1) < 0.05, name
planner = "predator/planner"
for key in "activations", "allocations":
    ratio = now[planner][key] / then[planner][key]
    print("planner's", key, ratio)
    assert abs(ratio - 1) < 0.1, key
# One plan takes a second and begins when the last one has ended; a third one is under way at the end.
print("plans", plans(measured), plans(fixed))
assert 2 == plans(measured) == plans(fixed)
PY
grep -q '^predator/planner  *[0-9.]* [un]s  *[0-9.]* [un]s  *[0-9.]* s | [0-9.]* s ' "$out/fit.said" ||
  fail "the table lacks the planner: $(cat "$out/fit.said")"

# Without --out the costs are printed.
said=$("$tcsim" fit "$out/measured" 2>/dev/null)
[[ $said == *"$(cat "$out/costs.yaml")" ]] || fail "the costs are not printed: $said"

# Whoever does not ask for it pays nothing, and has no counts; and is told so.
"$tcsim" run "$build/examples/quadrotor/scenario.yaml" --duration 100ms --set expect=null --out "$out/plain" >"$out/plain.said"
head -1 "$out/plain/activations.csv" | grep -q allocations && fail "an ordinary run has counts"
sentence() {
  local wanted=$1 said status=0
  shift
  said=$("$@" 2>&1 >/dev/null) || status=$?
  [[ $status == 2 && $(wc -l <<<"$said") == 1 && $said == *"$wanted"* ]] || fail "$*: $status, $said"
}
sentence "make the run again with --for-fit" "$tcsim" fit "$out/plain"
sentence "charges were set, not measured" "$tcsim" fit "$out/first"
sentence "has no summary.json" "$tcsim" fit "$out"
sentence "is not a file" "$tcsim" fit "$out/measured" --out "$out"
sed -i 's/ planner:/ planer:/' "$out/costs.yaml"
sentence "costs.yaml:7: there is no 'planer' in robots.predator.clients" \
  "$tcsim" run "$example" --overlay "$out/costs.yaml" --check
