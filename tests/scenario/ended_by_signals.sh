#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A signal to tcsim ends the run in order: the programs get their grace, and the exit status is 128
# and the signal's number. A second one at the same moment changes nothing; one that comes later
# does not wait for the grace any more.
out=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$out"' EXIT

# Computes for ever, and for SECONDS when it is told to end.
cat >"$out/keeper.py" <<'PY'
import os, signal, sys, time
takes = float(sys.argv[1])
def end(number, frame):
    until = time.process_time() + takes
    while time.process_time() < until: os.getppid()
    print("ended by", number)
    sys.exit(0)
for number in signal.SIGTERM, signal.SIGINT, signal.SIGHUP: signal.signal(number, end)
open(sys.argv[2], "w").close()
while True: os.getppid()
PY
cat >"$out/s.yaml" <<YAML
duration: 1h
robots:
  r: {clients: {keeper: {command: [python3, keeper.py, "0.3", "${out}/ready"], stop_grace: 10s}}}
YAML

begun() {  # COMMAND...: in the background as $tcsim_pid, until its program runs
  rm -f "$out/ready"
  "$@" >"$out/said" 2>&1 &
  tcsim_pid=$!
  for _ in $(seq 200); do [[ -e $out/ready ]] && return; sleep 0.1; done
  fail "it did not begin: $(cat "$out/said")"
}
ended() {  # STATUS WHAT
  local status=0
  wait "$tcsim_pid" || status=$?
  ((status == $1)) || fail "$2: status $status instead of $1: $(cat "$out/said")"
}
run=("$tcsim" run "$out/s.yaml" --out "$out/run")
program=("$tcsim" exec -- python3 "$out/keeper.py" 0.3 "$out/ready")

for ends in TERM:143:15 INT:130:15 HUP:129:15; do
  IFS=: read -r signal status number <<<"$ends"
  begun "${run[@]}"
  kill "-$signal" "$tcsim_pid"
  ended "$status" "SIG$signal to a run"
  [[ $(cat "$out/run/r-keeper.out.log") == "ended by $number" ]] || fail "SIG$signal: no grace"
  python3 - "$out/run/summary.json" <<'PY' || fail "SIG$signal: $(cat "$out/said")"
import json, sys
summary = json.load(open(sys.argv[1]))
assert summary["interrupted"] and summary["clients"]["r/keeper"]["ended_at_ns"] == -1
assert 0 < summary["virtual_ns"] < 3600e9
# The grace is no part of the run.
assert summary["clients"]["r/keeper"]["charged_ns"] <= summary["virtual_ns"] + 10e6, summary
PY
done

# A program alone is told with the signal that came.
for ends in TERM:143:15 INT:130:2 HUP:129:1; do
  IFS=: read -r signal status number <<<"$ends"
  begun "${program[@]}"
  kill "-$signal" "$tcsim_pid"
  ended "$status" "SIG$signal to a program"
  # Besides, tcsim may have said that it waited for other runs.
  [[ $(tail -n 1 "$out/said") == "ended by $number" ]] || fail "SIG$signal to a program: $(cat "$out/said")"
done

# Several at the same moment are one: to tcsim, to its group, and while it cannot look.
for times in 1 2 3; do
  begun "${run[@]}"
  coordinator=$(coordinator_of "$tcsim_pid")
  case $times in
    1) kill -TERM "$tcsim_pid" && kill -TERM "$tcsim_pid" && kill -INT "$tcsim_pid" "$coordinator" ;;
    2) kill -INT "$tcsim_pid" "$coordinator" && kill -TERM "$coordinator" "$tcsim_pid" ;;
    3)
      kill -STOP "$coordinator"
      kill -TERM "$coordinator" && kill -INT "$coordinator" && kill -HUP "$coordinator"
      # Its keeper makes it go on.
      ;;
  esac
  status=0
  wait "$tcsim_pid" || status=$?
  ((status == 143 || status == 130 || status == 129)) || fail "several, $times: status $status"
  [[ $(cat "$out/run/r-keeper.out.log") == "ended by 15" ]] || fail "several, $times: no grace"
done

# Who does not end has its grace, unless somebody insists. Time stands still in a world that waits
# for who computes (--sync callback), but not for its grace.
sed 's/"0.3"/"1000"/; s/10s/1h/' "$out/s.yaml" >"$out/long.yaml"
begun "$tcsim" run "$out/long.yaml" --out "$out/run"
kill -TERM "$tcsim_pid"
sleep 2
kill -0 "$tcsim_pid" || fail "it did not wait for the grace"
kill -TERM "$tcsim_pid"
before=$SECONDS
ended 143 "a second SIGTERM"
((SECONDS - before < 4)) || fail "a second SIGTERM took $((SECONDS - before)) s"
sed 's/"0.3"/"1000"/; s/10s/0.2s/' "$out/s.yaml" >"$out/short.yaml"
for sync in consistent callback; do
  begun "$tcsim" run "$out/short.yaml" --sync "$sync" --out "$out/run"
  kill -TERM "$tcsim_pid"
  ended 143 "who does not end, --sync $sync"
  grep -q 'r/keeper was killed: after SIGTERM' "$out/said" || fail "$sync: $(cat "$out/said")"
done
pgrep -f "$out/" >/dev/null && fail "something is left"
true
