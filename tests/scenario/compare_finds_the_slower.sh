#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Two sets of trials with other seeds: a planner that computes a fifth longer is found, with the size and exit status 3; the
# same planner is not. A third argument is how many trials each set has.
# Topics: trials, failures.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cd "$out"
trials=${3:-10}
cat >scenario.yaml <<YAML
duration: 1s
robots:
  r: {clients: {planner: {command: [$build/bin/seeded_planner, "\${seed}", "50", "25"], class: periodic, deadline: 5500us, fixed_call_cost: 100us}}}
YAML
fly() {  # FOLDER FIRST_SEED READS [TRIALS]
  "$tcsim" trials --accounting fixed --jobs 2 --trials "${4:-$trials}" --out "$1" --first-seed "$2" \
    --set "robots.r.clients.planner.command=[$build/bin/seeded_planner, \"\${seed}\", \"$3\", \"25\"]" >"said-$1" 2>&1 || fail "$(cat "said-$1")"
}
fly before 1 50
fly same 101 50
fly slower 201 60
compared() {  # STATUS ARGUMENTS
  local status=0
  "$tcsim" compare "${@:2}" >said 2>&1 || status=$?
  ((status == $1)) || fail "compare ${*:2} exits with $status, not $1: $(cat said)"
}
says() { grep -q -- "$1" said || fail "nobody said '$1': $(cat said)"; }

compared 0 before same
says '^nothing became worse in B'
compared 3 before slower
says '^! worse: r/planner.missed is [5-8][0-9].*%, was [1-4][0-9].*%: +[0-9.]* % (+.* to +.*); chance makes that less than once in'
says '^worse *r/planner.response_p50 .* +[12][0-9.]* % '
compared 0 slower before
says '^better *r/planner.response_p50 '
compared 0 before slower --tolerance 30% --measure planner.execution_p50
says '1 within 30 %'
compared 3 --json before slower
python3 - said <<'PY' || fail "the comparison for programs: $(cat said)"
import json, sys
compared = json.load(open(sys.argv[1]))
[slower] = [f for f in compared["figures"] if f["figure"] == "r/planner.response_p50"]
assert compared["worse"] and slower["outcome"] == "worse" and slower["evidence"] == "trials", slower
assert 0.1 < slower["relative"] < 0.3 and 0 < slower["low"] <= slower["difference"] <= slower["high"], slower
assert slower["chance"] < 0.01, slower
PY

# With set costs runs of one seed repeat: any difference is real. Of other seeds nobody knows.
fly paired 1 60 1
compared 3 before/seed-0001 paired/seed-0001
says 'with set costs runs repeat, so the difference is real for these seeds'
compared 0 before/seed-0001 before/seed-0001
says '^nothing became worse in B'
compared 0 before/seed-0001 slower/seed-0201
says 'warning: before/seed-0001 has the seed 1, and slower/seed-0201 has 201'
says '^nothing is known to have become worse in B, but [0-9]* figures differ beyond the tolerance'

# What cannot be compared.
compared 2 before before/seed-0001
says 'before/seed-0001 is one run, and before are trials'
compared 2 before nowhere
says "there is no folder 'nowhere'"
compared 2 before .
says 'is no result folder'
for share in much 5; do
  compared 2 before same --tolerance $share
  says "'$share' is no share; write it like 5% or 0.05"
done
compared 2 before same --measure planner.mised
says "did you mean 'r/planner.missed'?"
