#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A program that spins on the clock for one second is charged one second, within 1 %.
# Topics: accounting.
program='
import time
t = time.monotonic(); c = time.process_time()
while time.monotonic() - t < 1.0: pass
print(time.process_time() - c)
'
charged=$("$tcsim" exec -- python3 -c "$program")
awk -v c="$charged" 'BEGIN { exit !(c > 0.99 && c < 1.01) }' || fail "charged $charged s for 1 s"
