#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A pure spin, without any system call, on one robot; a 100 Hz loop on another. The loop is dispatched
# at every one of its deadlines, to the nanosecond, and the spin gets all of its own processor.
# Topics: scheduling, timers.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/loop.pl" <<'PERL'
use Time::HiRes qw(clock_gettime clock_nanosleep CLOCK_MONOTONIC TIMER_ABSTIME);
my $next = 1_000_000_000_000;  # the run's start on its monotonic clock
while (1) { $next += 10_000_000; clock_nanosleep(CLOCK_MONOTONIC, $next, TIMER_ABSTIME); }
PERL
cat >"$out/scenario.yaml" <<YAML
duration: 2s
robots:
  busy:
    clients: {spin: {command: [perl, -e, "1 while 1"], class: best-effort}}
  punctual:
    clients: {loop: {command: [perl, $out/loop.pl], class: periodic}}
YAML
"$tcsim" run "$out/scenario.yaml" --out "$out" >"$out/said" || fail "$(cat "$out/said")"
python3 - "$out" <<'PY' || fail "$(cat "$out/said")"
import json, sys
from decimal import Decimal
events = json.load(open(sys.argv[1] + "/trace.json"), parse_float=Decimal)["traceEvents"]
rows = {e["args"]["name"]: (e["pid"], e["tid"]) for e in events if e["name"] == "thread_name"}
def slices(row):
    return [(int(e["ts"] * 1000), int(e["dur"] * 1000))
            for e in events if e["ph"] == "X" and (e["pid"], e["tid"]) == rows[row]]
starts = {start for start, _ in slices("punctual/loop")}
# From when Perl has started, which takes a slow host some tens of ms.
late = [k for k in range(20, 200) if k * 10_000_000 not in starts]
assert not late, f"no dispatch exactly at {late[:5]} x 10 ms, but at {sorted(starts)[20:25]}"
spun = sum(length for _, length in slices("busy/spin"))
assert spun > 1_990_000_000, spun
drift = json.load(open(sys.argv[1] + "/summary.json"))["drift_ns"]
assert drift <= 1_000_000, drift
PY
