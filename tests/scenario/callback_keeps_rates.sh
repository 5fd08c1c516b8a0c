#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# While a program waits the world catches up with it: one that computes for 4 ms of every 10 ms runs
# 100 times in a second of the world, and is never ahead of it by more than it computes at a time.
# Topics: scheduling, timers.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/paced.py" <<'PY'
import signal, time
signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGALRM})
signal.setitimer(signal.ITIMER_REAL, 0.01, 0.01)
last = time.monotonic()
while True:
    signal.sigwait({signal.SIGALRM})
    began = time.monotonic()
    assert began >= last, "the clock went back"
    while time.monotonic() < began + 0.004:
        pass
    last = time.monotonic()
    print("tick", flush=True)
PY
cat >"$out/scenario.yaml" <<'YAML'
duration: 1s
dynamics: {engine: ode}
bodies: {b: {mass: 1, inertia: [1, 1, 1]}}
robots: {r: {clients: {paced: {command: [python3, paced.py]}}}}
YAML
"$tcsim" run "$out/scenario.yaml" --sync callback --accounting fixed --out "$out/out" >"$out/said"
ticks=$(grep -c tick "$out/out/r-paced.out.log")
((ticks >= 98 && ticks <= 100)) || fail "$ticks ticks in a second: $(cat "$out/out/r-paced.err.log")"
python3 - "$out/out/summary.json" <<'PY' || fail "$(cat "$out/said")"
import json, sys
drift = json.load(open(sys.argv[1]))["drift_ns"]
assert 4_000_000 <= drift < 50_000_000, drift
PY
