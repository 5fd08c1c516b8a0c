#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Two readings of the clock around an hour's sleep are exactly an hour apart, and nobody waited for it.
began=$SECONDS
mapfile -t t < <("$tcsim" exec -- sh -c 'date +%s; sleep 3600; date +%s')
difference=$((t[1] - t[0]))
((difference == 3600)) || fail "the clock moved by $difference s instead of 3600"
((SECONDS - began < 60)) || fail "an hour of virtual time took real minutes"
