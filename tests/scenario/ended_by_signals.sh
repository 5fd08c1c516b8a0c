#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A signal to tcsim ends the run in order: the programs get their grace, and the exit status is 128
# and the signal's number. A second one at the same moment changes nothing; one that comes later
# does not wait for the grace any more.
# Topics: ends, signals.
out=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$out"' EXIT

# Computes for ever, and when it is told to end for SECONDS of its own time. READY says that it runs, READY.told that it
# was told.
cat >"$out/keeper.py" <<'PY'
import os, signal, sys, time
takes = float(sys.argv[1])
def end(number, frame):
    open(sys.argv[2] + ".told", "w").close()
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
  r: {clients: {keeper: {command: [python3, keeper.py, "0.05", "${out}/ready"], stop_grace: 10s}}}
YAML

begun() {  # COMMAND...: in the background as $tcsim_pid, until its program runs
  rm -f "$out/ready" "$out/ready.told"
  "$@" >"$out/said" 2>&1 &
  tcsim_pid=$!
  await "$out/ready" "it did not begin"
}
await() {  # FILE WHAT: it may have to wait for a processor first
  local _
  for _ in $(seq 5000); do [[ -e $1 ]] && return; sleep 0.02; done
  fail "$2: $(cat "$out/said")"
}
ended() {  # STATUS WHAT
  local status=0
  wait "$tcsim_pid" || status=$?
  ((status == $1)) || fail "$2: status $status instead of $1: $(cat "$out/said")"
}
run=("$tcsim" run "$out/s.yaml" --out "$out/run")
program=("$tcsim" exec -- python3 "$out/keeper.py" 0.05 "$out/ready")

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

# Whoever is told to ignore that the terminal is gone does so.
begun nohup "${run[@]}"
kill -HUP "$tcsim_pid"
sleep 0.3
kill -TERM "$tcsim_pid" || fail "SIGHUP to a run under nohup ended it: $(cat "$out/said")"
ended 143 "SIGTERM to a run under nohup"

# Whenever SIGINT comes, though a script's background ignores it: none is lost while the run is prepared.
for milliseconds in $(seq 0 10 60); do
  "${run[@]}" >"$out/said" 2>&1 &
  tcsim_pid=$!
  for _ in $(seq 5000); do coordinator_of "$tcsim_pid" >/dev/null 2>&1 && break; sleep 0.002; done
  sleep "$(printf '0.%03d' "$milliseconds")"
  kill -INT "$tcsim_pid"
  ended 130 "SIGINT $milliseconds ms after its begin"
done

# Several at the same moment are one: to tcsim, to its group, and while it cannot look. The same moment is a second of
# real time, and a busy host may take longer to pass them on: so one of several tries is enough.
send_several() {  # HOW, to tcsim's process
  local coordinator
  coordinator=$(coordinator_of "$tcsim_pid")
  case $1 in
    1) kill -TERM "$tcsim_pid"; kill -TERM "$tcsim_pid"; kill -INT "$tcsim_pid" "$coordinator" ;;
    2) kill -INT "$tcsim_pid" "$coordinator"; kill -TERM "$coordinator" "$tcsim_pid" ;;
    3)
      kill -STOP "$coordinator"
      kill -TERM "$coordinator"; kill -INT "$coordinator"; kill -HUP "$coordinator"
      # Its keeper makes it go on.
      ;;
  esac 2>/dev/null || true
}
for times in 1 2 3; do
  had_grace=
  for _ in $(seq 5); do
    begun "${run[@]}"
    send_several $times
    status=0
    wait "$tcsim_pid" || status=$?
    ((status == 143 || status == 130 || status == 129)) || fail "several, $times: status $status"
    [[ $(cat "$out/run/r-keeper.out.log") == "ended by 15" ]] && had_grace=yes && break
  done
  [[ $had_grace == yes ]] || fail "several, $times: no grace"
done

# Who does not end has its grace, unless somebody insists. Time stands still in a world that waits
# for who computes (--sync callback), but not for its grace: that takes two seconds of real time, beside the next run.
ask_in_vain() {  # SYNC: who does not end, in a folder of its own, by $tcsim_pid
  local sync=$1 top=$out out=$out/$1
  mkdir "$out"
  cp "$top/keeper.py" "$out"
  sed "s/\"0.05\"/\"1000\"/; s/10s/0.2s/; s|$top/ready|$out/ready|" "$top/s.yaml" >"$out/s.yaml"
  begun "$tcsim" run "$out/s.yaml" --sync "$sync" --out "$out/run"
  kill -TERM "$tcsim_pid"
}
was_killed() {  # SYNC
  local sync=$1 out=$out/$1
  ended 143 "who does not end, --sync $sync"
  grep -q 'r/keeper was killed: after SIGTERM' "$out/said" || fail "$sync: $(cat "$out/said")"
}
ask_in_vain callback
callback_pid=$tcsim_pid
# No grace takes more than six seconds of real time; the end by that has a sentence of its own, and where the host was
# slow enough to come to it, the second signal was too late.
sed 's/"0.05"/"1000"/; s/10s/1h/' "$out/s.yaml" >"$out/long.yaml"
insisted=
for _ in $(seq 5); do
  begun "$tcsim" run "$out/long.yaml" --out "$out/run"
  kill -TERM "$tcsim_pid"
  await "$out/ready.told" "it was not told"
  sleep 1.2  # what comes within a second is of the same wish
  kill -TERM "$tcsim_pid" 2>/dev/null || true
  ended 143 "a second SIGTERM"
  grep -q 'the limit of real time' "$out/said" && continue
  insisted=yes
  break
done
[[ $insisted == yes ]] || fail "a second SIGTERM waits for the grace: $(cat "$out/said")"
ask_in_vain consistent
was_killed consistent
tcsim_pid=$callback_pid
was_killed callback
none_left "$out/" || fail "something is left: $(pgrep -af "$out/")"
