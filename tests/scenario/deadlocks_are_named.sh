#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Two threads of a client that wait for each other's mutex for ever are named at the end of the run, with the time; so
# where mutexes lend priority. Threads that wait for a condition are not in a deadlock.
# Topics: verdict, threads.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/s.yaml" <<YAML
duration: 20s
robots:
  r:
    clients:
      plain: {command: [$build/bin/deadlocked]}
      lending: {command: [$build/bin/deadlocked, pi]}
      waits: {command: [python3, -c, "import threading; threading.Event().wait()"]}
YAML
for accounting in fixed measured; do
  timeout 200 "$tcsim" run "$out/s.yaml" --accounting $accounting --out "$out/run" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  for client in plain lending; do
    grep -q "^! 2 threads are in a deadlock from 0\.[0-9]* s on: r/$client waits for a lock that r/$client #[0-9]* has, r/$client #[0-9]* waits for a lock that r/$client has$" "$out/said" ||
      fail "$client: $(cat "$out/said")"
  done
  (($(grep -c 'deadlock' "$out/said") == 2)) || fail "somebody else is in a deadlock: $(cat "$out/said")"
done
