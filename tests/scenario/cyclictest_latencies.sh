#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# cyclictest measures how late a periodic thread wakes. Alone on its processor: by the call that
# asks for the time under fixed accounting, by what it has computed under measured. The other
# threads of several wait for those that are due at the same instant.
# Topics: scheduling, timers, ordinary programs.
latencies() { on_cores 1 "$@"; }
on_cores() {
  "$tcsim" exec --cores "$1" --accounting "$2" -- cyclictest -q -p 80 -i 1000 "${@:3}"
}
worst() { of Max; }
of() { sed -n "s/.*$1: *\([0-9]*\).*/\1/p" | sort -n | tail -1; }  # the largest of the threads'
said=$(latencies fixed -t 1 -l 2000)
[[ $said == *"C:   2000 Min:      1 Act:    1 Avg:    1 Max:       1"* ]] || fail "alone: $said"
said=$(latencies fixed -t 4 -l 1000)
[[ $(grep -c '^T:' <<<"$said") == 4 ]] || fail "four threads were expected: $said"
(($(worst <<<"$said") <= 7)) || fail "later than the calls of the other three: $said"
[[ $(latencies fixed -t 4 -l 1000 | sed 's/([ 0-9]*)//') == "$(sed 's/([ 0-9]*)//' <<<"$said")" ]] ||
  fail "two fixed runs differ"
# Where a call costs less than it can tell, nothing is late: neither alone nor on a core each.
for threads in 1 4; do
  said=$("$tcsim" exec --cores "$threads" --accounting fixed --call-cost 10ns -- \
    cyclictest -q -p 80 -i 1000 -t "$threads" -l 1000)
  [[ $(grep -c 'Min: *0 .*Avg: *0 Max: *0$' <<<"$said") == "$threads" ]] || fail "not 0: $said"
done
# Each on a core of its own, whatever the host has.
said=$(on_cores 4 fixed -t 4 -l 1000)
[[ $(grep -c 'Min: *1 .*Avg: *1 Max: *1$' <<<"$said") == 4 ]] || fail "four cores: $said"
# 4 threads, whose periods begin to coincide at 1, 1.5, 2 and 2.5 ms, compute next to nothing. One time in 4000 may be
# longer, by what a busy host has taken without a clock that tells of it.
said=$(latencies measured -t 4 -l 1000)
(($(of Avg <<<"$said") < 500 && $(worst <<<"$said") < 50000)) || fail "late: $said"
