#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Without rights the kernel keeps signals from a thread that waits in a call which tcs holds: one from
# outside, ^C say, reaches its handler all the same.
# Topics: signals, rights.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
program='
import signal, sys, threading
def handle(*_):
    print("handled", flush=True)
    sys.exit(7)
signal.signal(signal.SIGINT, handle)
print("waits as", __import__("os").getpid(), flush=True)
threading.Event().wait()
'
timeout 200 "$source_root/tests/conformance/without_rights.sh" "$build" exec --accounting fixed -- python3 -c "$program" \
  >"$out/said" 2>"$out/warned" &
run=$!
for _ in $(seq 900); do
  grep -q '^waits as' "$out/said" && break
  sleep 0.1
done
client=$(awk '/^waits as/ { print $3 }' "$out/said")
[[ -n $client ]] || fail "it never waited: $(cat "$out/said" "$out/warned")"
# It is in its call then, and not just before it.
for _ in $(seq 900); do
  [[ $(awk '{ print $3 }' "/proc/$client/stat") == S ]] && break
  sleep 0.1
done
sleep 0.5
kill -INT "$client"
status=0
wait "$run" || status=$?
((status == 7)) || fail "status $status: $(cat "$out/said" "$out/warned")"
grep -qx handled "$out/said" || fail "$(cat "$out/said")"
