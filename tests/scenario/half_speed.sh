#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A fixed piece of work takes twice as long on a processor half as fast. The least of several runs in
# turn: a hypervisor that takes the processor away unseen, or a busy neighbour, looks like work.
# Topics: cores, accounting.
program='
import time
t = time.monotonic()
for i in range(3000000): pass
print(time.monotonic() - t)
'
least() { printf '%s\n' "$@" | sort -g | head -1; }
full=() half=()
# The host's own speed scatters by half: more runs, should five not be enough to see the least.
for turn in {1..20}; do
  full+=("$("$tcsim" exec -- python3 -c "$program")")
  half+=("$("$tcsim" exec --speed 0.5 -- python3 -c "$program")")
  ((turn % 5 == 0)) || continue
  awk -v a="$(least "${full[@]}")" -v b="$(least "${half[@]}")" 'BEGIN { exit !(b > 1.6 * a && b < 2.5 * a) }' && exit
done
fail "a fixed piece of work took ${full[*]} s, and ${half[*]} s at half the speed"
