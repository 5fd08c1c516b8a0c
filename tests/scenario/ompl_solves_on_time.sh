#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# solve(0.3) lets a thread of OMPL's own look at the clock, sleep ten times for 1 ms, look again, and
# so on; once it has seen that time is up it sleeps once more before it is joined. So the soonest
# that it can return is after 0.3 s, and 1 ms, and what the thread's 300 sleeps cost it. Set costs
# are known: 1 us for each of those, and half a turn until the thread starts. What the sleeps
# really cost is a matter of the host, natively some 5 us each, and 10 us where a neighbour keeps half of
# the core; but a look that is missed costs 10 ms. A planner that kept the thread from the core for as
# little as 0.1 ms each time would have it return after 0.33 s. Four planners on one core keep the thread no
# longer from it than one does. Nor does a planner that computes ahead, on a second processor of the host, keep it waiting.
# Topics: ompl, timers, threads.
took() {
  "$tcsim" exec --host-cpus "$1" --accounting "$2" --cores "$3" -- "$build/bin/ompl_planners" "$4" 0.3 |
    awk '{for (i = 1; i < NF; ++i) if ($i == "took") print $(i + 1)}'
}
for cores in 1 4; do
  for which in rrtconnect parallel; do
    for accounting in fixed measured; do
      for host_cpus in 1 2; do
        [[ $accounting == fixed && $host_cpus == 2 ]] && continue
        s=$(took "$host_cpus" "$accounting" "$cores" "$which")
        most=0.320
        [[ $accounting == fixed ]] && most=0.303
        awk -v s="$s" -v most="$most" 'BEGIN { exit !(s >= 0.3 && s < most) }' ||
          fail "$which: solve(0.3) takes $s s on $cores cores under $accounting accounting ($host_cpus of the host)"
      done
    done
  done
done
