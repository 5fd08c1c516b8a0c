#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Four computing threads of one second each take one second on four cores, two on two, four on one.
# Topics: cores, threads.
for cores in 4 2 1; do
  took=$("$tcsim" exec --cores "$cores" -- "$build/bin/computing_threads" 4 1)
  awk -v t="$took" -v wanted="$((4 / cores))" 'BEGIN { exit !(t >= wanted && t < wanted + 0.01) }' ||
    fail "four seconds of computing took $took s on $cores cores"
done
