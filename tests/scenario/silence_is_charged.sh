#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Under set costs computing without calls costs nothing, until a thread of the client has done it for 5 s, or for the run's patience, which is said once. From
# then on each half a millisecond of it, by the processor's clock, costs exactly that: in other threads and children, too, and
# soon: were each of them to compute for 5 s first, this test would meet its timeouts. So a loop on a timer of processor time ends.
# Topics: accounting, threads, processes, timers.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/computing.c" <<'C'
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
static volatile sig_atomic_t fired;
static volatile int turn, flag;
static void Fire(int number) { fired = number; }
static long Us(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * 1000000 + t.tv_nsec / 1000;
}
static void* SetFlag(void* unused) {
  usleep(30000);
  flag = 1;
  return unused;
}
static void* Return(void* unused) {
  for (int i = 0; i < 10; ++i) {
    while (turn != 1) continue;
    turn = 0;
  }
  return unused;
}
static void UntilTimer(const char* what) {
  fired = 0;
  const struct itimerval in_20_ms = {{0, 0}, {0, 20000}};
  const long begun = Us();
  setitimer(ITIMER_VIRTUAL, &in_20_ms, NULL);
  while (!fired) continue;
  printf("%s %ld\n", what, Us() - begun);
  fflush(stdout);
}
int main(void) {
  signal(SIGVTALRM, Fire);
  UntilTimer("first");
  for (int i = 0; i < 5; ++i) UntilTimer("again");
  const pid_t child = fork();
  if (child == 0) {
    UntilTimer("child");
    _exit(0);
  }
  waitpid(child, NULL, 0);
  pthread_t thread;
  long begun = Us();
  pthread_create(&thread, NULL, SetFlag, NULL);
  while (!flag) continue;
  printf("flag %ld\n", Us() - begun);
  pthread_join(thread, NULL);
  begun = Us();
  pthread_create(&thread, NULL, Return, NULL);
  for (int i = 0; i < 10; ++i) {
    turn = 1;
    while (turn != 0) continue;
  }
  printf("turns %ld\n", Us() - begun);
  pthread_join(thread, NULL);
  // Less than half a millisecond at a time, of which it cannot be known how often it is found.
  begun = Us();
  for (int i = 0; i < 100; ++i) {
    for (volatile int k = 0; k < 1000; ++k) continue;
    Us();
  }
  printf("short %ld\n", Us() - begun);
}
C
cc -O1 -pthread -o "$out/computing" "$out/computing.c"
patience=() after="5 s"
for cores in 1 2; do
  timeout 100 "$tcsim" exec --accounting fixed --cores $cores "${patience[@]}" -- "$out/computing" >"$out/said" 2>"$out/warned" ||
    fail "$cores cores: status $?: $(cat "$out/said" "$out/warned")"
  [[ $(grep -c 'has computed for '"$after"' without a call' "$out/warned") == 1 ]] || fail "$cores cores: $(cat "$out/warned")"
  awk -v cores=$cores '
    # The timer is set by a call, and so is the clock read.
    $1 ~ /first|again|child/ { ok += $2 >= 20000 && $2 < 20600 }
    # The looks of one that computes are half a millisecond apart, the turns of equals a millisecond and a half at most.
    $1 == "flag" { ok += $2 >= 30000 && $2 < 32100 }
    $1 == "turns" { ok += $2 >= 500 && $2 < 10 * 2 * 1600 }
    $1 == "short" { ok += $2 >= 100 && $2 < 1200 }
    END { exit ok != 10 || NR != 10 }' "$out/said" || fail "$cores cores: $(cat "$out/said")"
  patience=(--patience 500ms) after="500 ms"
done
