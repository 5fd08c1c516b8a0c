#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The page of a run whose controller is late, in a browser: the verdict first, each miss marked and explained as `tcsim
# explain` does, the simulation's own figures last; keys alone reach everything in about 30 stops, however much programs
# said; signals can be chosen and curves zoomed. `tcsim trace` marks the same misses.
# Topics: report, verdict.
for command in chromium chromedriver; do
  command -v "$command" >/dev/null || fail "$command is not installed (cmake/packages.txt)"
done
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cd "$out"
"$tcsim" new hover >/dev/null
cd hover
# A planner of higher priority keeps the controller from its core; another program says a line every 2 ms.
sed -i 's/^        body: drone$/&\n      planner: {command: [python3, planner.py], priority: 90, start: 0.5s}\n      talker: {command: [python3, -u, talker.py]}/' scenario.yaml
cat >planner.py <<'PY'
import time
while True:
    until = time.thread_time() + 0.04
    while time.thread_time() < until: pass
    time.sleep(0.06)
PY
cat >talker.py <<'PY'
import time
for i in range(800):
    print("line", i)
    time.sleep(0.002)
PY
"$tcsim" run --duration 2s --accounting fixed --out "$out/late" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
"$tcsim" report "$out/late" --out "$out/late.html" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
"$tcsim" explain "$out/late" hover/controller --worst 9999 --json >"$out/explained.json" || fail "explain"
"$tcsim" trace "$out/late" >"$out/said" || fail "$(cat "$out/said")"
cd "$source_root/tests/scenario"
timeout 500 python3 -B late_runs_have_pages.py "$out" || fail "the page is not as it should be"
