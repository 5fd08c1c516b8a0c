#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A thread that says that it ends, and computes on in a handler, keeps nobody from the processor.
# Topics: threads, scheduling.
out=$(mktemp -d)
trap 'kill ${pester:-} 2>/dev/null || true; rm -rf "$out"' EXIT
timeout -s KILL 200 "$tcsim" exec -- "$build/bin/lingering_threads" 2>"$out/warned" &
run=$!
client=
# It may have to wait for a processor first.
while kill -0 $run 2>/dev/null; do
  client=$(pgrep -o -f "^$build/bin/lingering_threads" || true)
  [[ -n $client ]] && break
  sleep 0.1
done
timeout 200 "$build/bin/lingering_threads" "$client" &
pester=$!
wait $run || fail "status $?: $(cat "$out/warned")"
printf 'said: %s\n' "$(cat "$out/warned")"
