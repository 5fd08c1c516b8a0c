#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# gdb and strace inside a run end with a sentence that says what works; and tcsim run --gdb opens a client in gdb, for
# which virtual time stands still.
# Topics: debuggers.
type gdb strace cc >/dev/null 2>&1 || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
for tracer in 'strace true' 'gdb -q -batch -ex run true'; do
  timeout 200 "$tcsim" exec -- $tracer >said 2>&1 </dev/null || (($? != 124)) || fail "$tracer hangs inside"
  grep -q 'cannot work inside a run' said || fail "$tracer is told nothing: $(cat said)"
done

cat >ticks.c <<'END'
#include <stdio.h>
#include <time.h>
volatile long ticks;
static long Now(void) { struct timespec t; clock_gettime(CLOCK_MONOTONIC, &t); return t.tv_sec * 1000000000L + t.tv_nsec; }
void tick(long now) { ++ticks; printf("%ld %ld\n", ticks, now); fflush(stdout); }
int main(void) {
  for (int i = 0; i < 5; ++i) {
    struct timespec ms = {0, 10000000};
    nanosleep(&ms, NULL);
    tick(Now());
  }
  return 0;
}
END
cc -g -O0 ticks.c -o ticks
cat >s.yaml <<'END'
duration: 1s
dynamics: {}
bodies: {b: {mass: 1, inertia: [1, 1, 1], linear_velocity: [1, 0, 0]}}
robots:
  r: {clients: {ticks: {command: [./ticks], body: b}}}
  other: {clients: {sleeper: {command: [sh, -c, "sleep 0.2; date +%N"]}}}
END
"$tcsim" run --accounting fixed --out without s.yaml >/dev/null || fail "it does not run without gdb"
# gdb stops it before its beginning, and at each tick for some real time.
{
  echo 'break tick'
  echo 'continue'
  for ((i = 0; i < 5; ++i)); do echo 'shell sleep 0.1'; echo 'print ticks'; echo 'continue'; done
} >commands
timeout 200 "$tcsim" run --accounting fixed --gdb r/ticks --out with s.yaml <commands >said 2>&1 ||
  fail "it does not run in gdb ($?): $(tail -n 20 said)"
(($(grep -c '^Breakpoint 1, \|hit Breakpoint 1, ' said) == 5)) || fail "gdb did not stop five times: $(cat said)"
grep -q '\$5 = 4' said || fail "gdb did not see the program's memory: $(cat said)"
# Nobody has noticed: neither the program nor the world.
for file in r-ticks.out.log other-sleeper.out.log bodies.csv; do
  cmp "without/$file" "with/$file" || fail "$file is another one in gdb"
done
! "$tcsim" run --gdb r/tick s.yaml 2>said || fail "a client that is not there is debugged"
grep -q "did you mean 'r/ticks'" said || fail "it says instead: $(cat said)"
