#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Signals come from outside in any instant of a program's calls, between a call and the moment in which the coordinator
# has it: no call fails that natively does not, with rights and without.
# Topics: signals, rights.
out=$(mktemp -d)
sender=
trap '[[ -z $sender ]] || kill "$sender" 2>/dev/null || true; rm -rf "$out"' EXIT
check() {  # WHAT COMMAND...
  local what=$1 status=0 run client=
  shift
  : >"$out/said"
  # It may have to wait for a processor, and so may whoever sends.
  timeout 150 "$@" "$build/bin/never_waiting" 300 >"$out/said" 2>"$out/warned" &
  run=$!
  for _ in $(seq 1500); do
    client=$(awk '/^calls as/ { print $3 }' "$out/said")
    [[ -z $client ]] || break
    sleep 0.1
  done
  [[ -n $client ]] || fail "$what: it never came to its calls: $(cat "$out/said" "$out/warned")"
  while kill -USR1 "$client" 2>/dev/null; do :; done &
  sender=$!
  wait "$run" || status=$?
  kill "$sender" 2>/dev/null || true
  wait "$sender" 2>/dev/null || true
  sender=
  ((status == 0)) || fail "$what: status $status: $(cat "$out/said" "$out/warned")"
  grep -qx 'none failed' "$out/said" || fail "$what: $(cat "$out/said" "$out/warned")"
}
without_rights=$source_root/tests/conformance/without_rights.sh
for accounting in measured fixed; do
  check "$accounting" "$tcsim" exec --accounting "$accounting" --
  check "$accounting, without rights" "$without_rights" "$build" exec --accounting "$accounting" --
  check "$accounting, in a container" "$without_rights" --in-container "$build" exec --accounting "$accounting" --
done
