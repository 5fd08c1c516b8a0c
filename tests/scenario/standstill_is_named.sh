#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Where nothing can happen any more by itself, a run says after a while whom it waits for, and what
# that one waits for: once, whichever command the run is of. Where input comes soon, or a user sits
# at a terminal, it says nothing.
# With the argument `with_rights` each run has a processor for itself, and they come one after the other.
# Topics: failures.
scope=${3:-}
out=$(mktemp -d)
trap 'wait; rm -rf "$out"' EXIT
mkfifo "$out/never" "$out/late"

# All wait for the same few seconds, and at once; but for two without rights, since who has them waits for a processor.
unprivileged=(prlimit --rtprio=0:0 --nice=0:0)
((EUID != 0)) || unprivileged+=(setpriv --bounding-set=-all --inh-caps=-all)
[[ $scope != with_rights ]] || unprivileged=()
goes() {
  beside "$@"
  [[ $scope != with_rights ]] || all_done
}

# CASE PATTERN COMMAND...: what it, or a trial of it, comes to say, once; then the command ends as its user asks.
names() {
  local file=$out/$1.stderr pattern=$2 tries=0 run=''
  shift 2
  trap '[ -z "$run" ] || kill "$run" 2>/dev/null || true' EXIT
  "$@" >"$file.stdout" 2>"$file" <"${input:-/dev/null}" &
  run=$!
  file=${log:-$file}
  until grep -Eq "$pattern" "$file" 2>/dev/null; do
    [ -e "/proc/$run" ] || fail "'$*' has ended: $(cat "$file")"
    ((++tries < 1500)) || fail "'$*' does not say '$pattern': $(cat "$file")"
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
input=$out/never goes names input "${stood}cat waits for input at descriptor 0 \(a pipe\)$asks" \
  "$tcsim" exec -- cat
goes names lock "${stood}python3 waits for a lock or a condition that no thread gives it$asks" \
  "${unprivileged[@]}" "$tcsim" exec -- python3 -c 'import threading; l = threading.Lock(); l.acquire(); l.acquire()'
goes names child "${stood}sh waits for a signal, such as that of a child's end; [a-z]+ \(pid [0-9]+\) is stopped by a signal" \
  "${unprivileged[@]}" "$tcsim" exec -- sh -c 'sleep 5 & kill -STOP $!; wait'
goes names left '^tcsim: sh has ended; the run goes on for the background processes that it has left: dash \(pid [0-9]+\).*; Ctrl-C' \
  "${unprivileged[@]}" "$tcsim" exec -- sh -c 'while :; do sleep 1000; done & sleep 3'

cat >"$out/shares.c" <<'C'
#define _GNU_SOURCE
#include <sched.h>
#include <signal.h>
#include <sys/wait.h>
static char stack[65536];
static int Compute(void* none) {
  for (;;) __asm__ volatile("" ::: "memory");
}
int main(void) {  /* a child that has the memory of its parent, and is no thread */
  clone(Compute, stack + sizeof stack, CLONE_VM | SIGCHLD, 0);
  return wait(0) > 0;
}
C
cc -o "$out/shares" "$out/shares.c"
goes names clone '^tcsim: virtual time has .* it waits for threads or processes that tcs does not manage: shares \(pid' \
  "${unprivileged[@]}" "$tcsim" exec -- "$out/shares"

# A call that only the kernel knows the end of (no world goes on meanwhile).
printf '%s\n' 'duration: 3600s' "robots: {r: {clients: {held: {command: [cat, '$out/late']}}}}" \
  >"$out/held.yaml"
held="${stood}r/held is in system call [0-9]+, whose end only the kernel knows$asks"
goes names run "$held" "${unprivileged[@]}" "$tcsim" run "$out/held.yaml" --out "$out/run"
log=$out/trials/seed-0001/tcsim.log goes names trials "$held" \
  "${unprivileged[@]}" "$tcsim" trials "$out/held.yaml" --trials 1 --jobs 1 --out "$out/trials"

# Nothing to say.
input_comes() {
  # Others may have all processors at real-time priority, and for so long no input would come. Nor is it read so long: for
  # 4.5 s nothing is said of that.
  on_time bash -c 'for i in {1..12}; do sleep 0.5; echo "$i"; done' |
    "${unprivileged[@]}" "$tcsim" exec -- cat >"$out/comes.stdout" 2>"$out/comes.stderr"
  [[ $(wc -l <"$out/comes.stdout") == 12 ]] || fail "of what is read: $(cat "$out/comes.stdout")"
  ! grep -q 'stood still' "$out/comes.stderr" || fail "input that comes: $(cat "$out/comes.stderr")"
}
at_a_terminal() {
  (sleep 8; echo end) | script -qefc "'$tcsim' exec -- head -n 1" /dev/null >"$out/terminal" 2>&1
  ! grep -q 'stood still' "$out/terminal" || fail "at a terminal: $(cat "$out/terminal")"
}
goes input_comes
goes at_a_terminal
all_done
