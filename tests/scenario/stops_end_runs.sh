#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# SIGTERM and Ctrl-C end a run, as fast as it can go, at a pace, with a page, and paused; with the signal's status, a summary that
# says so, and nobody left.
# Topics: failures, live page, signals.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cd "$out"
"$tcsim" new hover >/dev/null
cd hover
# Ports of its own; a program that does not heed SIGTERM is ended all the same.
sed -i 's/21010/22310/; s/21011/22311/' scenario.yaml controller.py
sed -i 's/^        body: drone$/&\n      deaf: {command: [python3, deaf.py]}/' scenario.yaml
cat >deaf.py <<'PY'
import signal, time
signal.signal(signal.SIGTERM, signal.SIG_IGN)
print("deaf", flush=True)
while True: time.sleep(0.01)
PY
begun() {  # RUN: until it has begun, and stands if it is to
  # It may have to wait for a processor first.
  for ((i = 0; i < 3000; ++i)); do
    kill -0 "$run" 2>/dev/null || fail "$*: $(cat said)"
    if [[ $* == *--pause* ]]; then
      # Where everything is at the start. Before, nothing has begun of which there could be a summary.
      grep -qs drone results/bodies.csv && return
    else
      grep -qs deaf results/hover-deaf.out.log && return
    fi
    sleep 0.05
  done
  fail "$* does not begin: $(cat said)"
}
for how in '' '--pace 1' '--view --pace 1' '--view --pause'; do
  for signal in TERM INT; do
    rm -rf results
    # shellcheck disable=SC2086
    env --default-signal=INT "$tcsim" run $how --duration 1h --accounting fixed --out results >said 2>&1 &
    run=$!
    begun "$how" "$signal"
    kill -$signal $run
    status=0
    for ((i = 0; i < 1200; ++i)); do
      kill -0 $run 2>/dev/null || break
      sleep 0.05
    done
    ! kill -0 $run 2>/dev/null || fail "run $how has not ended a minute after SIG$signal: $(cat said)"
    wait $run || status=$?
    ((status == 128 + $(kill -l $signal))) || fail "run $how exits with $status after SIG$signal: $(cat said)"
    ! pgrep -f "^python3 (deaf|controller).py" -P 1 >/dev/null || fail "somebody is left"
    python3 -c "import json; s = json.load(open('results/summary.json')); assert s['interrupted'] and 'SIG$signal stopped the run at' in s['verdict'][0], s['verdict']" ||
      fail "run $how: its summary does not say that SIG$signal ended it"
  done
done
