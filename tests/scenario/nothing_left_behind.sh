#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A coordinator killed in the middle takes its clients with it.
"$tcsim" exec -- sh -c 'while :; do :; done' &
pid=$!
sleep 1
kill -9 "$pid"
wait "$pid" 2>/dev/null || true
for _ in $(seq 50); do
  pgrep -f 'sh -c while :; do :; done' >/dev/null || exit 0
  sleep 0.1
done
pkill -9 -f 'sh -c while :; do :; done'
fail "a client outlived its coordinator"
