#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Threads that wait for other cores by looking at memory see what those do when they have done it, and not a drift bound
# later: OpenMP's barriers, and words in memory that are looked at with pauses, yields, clock readings or nothing in
# between. It does not matter how many processors the host gives, and under set costs runs repeat. A thread that spins
# is charged for it.
# Topics: threads, cores, drift, determinism, host processors.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
run() { # CORES PROGRAM ARGUMENT... with the options in $options
  # shellcheck disable=SC2086  # several options
  timeout 150 "$tcsim" exec $options --cores "$1" -- "${@:2}" 2>"$out/err" || fail "$*: $(cat "$out/err")"
}
between() { # LEAST MOST VALUE WHAT
  awk -v least="$1" -v most="$2" -v value="$3" 'BEGIN { exit !(least <= value && value <= most) }' ||
    fail "$4: $3 instead of $1 to $2 us"
}
# A region takes at least what its threads compute; 2,000 us where cores come apart by the drift bound. What a switch costs
# is the host's, and a busy one's twice as much. So measured runs are told from that bound, and exact ones are for set costs.
for cores in 2 4; do
  for options in "--host-cpus 1" "" "--accounting fixed"; do
    for policy in "" active passive; do
      us=$(OMP_WAIT_POLICY="$policy" run $cores "$build/bin/parallel_regions" $cores 200)
      [[ $options == *fixed* ]] && most=240 || most=1000
      between 200 $most "$us" "OpenMP on $cores cores $options $policy"
    done
  done
done
# Close to each other by at most 50 us in either direction.
hand_over() { # HOW US LEAST MOST
  local options us cpu
  for options in "--host-cpus 1" ""; do
    read -r us cpu < <(run 2 "$build/bin/spinning_hand_over" "$1" "$2")
    between "$3" "$4" "$us" "$1 $options"
    between 1.2 2.5 "$cpu" "$1 $options: charged"
  done
}
for how in pause yield clock; do hand_over $how 200 150 1000; done
hand_over bare 200 200 1000
options="--accounting fixed"
for how in pause yield clock; do
  run 2 "$build/bin/spinning_hand_over" $how 200 >"$out/first"
  run 2 "$build/bin/spinning_hand_over" $how 200 >"$out/second"
  cmp "$out/first" "$out/second" || fail "$how: two runs differ"
  read -r us _ <"$out/first"
  between 150 300 "$us" "$how under set costs"
done
