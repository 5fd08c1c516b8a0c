#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Random numbers are the same in each run under fixed accounting, and others under measured.
# Topics: determinism.
draws() { "$tcsim" exec --accounting "$1" -- "$build/bin/conformance_randomness" "$1"; }
first=$(draws fixed)
[[ $(wc -w <<<"$first") == 5 ]] || fail "five draws were expected, not: $first"
second=$(draws fixed)
[[ $first == "$second" ]] || fail "two runs drew differently: $first and $second"
measured=$(draws measured)
[[ $first != "$measured" ]] || fail "measured accounting drew the same numbers"
