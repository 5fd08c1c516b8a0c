#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A fixed piece of work takes twice as long on a processor half as fast: the median of runs side by side, for the host's
# own speed changes by half from second to second, and a hypervisor that takes the processor away unseen looks like work.
# Topics: cores, accounting.
program='
import time
t = time.monotonic()
for i in range(3000000): pass
print(time.monotonic() - t)
'
median() { printf '%s\n' "$@" | sort -g | awk '{ at[NR] = $1 } END { print at[int((NR + 1) / 2)] }'; }
ratios=()
# More, should five not be enough.
for turn in {1..20}; do
  full=$("$tcsim" exec -- python3 -c "$program")
  half=$("$tcsim" exec --speed 0.5 -- python3 -c "$program")
  ratios+=("$(awk -v a="$full" -v b="$half" 'BEGIN { print b / a }')")
  ((turn % 5 == 0)) || continue
  awk -v ratio="$(median "${ratios[@]}")" 'BEGIN { exit !(ratio > 1.6 && ratio < 2.5) }' && exit
done
fail "a fixed piece of work took so many times as long at half the speed: ${ratios[*]}"
