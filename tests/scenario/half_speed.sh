#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A fixed piece of work takes twice as long on a processor half as fast. The least of several runs in
# turn: a hypervisor that takes the processor away unseen, or a busy neighbour, looks like work.
program='
import time
t = time.monotonic()
for i in range(3000000): pass
print(time.monotonic() - t)
'
full=() half=()
for _ in 1 2 3 4 5; do
  full+=("$("$tcsim" exec -- python3 -c "$program")")
  half+=("$("$tcsim" exec --speed 0.5 -- python3 -c "$program")")
done
least() { printf '%s\n' "$@" | sort -g | head -1; }
awk -v a="$(least "${full[@]}")" -v b="$(least "${half[@]}")" 'BEGIN { exit !(b > 1.6 * a && b < 2.5 * a) }' ||
  fail "a fixed piece of work took ${full[*]} s, and ${half[*]} s at half the speed"
