#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# solve(1.0) lets a thread of OMPL's own look at the clock after every ten sleeps of 1 ms, and joins
# it at its end. So it returns no earlier than at 1.0 s, and later by: what the thread's 1000 sleeps
# cost it (natively some 5 us of processor time each; less than the 10 ms between two looks), its
# last sleep, of up to 1 ms, and, on several cores, the drift bound of 1 ms within which the planner
# sees its flag.
took() {
  "$tcsim" exec --cores "$1" -- "$build/bin/ompl_planners" rrtconnect 1.0 |
    awk '{for (i = 1; i < NF; ++i) if ($i == "took") print $(i + 1)}'
}
one=$(took 1)
four=$(took 4)
awk -v one="$one" -v four="$four" 'BEGIN {
  exit !(one >= 1 && one < 1.012 && four >= 1 && four < 1.012)
}' || fail "solve(1.0) takes $one s on one core and $four s on four"
