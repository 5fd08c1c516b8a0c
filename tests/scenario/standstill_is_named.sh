#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Where nothing can happen any more by itself, a run says after a while whom it waits for, and what
# that one waits for: once, whichever command the run is of. Where input comes soon, or a user sits
# at a terminal, it says nothing.
# Topics: failures.
out=$(mktemp -d)
run=''
trap '[ -z "$run" ] || kill "$run" 2>/dev/null || true; rm -rf "$out"' EXIT
mkfifo "$out/never" "$out/late"

# FILE PATTERN COMMAND...: what FILE comes to have, once; then the command ends as its user asks.
names() {
  local file=$1 pattern=$2 tries=0
  shift 2
  rm -f "$file"
  "$@" >"$out/stdout" 2>"$out/stderr" <"${input:-/dev/null}" &
  run=$!
  until grep -Eq "$pattern" "$file" 2>/dev/null; do
    [ -e "/proc/$run" ] || fail "'$*' has ended: $(cat "$out/stderr")"
    ((++tries < 400)) || fail "'$*' does not say '$pattern': $(cat "$file")"
    sleep 0.1
  done
  sleep 0.5
  kill -TERM "$run"
  wait "$run" || true
  run=''
  [[ $(grep -Ec "$pattern" "$file") == 1 ]] || fail "not once: $(cat "$file")"
}
stood='^tcsim: virtual time has stood still at [0-9.]+ s for [0-9]+ s: only input from outside could make it go on; '
asks='; Ctrl-C ends the run$'

exec 9<>"$out/never"  # so that opening it does not wait
input=$out/never names "$out/stderr" "${stood}cat waits for input at descriptor 0 \(a pipe\)$asks" \
  "$tcsim" exec -- cat
names "$out/stderr" "${stood}python3 waits for a lock or a condition that no thread gives it$asks" \
  "$tcsim" exec -- python3 -c 'import threading; l = threading.Lock(); l.acquire(); l.acquire()'
names "$out/stderr" "${stood}sh waits for a signal, such as that of a child's end; [a-z]+ \(pid [0-9]+\) is stopped by a signal" \
  "$tcsim" exec -- sh -c 'sleep 5 & kill -STOP $!; wait'
names "$out/stderr" '^tcsim: sh has ended; the run goes on for the background processes that it has left: dash \(pid [0-9]+\).*; Ctrl-C' \
  "$tcsim" exec -- sh -c 'while :; do sleep 1; done & sleep 3'

names "$out/stderr" '^tcsim: virtual time has .* it waits for threads or processes that tcs does not manage: python3[.0-9]* \(pid' \
  "$tcsim" exec -- python3 -c '
import ctypes, os, signal, time
if ctypes.CDLL(None).syscall(56, signal.SIGCHLD, 0, 0, 0, 0) == 0:  # a bare clone
    while True: pass
os.wait()'

# A call that only the kernel knows the end of (no world goes on meanwhile).
printf '%s\n' 'duration: 3600s' "robots: {r: {clients: {held: {command: [cat, '$out/late']}}}}" \
  >"$out/held.yaml"
held="${stood}r/held is in system call [0-9]+, whose end only the kernel knows$asks"
names "$out/stderr" "$held" "$tcsim" run "$out/held.yaml" --out "$out/run"
names "$out/trials/seed-0001/tcsim.log" "$held" \
  "$tcsim" trials "$out/held.yaml" --trials 1 --jobs 1 --out "$out/trials"

# Nothing to say.
(for i in 1 2 3 4; do sleep 1.5; echo "$i"; done) | "$tcsim" exec -- cat >"$out/stdout" 2>"$out/stderr"
[[ $(wc -l <"$out/stdout") == 4 ]] || fail "of what is read: $(cat "$out/stdout")"
! grep -q 'stood still' "$out/stderr" || fail "input that comes: $(cat "$out/stderr")"
(sleep 8; echo end) | script -qefc "'$tcsim' exec -- head -n 1" /dev/null >"$out/stdout" 2>&1
! grep -q 'stood still' "$out/stdout" || fail "at a terminal: $(cat "$out/stdout")"
