#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A thread that says that it ends, and computes on in a handler, keeps nobody from the processor.
# Topics: threads, scheduling.
out=$(mktemp -d)
trap 'kill ${pester:-} 2>/dev/null || true; rm -rf "$out"' EXIT
timeout -s KILL 80 "$tcsim" exec -- "$build/bin/lingering_threads" 2>"$out/warned" &
run=$!
for _ in $(seq 100); do
  client=$(pgrep -f "^$build/bin/lingering_threads" | head -1 || true)
  [[ -n $client ]] && break
  sleep 0.1
done
timeout 80 "$build/bin/lingering_threads" "$client" &
pester=$!
wait $run || fail "status $?: $(cat "$out/warned")"
printf 'said: %s\n' "$(cat "$out/warned")"
