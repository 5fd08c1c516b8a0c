#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Several processes in one pipeline share one virtual time.
said=$("$tcsim" exec -- sh -c 'a=$(date +%s); echo c b a | tr " " "\n" | sort |
  while read -r x; do sleep 100; printf %s "$x"; done; echo $(($(date +%s) - a))')
[[ $said == abc300 ]] || fail "expected abc300, got: $said"
said=$("$tcsim" exec -- perl -e 'sleep 50; print time - $^T')
[[ $said == 50 ]] || fail "perl slept $said s instead of 50"
