#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Four computing threads of a quarter of a second each take that long on four cores, half a second on two, a second
# on one.
# Topics: cores, threads.
for cores in 4 2 1; do
  took=$("$tcsim" exec --cores "$cores" -- "$build/bin/computing_threads" 4 0.25)
  # Measured charges are those of CPU clocks to 1 %, and starting threads takes a slow host some ms.
  awk -v t="$took" -v cores="$cores" 'BEGIN { exit !(t >= 0.99 / cores && t < 1.01 / cores + 0.01) }' ||
    fail "a second of computing took $took s on $cores cores"
done
