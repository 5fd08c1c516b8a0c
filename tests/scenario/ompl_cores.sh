#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Stock OMPL with threads, as it is, on one core and on four. Four planners compute on four cores at once, and on one
# core in turn; where calls have set costs, four cores explore about four times as much in the same virtual time.
# Topics: ompl, cores, threads.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
plan() { "$tcsim" exec --cores "$1" "${@:3}" -- "$build/bin/ompl_planners" "$2" 0.1; }
checks() { plan "$1" parallel --accounting fixed | awk '{for (i = 2; i <= NF; ++i) if ($i == "checks,") print $(i - 1)}'; }
one=$(checks 1)
four=$(checks 4)
((one > 10000 && four > 3 * one && four < 6 * one)) || fail "four planners make $four checks on four cores, and $one on one"
cat >"$out/parallel.yaml" <<YAML
duration: 60s
robots: {r: {clients: {c: {command: ["$build/bin/ompl_planners", parallel, "0.1"]}}}}
YAML
for cores in 1 4; do
  "$tcsim" run "$out/parallel.yaml" --set robots.r.cpu.cores=$cores --out "$out/$cores" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
done
python3 - "$out" <<'PY' || fail "four planners do not compute on as many cores as there are"
import csv, sys
def busy(cores):
    """How long so many of them compute at once, in s of virtual time."""
    changes = []
    for row in csv.DictReader(open(f"{sys.argv[1]}/{cores}/dispatches.csv")):
        changes += [(int(row["virtual_start_ns"]), 1), (int(row["virtual_end_ns"]), -1)]
    at, count, length = 0, 0, [0] * 6
    for then, change in sorted(changes):
        length[count] += (then - at) / 1e9
        at, count = then, count + change
    return length
one, four = busy(1), busy(4)
assert one[1] > 0.1 and sum(one[2:]) == 0, one
assert 0.09 < four[4] < 0.15 and four[5] == 0, four
PY
for cores in 1 4; do
  for which in rrtstar prmstar cforest anytime sst; do
    said=$(plan "$cores" "$which") || fail "$which on $cores cores: $said"
    # The clock is read inline, or by a thread every 3 ms. What another core's thread writes is seen
    # up to the drift bound of 1 ms early. What a planner does once time is up is the host's.
    awk '{for (i = 1; i < NF; ++i) if ($i == "took") exit !($(i + 1) > 0.099 && $(i + 1) < 0.3)}' \
      <<<"$said" || fail "$which on $cores cores does not take 0.1 s: $said"
  done
  said=$(plan "$cores" benchmark) || fail "benchmark on $cores cores: $said"
  [[ $(grep -c '^geometric_.*: 0\.[12][0-9]* s, [1-9]' <<<"$said") == 4 ]] ||
    fail "benchmark on $cores cores: $said"
done
