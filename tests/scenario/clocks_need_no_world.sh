#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A scenario without physics gives the virtual time as a topic all the same, for nodes that use it (use_sim_time).
# Topics: dds, ros, scenario files.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/scenario.yaml" <<END
duration: 2s
clock: {rate: 50}
robots:
  robot: {clients: {listener: {command: [$build/bin/clock_listener]}}}
END
"$tcsim" check "$out/scenario.yaml" >"$out/said" || fail "$(cat "$out/said")"
"$tcsim" run "$out/scenario.yaml" --accounting fixed --out "$out/results" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
# It joins within the first tenth of a second, and hears fifty a second until the end, each of its own time.
python3 - "$out/results/robot-listener.out.log" <<'PY' || fail "$(cat "$out/results/robot-listener.out.log")"
import sys
heard = [tuple(map(int, line.split())) for line in open(sys.argv[1])]
assert 94 <= len(heard) <= 100, len(heard)
for stamp_ns, now_ns in heard: assert 0 <= now_ns - stamp_ns < 1_000_000, (stamp_ns, now_ns)
for (before, _), (after, _) in zip(heard, heard[1:]): assert after - before == 20_000_000, (before, after)
PY
