#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$(dirname -- "${BASH_SOURCE[0]}")/trials_world.sh"
# A trial that fails is named and does not end the others; the next call runs it again, and only it.
# What would mix trials of two kinds in one folder is refused, and changes nothing.
# Topics: trials, failures.
trials() { "$tcsim" trials "$out/scenario.yaml" --accounting fixed --out "$out/t" "$@"; }
status=0; FAILING_SEED=2 trials --trials 3 --name "three pilots" >"$out/said" 2>"$out/errors" ||
  status=$?
((status == 1)) || fail "exit status $status: $(cat "$out/said" "$out/errors")"
grep -q "^tcsim: seed 2 failed: r/pilot ended at .* exit status 1: \"this seed is not for me\" ($out/t/seed-0002/r-pilot.err.log) ($out/t/seed-0002/tcsim.log)" \
  "$out/errors" || fail "$(cat "$out/errors")"
(($(grep -c failed: "$out/errors") == 1)) || fail "$(cat "$out/errors")"
grep -q 'not for me' "$out/t/seed-0002/r-pilot.err.log" || fail "its last words are lost"
grep -Eq '^three pilots +2 of 3' "$out/said" || fail "$(cat "$out/said")"
python3 - "$out" <<'PY' || fail "$(cat "$out/t/trials.json")"
import json, sys
trials = json.load(open(sys.argv[1] + "/t/trials.json"))
assert (trials["name"], trials["first_seed"], trials["trials"]) == ("three pilots", 1, 3)
assert trials["scenario"] == sys.argv[1] + "/scenario.yaml"
assert trials["options"]["accounting"] == "fixed" and trials["vary"] is None
PY

trials --trials 4 >"$out/said" 2>&1 || fail "$(cat "$out/said")"
grep -q '2 of 4 trials are done already' "$out/said" || fail "$(cat "$out/said")"
grep -Eq '^scenario +4 of 4' "$out/said" || fail "$(cat "$out/said")"

refused() {  # PATTERN OPTIONS...
  local pattern=$1 status=0 before
  shift
  before=$(sha1sum "$out"/t/trials.json "$out"/t/*/summary.json)
  trials "$@" >"$out/stdout" 2>"$out/stderr" || status=$?
  ((status == 2)) || fail "exit status $status instead of 2: $* $(cat "$out/stderr")"
  [[ $(wc -l <"$out/stderr") == 1 ]] || fail "not one line: $(cat "$out/stderr")"
  grep -Eq "^tcsim: .*$pattern" "$out/stderr" || fail "$(cat "$out/stderr")"
  [[ $(sha1sum "$out"/t/trials.json "$out"/t/*/summary.json) == "$before" ]] || fail "$* changed it"
}
refused '--sync consistent, not callback.*--out.*--restart' --trials 4 --sync callback
refused 'without --duration 1s.*--restart' --trials 4 --duration 1s
refused 'write it like drift' --trials 4 --vary drift
refused "csv_perriod.*did you mean 'csv_period'" --trials 4 --vary csv_perriod=1ms,2ms
refused '--vary drift and --drift' --trials 4 --vary drift=1ms,2ms --drift 1ms
refused 'is too large for 2 seeds' --trials 2 --first-seed 18446744073709551615
flock --no-fork "$out/t" sleep 200 &
holder=$!
for _ in $(seq 1200); do flock -n "$out/t" true || break; sleep 0.05; done
refused 'another tcsim trials is at work' --trials 4
kill "$holder"
wait "$holder" || true
sed -i 's/mass: 1,/mass: 2,/' "$out/scenario.yaml"
refused 'before it was changed' --trials 4
trials --trials 1 --restart >"$out/said" 2>&1 || fail "$(cat "$out/said")"
[[ -e $out/t/seed-0002 ]] && fail "--restart left a trial"
true
