#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Two readings of the clock around an hour's sleep are an hour apart, and what the programs compute between; where that
# has a set cost, they are in the same second of their hours. Whoever waited for the hour would meet this test's timeout.
# Topics: timers.
read_clock() {  # ACCOUNTING FORMAT: into t
  mapfile -t t < <("$tcsim" exec --accounting "$1" -- sh -c "date +$2; sleep 3600; date +$2")
  ((${#t[@]} == 2)) || fail "$1: the clock was read ${#t[@]} times"
}
read_clock fixed %s
((t[1] - t[0] == 3600)) || fail "fixed: the clock moved by $((t[1] - t[0])) s instead of 3600"
read_clock measured %s%N
((t[1] - t[0] >= 3600000000000)) || fail "measured: the clock moved by $((t[1] - t[0])) ns, which is less than an hour"
((t[1] - t[0] < 3660000000000)) || fail "measured: the clock moved by $((t[1] - t[0])) ns"
