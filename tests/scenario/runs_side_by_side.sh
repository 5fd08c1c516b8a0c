#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Runs started at once do not stop each other's threads: each claims a CPU, and waits for one.
# Topics: host processors.
program='
import time
t = time.monotonic()
for i in range(300000): pass
time.sleep(10)
assert 10 <= time.monotonic() - t < 11
'
runs=()
for _ in 1 2 3 4; do
  "$tcsim" exec -- python3 -c "$program" 2>/dev/null &
  runs+=($!)
done
for run in "${runs[@]}"; do
  wait "$run" || fail "one of four runs at once failed with $?"
done
# A run inside a run would wait for its own CPU for ever.
inner="$("$tcsim" exec -- "$tcsim" exec -- true 2>&1)" && fail "a run inside a run was not refused"
[[ $inner == *"was started inside a run of another tcsim"* ]] || fail "it said: $inner"
