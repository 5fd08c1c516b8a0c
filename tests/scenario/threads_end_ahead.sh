#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Threads that compute ahead, on a second processor of the host, and end there, each while others compute on: their
# program joins them, and takes as long as on one processor.
# Topics: threads, host processors, cores.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/scenario.yaml" <<END
duration: 10s  # what the planner computes takes a slow host three
robots:
  robot:
    cpu: {cores: 4}
    clients:
      planner: {command: [$build/bin/ending_threads, "20"]}
      controller: {command: [$build/bin/soak_client, periodic, "3"], priority: 80}
END
run_on_one_and_two "$out/scenario.yaml" "$out" ahead_ns
python3 - "$out" <<'PY' || fail "$(cat "$out/said")"
import json, sys
one, two = (json.load(open(f"{sys.argv[1]}/{cpus}/summary.json")) for cpus in (1, 2))
assert one["ahead_ns"] == 0 < two["ahead_ns"], (one["ahead_ns"], two["ahead_ns"])
for run in (one, two):
    planner = run["clients"]["robot/planner"]
    assert planner["wait_status"] == 0 and planner["ended_at_ns"] > 0, planner
    # The longest of each round computes 0.4 of what all do, and the round takes that long.
    took, longest = planner["ended_at_ns"], 0.4 * planner["charged_ns"]
    assert 0.9 * longest <= took <= 1.2 * longest, (took, longest)
PY
