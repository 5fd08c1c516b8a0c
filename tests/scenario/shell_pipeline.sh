#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Several processes in one pipeline share one virtual time. Rounded down, for the programs compute for some milliseconds too;
# counted in nanoseconds, for two whole seconds may lie in between where one has passed.
# Topics: languages, processes, timers, containers.
said=$("$tcsim" exec -- sh -c 'a=$(date +%s%N); echo c b a | tr " " "\n" | sort |
  while read -r x; do sleep 100; printf %s "$x"; done; echo $((($(date +%s%N) - a) / 1000000000))')
[[ $said == abc300 ]] || fail "expected abc300, got: $said"
said=$("$tcsim" exec -- perl -MTime::HiRes=time,sleep -e '$a = time; sleep 50; print int(time - $a)')
[[ $said == 50 ]] || fail "perl slept $said s instead of 50"
