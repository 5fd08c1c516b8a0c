#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The same binaries in a world that stands still while they compute: a planner of one second, asked
# again every 0.1 s, runs ten times as far as the world, and the more the longer the run. Set costs
# make it quick.
# Topics: scheduling, activations, examples.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
for ms in 200 400; do
  "$tcsim" run "$build/examples/predator_prey/scenario.yaml" --sync callback --accounting fixed \
    --duration "${ms}ms" --out "$out/$ms" >"$out/$ms.said"
done
python3 - "$out" <<'PY' || fail "$(cat "$out"/*.said)"
import json, sys
short, long = (json.load(open(f"{sys.argv[1]}/{ms}/summary.json")) for ms in (200, 400))
assert (short["virtual_ns"], long["virtual_ns"]) == (200_000_000, 400_000_000)
for run in (short, long):
    ratio = run["drift_ns"] / run["virtual_ns"]
    assert 8 < ratio < 13, ratio
    # What it reads is as old as its own clock is ahead, but for what it computes before it reads.
    assert run["staleness_ns"] > 0.7 * run["drift_ns"], "what the planner reads is as old"
PY
