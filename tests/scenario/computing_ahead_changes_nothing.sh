#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Two robots whose planners compute, a controller of 100 Hz beside each, and a body that moves: what they are charged is
# what they have computed, and the run's invariants hold, with one processor of the host and with two,
# where planners compute ahead.
# Topics: host processors, accounting, scheduling.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
{
  echo "duration: 4s"
  echo "dynamics: {}"
  echo "bodies: {thrown: {mass: 1, inertia: [1, 1, 1], linear_velocity: [1, 0, 0]}}"
  echo "robots:"
  for robot in first second; do
    echo "  $robot:"
    echo "    clients:"
    echo "      planner: {command: [$build/bin/steady_worker, long, \"150\"], priority: 1}"
    echo "      controller: {command: [$build/bin/soak_client, periodic, \"2\"], priority: 80}"
  done
} >"$out/scenario.yaml"
run_on_one_and_two "$out/scenario.yaml" "$out" ahead_ns
python3 - "$out" <<'PY' || fail "$(cat "$out/said")"
import json, sys
one, two = (json.load(open(f"{sys.argv[1]}/{cpus}/summary.json")) for cpus in (1, 2))
assert one["ahead_ns"] == 0 < two["ahead_ns"], (one["ahead_ns"], two["ahead_ns"])
for run in (one, two):
    assert 0 < run["drift_ns"] <= run["drift_bound_ns"], run["drift_ns"]
    assert run["staleness_ns"] == 0, run["staleness_ns"]
    for name, client in run["clients"].items():
        charged, computed = client["charged_ns"] - client["priced_ns"], client["host_cpu_ns"]
        assert abs(charged - computed) <= 0.01 * computed + 200_000, (name, charged, computed)
    for robot in ("first", "second"):
        planner, controller = (run["clients"][f"{robot}/{kind}"] for kind in ("planner", "controller"))
        assert planner["wait_status"] == 0 and planner["ended_at_ns"] > 0, planner
        # It has had its computer all the time, but for what the controller had, and for what a busy host's disk had to read.
        without_ns = planner["ended_at_ns"] - planner["charged_ns"]
        assert 0 <= without_ns <= controller["charged_ns"] + 20_000_000, (robot, without_ns)
        assert controller["wait_status"] == 0 and controller["overruns"] == 0, controller
PY
