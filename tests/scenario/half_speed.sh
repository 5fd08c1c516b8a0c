#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A fixed piece of work takes twice as long on a processor half as fast. The least of several runs: a
# hypervisor that takes the processor away unseen looks like work.
program='
import time
t = time.monotonic()
for i in range(3000000): pass
print(time.monotonic() - t)
'
least() { for _ in 1 2 3 4; do "$tcsim" exec --speed "$1" -- python3 -c "$program"; done | sort -g | head -1; }
full=$(least 1)
half=$(least 0.5)
awk -v a="$full" -v b="$half" 'BEGIN { exit !(b > 1.8 * a && b < 2.2 * a) }' ||
  fail "a fixed piece of work took $full s, and $half s at half the speed"
