#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A tracer that stops the coordinator at each of its system calls lets programs run where they never would: between
# their gate and the moment at which their clock is set. Nobody is expelled for that, nor charged more than its CPU clock
# has counted; less, where a busy host lets the tracer wait, and the program compute meanwhile, out of turn. Threads that
# are new then (a planner's clock thread, with each plan) are the hard ones.
# The run keeps a pace, or on a busy host it would be over before the tracer is there, which has to be on time itself.
# Topics: debuggers, accounting, threads.
type strace >/dev/null 2>&1 || exit 77
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
for cpus in 1 auto; do
  "$tcsim" run "$build/examples/predator_prey/scenario.yaml" --duration 1500ms --pace 0.4 --host-cpus "$cpus" --out "$out/run" \
    >"$out/said" 2>&1 &
  run=$!
  # It may have to wait for a processor first.
  for _ in $(seq 3000); do
    coordinator=$(coordinator_of $run 2>/dev/null) && [[ -e $out/run/predator-planner.out.log ]] && break
    sleep 0.02
  done
  (on_time timeout 200 strace -o "$out/calls" -p "$coordinator" >"$out/strace" 2>&1) || true
  status=0
  wait $run || status=$?
  ! grep -q 'not permitted' "$out/strace" || { echo "nobody may be traced here"; exit 77; }
  ((status == 0)) || fail "with $cpus: $(cat "$out/said")"
  (($(wc -l <"$out/calls") > 2000)) || fail "the coordinator was not traced: $(cat "$out/strace")"
  python3 - "$out/run/summary.json" <<'PY' || fail "with $cpus: $(cat "$out/said")"
import json, sys
s = json.load(open(sys.argv[1]))
assert not s["warnings"], s["warnings"]
assert s["staleness_ns"] == 0 and s["drift_ns"] <= 1_000_000, s
for name, c in s["clients"].items():
    assert 0.1 * c["host_cpu_ns"] < c["charged_ns"] - c["priced_ns"] <= 1.02 * c["host_cpu_ns"] + 200_000, (name, c)
assert s["clients"]["predator/planner"]["charged_ns"] > 150_000_000, s
PY
done
