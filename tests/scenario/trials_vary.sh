#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$(dirname -- "${BASH_SOURCE[0]}")/trials_world.sh"
# All seeds for each value of a key; a value that comes later gets its trials without those before it.
# Topics: trials, scenario files.
trials() {
  "$tcsim" trials "$out/scenario.yaml" --accounting fixed --trials 2 --out "$out/t" \
    --set csv_period=20ms "$@" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
}
trials --vary duration=500ms,1s
grep -Eq '^duration=500ms +2 of 2' "$out/said" || fail "$(cat "$out/said")"
grep -Eq '^duration=1s +2 of 2' "$out/said" || fail "$(cat "$out/said")"
trials --vary duration=500ms,1s,1500ms
grep -q '4 of 6 trials are done already' "$out/said" || fail "$(cat "$out/said")"
python3 - "$out/t" <<'PY' || fail "$(cat "$out/t/trials.json")"
import json, sys
trials = json.load(open(sys.argv[1] + "/trials.json"))
assert trials["vary"] == {"key": "duration", "values": ["500ms", "1s", "1500ms"]}
assert trials["options"]["set"] == ["csv_period=20ms"]
for value, ms in (("500ms", 500), ("1s", 1000), ("1500ms", 1500)):
    for seed in (1, 2):
        folder = f"{sys.argv[1]}/{value}/seed-000{seed}"
        summary = json.load(open(folder + "/summary.json"))
        assert (summary["seed"], summary["virtual_ns"]) == (seed, ms * 1_000_000), summary
        assert len(open(folder + "/bodies.csv").readlines()) == 1 + ms // 20 + 1
PY
