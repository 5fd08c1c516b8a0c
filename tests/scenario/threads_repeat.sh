#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Fourteen threads and their children do the same in each run under fixed accounting, every reading
# of the clock included, on one core and on four. A third argument is for how many ms, instead of 200.
# Topics: threads, determinism, cores.
ms=("${@:3}")
many() {
  "$tcsim" exec --cores "$1" --accounting fixed -- "$build/bin/conformance_many_threads" fixed "${ms[@]}"
}
for cores in 1 4; do
  first=$(many "$cores")
  [[ $first == *rounds* ]] || fail "no result on $cores cores: $first"
  second=$(many "$cores")
  [[ $first == "$second" ]] || fail "two runs on $cores cores differ: $first and $second"
done
