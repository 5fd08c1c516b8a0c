#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$source_root/tests/as_nobody.sh"
# A client cannot stop, kill, trace or starve tcsim's own processes, nor reach anybody outside the run
# with a signal to all; and where somebody else stops them, the run goes on.
# Topics: isolation, signals, containers.
out=$(mktemp -d)
chmod 755 "$out"
trap 'kill $outsider 2>/dev/null || true; rm -rf "$out"' EXIT
sleep 600 &
outsider=$!

attacked() {  # COMMAND...
  local status=0
  timeout -s KILL 200 "$@" >"$out/said" 2>"$out/warned" || status=$?
  ((status == 0)) || fail "status $status of $*: $(cat "$out/said" "$out/warned")"
  grep -q '^all refused$' "$out/said" || fail "$(cat "$out/said")"
  kill -0 $outsider || fail "a process outside the run was killed"
}
attacked "$tcsim" exec -- "$build/bin/attacker"
attacked "$tcsim" exec --accounting fixed -- "$build/bin/attacker"
if ((EUID == 0)) && prlimit --rtprio=20 true 2>/dev/null; then
  # As somebody who is not above all others, but has the priorities.
  install_for_everybody "$build" "$out" attacker
  attacked prlimit --rtprio=20 setpriv --reuid 65534 --regid 65534 --clear-groups --bounding-set -all \
    "$out/bin/tcsim" exec -- "$out/bin/attacker"
fi

# Whoever is stopped from outside: nothing hangs, and it is said where it is the coordinator.
for victim in coordinator keeper; do
  # Computes until it was stopped, however late that is, and then some more.
  "$tcsim" exec -- sh -c 'while [ ! -e "$0" ]; do :; done; i=0; while [ $i -lt 300000 ]; do i=$((i + 1)); done' \
    "$out/$victim" 2>"$out/warned" &
  run=$!
  for _ in $(seq 4000); do
    process=$(coordinator_of $run 2>/dev/null || true)
    [[ -n $process ]] && break
    sleep 0.05
  done
  [[ $victim == coordinator ]] || process=$(pgrep -P $run)
  kill -STOP "$process"
  touch "$out/$victim"
  for _ in $(seq 10000); do kill -0 $run 2>/dev/null || break; sleep 0.02; done
  ! kill -0 $run 2>/dev/null || fail "a run whose $victim was stopped hangs"
  wait $run || fail "status $?: $(cat "$out/warned")"
  [[ $victim == keeper ]] || grep -q '^tcsim: the coordinator .* was stopped by a signal' "$out/warned" ||
    fail "nothing was said of the stop: $(cat "$out/warned")"
done
