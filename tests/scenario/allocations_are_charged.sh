#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Under fixed accounting each allocation costs what it is said to, whatever function makes it and in
# each thread, and from 1000 locks in a row on each a hundredth of that; computing costs nothing. 1000 of them stand between two readings of the clock, the
# second of which costs 1 us; a thread that has just begun may owe one more, or have paid it.
# Topics: accounting, threads.
costs() {
  local each=$1 said names
  shift
  said=$("$tcsim" exec --accounting fixed "$@" -- "$build/bin/allocating")
  names=$(awk -v each="$each" '{
      cost = $1 ~ /computing|locks/ ? 0 : $1 ~ /mutex|rwlock/ ? int(each / 100) : each
      rest = $2 - 1000 * cost
      if (rest == 1000 || ($1 == "thread" && rest >= 0 && rest <= 2000)) print $1
    }' <<<"$said")
  [[ $(wc -w <<<"$names") == 13 ]] || fail "$*: not $each ns for each allocation and a hundredth for each lock of many: $said"
}
costs 2000
costs 150 --allocation-cost 150ns
costs 0 --allocation-cost 0
# What is measured never pays: the library is not there.
for options in "--accounting fixed --allocation-cost 0" "--accounting measured"; do
  # shellcheck disable=SC2086
  "$tcsim" exec $options -- cat /proc/self/maps | grep libtcs_allocations &&
    fail "$options preloads the allocation library"
done
"$tcsim" exec --accounting fixed -- sh -c 'env -i cat /proc/self/maps' | grep libtcs_allocations >/dev/null ||
  fail "a child with an environment of its own allocates for nothing"
said=$("$tcsim" exec --allocation-cost -1us -- true 2>&1) && fail "a negative cost is taken"
[[ $(wc -l <<<"$said") == 1 ]] || fail "more than one sentence: $said"
