#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# What no page can be made of is refused with one sentence; what one can is reported without it.
# Topics: report, failures.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cd "$out"
cat >scenario.yaml <<'YAML'
duration: 100ms
robots: {r: {cpu: {speed: 0.5}, clients: {idle: {command: [sleep, "1"], class: periodic, priority: 7}}}}
YAML
"$tcsim" run scenario.yaml --out run --accounting fixed >said || fail "$(cat said)"
# A folder of results says how it was made.
python3 - <<'PY' || fail "$(cat run/summary.json)"
import json
summary = json.load(open("run/summary.json"))
assert (summary["sync"], summary["accounting"], summary["engine"]) == ("consistent", "fixed", None)
assert (summary["robots"]["r"]["cores"], summary["robots"]["r"]["speed"]) == (1, 0.5)
client = summary["clients"]["r/idle"]
assert (client["class"], client["priority"], client["robot"]) == ("periodic", 7, "r")
PY
[[ $(head -1 run/dispatches.csv) == row,virtual_start_ns,virtual_end_ns ]] || fail "$(head -1 run/dispatches.csv)"

refused() {  # PATTERN ARGUMENTS...
  local pattern=$1 status=0
  shift
  PATH=${path:-$PATH} "$tcsim" report "$@" >stdout 2>stderr || status=$?
  ((status == 2)) || fail "exit status $status instead of 2: $*"
  [[ $(wc -l <stderr) == 1 ]] || fail "not one line: $(cat stderr)"
  grep -Eq "^tcsim: .*$pattern" stderr || fail "$(cat stderr)"
}
mkdir other damaged
echo '{"scenario": "scen' >damaged/summary.json
refused "no folder 'nowhere'" nowhere
refused "'other' is no result folder" other
refused 'damaged/summary.json is damaged' damaged
refused 'no body .predator. in run; it has none' run --bodies predator,prey
refused '--bodies needs two' run --bodies predator
refused 'cannot be written' run --out no/such/page.html
refused '\{svg,png\}' run --figures gif
refused 'mark' run --mark -1
sed 's/"scenario": "scenario"/"scenario": "another"/' run/summary.json >changed
mkdir another
mv changed another/summary.json
refused "is of scenario 'another'" run another
# Without rsvg-convert: a PATH of nothing.
path=$out/other refused 'rsvg-convert.*librsvg2-bin' run --figures png

"$tcsim" report run damaged --out page.html >said 2>warned || fail "$(cat warned)"
grep -q 'warning: damaged .*left out' warned || fail "the damaged folder was not named: $(cat warned)"
grep -q 'damaged/summary.json is damaged' page.html || fail "the page does not name the damaged folder"
