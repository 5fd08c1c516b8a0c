#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$source_root/tests/as_nobody.sh"
# What clients start without the shim, because it is linked statically, sees virtual time and the robot's processor all
# the same. A program of musl's is named.
# Topics: preloading, timers, processes, failures.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
chmod 755 "$work"
for how in static static-pie; do
  c++ -O1 -$how -o "$work/$how" "$source_root/tests/programs/clock_teller.cc"
done
by_vfork='import subprocess, sys; subprocess.run(sys.argv[1:])'
expect_hour() {  # TCSIM EXPECTED [WHAT STANDS BEFORE IT...]
  local accounting how said
  for accounting in measured fixed; do
    for how in static static-pie; do
      said=$(timeout 150 "${@:3}" "$1" exec --accounting $accounting -- sh -c "$work/$how; $work/$how")
      [[ $said == "$2"$'\n'"$2" ]] || fail "$how, $accounting: an hour's sleep, seconds by each clock: $said"
    done
  done
}
expect_of() {  # PROGRAM EXPECTED: by each accounting, with rights and without
  local accounting said
  for accounting in measured fixed; do
    said=$(timeout 150 "$tcsim" exec --accounting $accounting -- sh -c "$work/$1")
    [[ $said == "$2" ]] || fail "$1, $accounting: $said"
    said=$(timeout 150 "${nobody[@]}" "$work/bin/tcsim" exec --accounting $accounting -- sh -c "$work/$1")
    [[ $said == "$2" ]] || fail "$1, $accounting, without rights: $said"
  done
}
hour='3600 3600 3600 on 0'
expect_hour "$tcsim" "$hour"
said=$(timeout 150 "$tcsim" exec -- python3 -c "$by_vfork" "$work/static")
[[ $said == "$hour" ]] || fail "of a vfork's child: $said"
install_for_everybody "$build" "$work"
expect_hour "$work/bin/tcsim" "$hour" "${nobody[@]}"
said=$(timeout 150 "$tcsim" exec --no-patch-vdso -- sh -c "$work/static")
# By real clocks: the host may stand for some seconds meanwhile.
[[ $said == [0-9]' 3600 '[0-9]' on '* || $said == [0-9]' '[0-9]' '[0-9]' on '* ]] || fail "unpatched: $said"

# Whole seconds since then, by the date: time() itself may pass into its next second on the way.
cat >"$work/since.h" <<'C'
#include <time.h>
static struct timespec Now(void) {
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  return now;
}
static long Since(struct timespec begin) {
  const struct timespec now = Now();
  return now.tv_sec - begin.tv_sec - (now.tv_nsec < begin.tv_nsec);
}
C
# Threads of theirs, too; one computes while the other sleeps.
cat >"$work/threads.c" <<'C'
#include <pthread.h>
#include <stdio.h>
#include <unistd.h>
#include "since.h"
static void* Sleep(void* took) {
  const struct timespec begin = Now();
  sleep(1000);
  *(long*)took = Since(begin);
  return NULL;
}
int main(void) {
  long took[2];
  pthread_t threads[2];
  const struct timespec begin = Now();
  for (int i = 0; i < 2; ++i) pthread_create(&threads[i], NULL, Sleep, &took[i]);
  for (volatile long i = 0; i < 20000000; ++i) {
  }
  for (int i = 0; i < 2; ++i) pthread_join(threads[i], NULL);
  printf("%ld %ld %ld\n", took[0], took[1], Since(begin));
}
C
cc -O1 -static -o "$work/threads" "$work/threads.c"
expect_of threads "1000 1000 1000"

# And what they fork.
cat >"$work/forks.c" <<'C'
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>
#include "since.h"
int main(void) {
  const struct timespec begin = Now();
  int status;
  if (fork() == 0) {
    sleep(100);
    _exit((int)Since(begin));
  }
  wait(&status);
  printf("%d %ld\n", WEXITSTATUS(status), Since(begin));
}
C
cc -O1 -static -o "$work/forks" "$work/forks.c"
expect_of forks "100 100"

# The name of its loader tells.
cp /lib64/ld-linux-x86-64.so.2 "$work/ld-musl-x86_64.so.1"
c++ -o "$work/of_musl" "$source_root/tests/programs/clock_teller.cc" -Wl,--dynamic-linker="$work/ld-musl-x86_64.so.1"
timeout 150 "$tcsim" exec -- sh -c "$work/of_musl; true" >/dev/null 2>"$work/said"
grep -q "^tcsim: warning: $work/of_musl is linked against musl, .*rebuild it" "$work/said" || fail "of musl: $(cat "$work/said")"
