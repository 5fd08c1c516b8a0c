#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A sleep takes as long on a slow processor; processor time counts double against the host's.
program='
import time
c = time.process_time(); t = time.monotonic()
for i in range(3000000): pass
print(time.monotonic() - t)
'
full=$("$tcsim" exec -- python3 -c "$program")
half=$("$tcsim" exec --speed 0.25 -- python3 -c "$program")
awk -v a="$full" -v b="$half" 'BEGIN { exit !(b > 2.5 * a && b < 6 * a) }' ||
  fail "a fixed piece of work took $full s, and $half s at a quarter of the speed"
