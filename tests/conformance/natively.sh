#!/usr/bin/env bash
# natively.sh PROGRAM: the kernel is the reference for what PROGRAM expects. Its time is real time,
# which a loaded host bends: so it has three tries, and says what went wrong in each.
set -u
for _ in 1 2 3; do
  timeout 19 "$1" && exit 0
done
exit 1
