#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A robot whose programs do not reach it has done nothing: the end of the run says so, and why; a robot
# that is reached gets no warning. What a program that failed said last is part of the sentence.
# Topics: failures, commands, udp.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cp "$source_root"/examples/hover/hover.{py,yaml} "$out"
cd "$out"

hover() {  # SED-SCRIPT FOR hover.yaml, MORE ARGUMENTS: a run of half a second
  sed "$1" hover.yaml >changed.yaml
  shift
  status=0
  timeout 200 "$tcsim" run changed.yaml --set 'expect={}' --duration 500ms --out run "$@" >stdout 2>stderr || status=$?
  sed -i '/^tcsim: other runs of tcsim have/d' stderr
}
says() { grep -Eq "^tcsim: $1" stderr || fail "no '$1' in: $(cat stderr)"; }

hover ''
[[ $status == 0 && ! -s stderr ]] || fail "a robot in reach: status $status, $(cat stderr)"

hover 's/21010/21019/'
says 'warning: channel sensors: no program listens on 127.0.0.1:21019'
says 'warning: channel thrusters: nothing came in on 127.0.0.1:21011, so no command moved drone'
[[ $status == 0 ]] || fail "a warning became status $status"

# What is no command is said once, and counted.
sed -i.bak 's/"force"/"forse"/' hover.py
hover ''
says 'warning: channel thrusters: .*unknown key "forse"'
says 'warning: channel thrusters: ([0-9]+) of the \1 messages that came in were no commands'
(($(wc -l <stderr) == 2)) || fail "not two lines: $(cat stderr)"

# Who failed has said why; where nothing was said, that is said.
hover 's/hover.py/-c, "raise SystemExit(\x27no map here\x27)"/'
says 'drone/controller ended at .* with exit status 1: "no map here" \(run/drone-controller.err.log\)'
(($(wc -l <stderr) == 1)) || fail "not one line: $(cat stderr)"
grep -q '^ended before its 0.500 s because all programs had ended' stdout || fail "$(cat stdout)"
hover 's/hover.py/-c, "raise SystemExit(3)"/'
says 'drone/controller ended at .* with exit status 3: it printed nothing'

# A run that is killed leaves no summary of the one before it.
mv hover.py.bak hover.py
hover ''
[[ -s run/summary.json ]] || fail "no summary"
timeout -s KILL 400 "$tcsim" run changed.yaml --duration 1h --out run >stdout 2>stderr &
run=$!
for _ in $(seq 2000); do [[ -e run/trace.json && ! -e run/summary.json ]] && break; sleep 0.1; done
kill -KILL "$(coordinator_of "$(pgrep -P "$run")")"
status=0; wait "$run" || status=$?
[[ $status != 0 && ! -e run/summary.json ]] || fail "status $status, and $(ls run)"
