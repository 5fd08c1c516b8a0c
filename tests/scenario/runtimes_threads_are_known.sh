#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$source_root/tests/as_nobody.sh"
# Threads that runtimes make for themselves, past the shim: ThreadSanitizer's helper (of GCC and of Clang), jemalloc's
# background thread, one that Python makes through a handle of the C library. None hangs, what their programs do takes
# its own time to 1 %, with rights and without; and with set costs it is the same in each of so many runs.
# Topics: threads, determinism, languages, preloading, rights.
rounds=${3:-3}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
chmod 755 "$work"
cd "$work"
install_for_everybody "$build" "$work"
cat >turns.cc <<'CC'
// Four threads take turns 100 times each, every one a millisecond; then a wait that nobody ends: 2.4 s.
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>
#include <vector>
using namespace std::chrono;
int main() {
  std::mutex mutex;
  std::condition_variable changed;
  int turn = 0;
  const auto start = steady_clock::now();
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&, i] {
      for (int k = 0; k < 100; ++k) {
        std::unique_lock<std::mutex> lock(mutex);
        changed.wait(lock, [&] { return turn == i; });
        std::this_thread::sleep_for(milliseconds(1));
        turn = (turn + 1) % 4;
        changed.notify_all();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  std::unique_lock<std::mutex> lock(mutex);
  changed.wait_for(lock, seconds(2));
  printf("%lld\n", static_cast<long long>(nanoseconds(steady_clock::now() - start).count()));
}
CC
cat >purges.c <<'C'
/* Four threads that allocate and free for a second; then memory is left to be purged for a minute: 61 s. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
static void* Work(void* none) {
  const struct timespec pause = {0, 10000000};
  for (int i = 0; i < 100; ++i) {
    char* blocks[64];
    for (int k = 0; k < 64; ++k) memset(blocks[k] = malloc(4096 * (k % 7 + 1)), 1, 4096);
    for (int k = 0; k < 64; ++k) free(blocks[k]);
    nanosleep(&pause, NULL);
  }
  return none;
}
int main(void) {
  struct timespec start, end;
  const struct timespec minute = {60, 0};
  pthread_t threads[4];
  clock_gettime(CLOCK_MONOTONIC, &start);
  for (int i = 0; i < 4; ++i) pthread_create(&threads[i], NULL, Work, NULL);
  for (int i = 0; i < 4; ++i) pthread_join(threads[i], NULL);
  nanosleep(&minute, NULL);
  clock_gettime(CLOCK_MONOTONIC, &end);
  printf("%lld\n", (end.tv_sec - start.tv_sec) * 1000000000LL + end.tv_nsec - start.tv_nsec);
}
C
cat >by_handle.py <<'PY'
# A thread of the C library's own, which sleeps for 0.5 s, and one more in Python's calls: 0.8 s.
import ctypes, time
libc = ctypes.CDLL("libc.so.6")
routine = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p)
class TimeSpec(ctypes.Structure):
    _fields_ = [("seconds", ctypes.c_long), ("nanoseconds", ctypes.c_long)]
def raw(_):
    libc.syscall(35, ctypes.byref(TimeSpec(0, 300000000)), None)
    return 0
def python(_):
    time.sleep(0.5)
    return 0
start = time.monotonic_ns()
for what in routine(raw), routine(python):
    thread = ctypes.c_ulong()
    libc.pthread_create(ctypes.byref(thread), None, what, None)
    libc.pthread_join(thread, None)
print(time.monotonic_ns() - start)
PY
chmod -R a+rX .

expect_ns() {  # WHOSE WANTED_NS SAID
  [[ $3 =~ ^[0-9]+$ ]] || fail "$1 says '$3'"
  (($3 >= $2 && $3 - $2 <= $2 / 100)) || fail "$1: $3 ns, and $2 are right"
}
check() {  # NAME WANTED_NS COMMAND...
  local name=$1 wanted=$2 first='' said i
  shift 2
  expect_ns "$name, measured" "$wanted" "$(timeout 60 "$tcsim" exec -- "$@")"
  for i in measured fixed; do
    said=$(timeout 60 "${nobody[@]}" "$work/bin/tcsim" exec --accounting $i -- "$@" 2>stderr) || fail "$name: $(cat stderr)"
    expect_ns "$name, $i, without rights" "$wanted" "$said"
  done
  for ((i = 0; i < rounds; ++i)); do
    said=$(timeout 60 "$tcsim" exec --accounting fixed -- "$@") || fail "$name, fixed: $said"
    expect_ns "$name, fixed" "$wanted" "$said"
    ((${first:=$said} - said <= apart && said - first <= apart)) || fail "$name: $said, and $first before"
  done
}

# Its maker computes for some microseconds beside the newborn thread, and has Python's lock by then or not.
apart=10000
check "a thread by a handle" 800000000 python3 "$work/by_handle.py"
apart=0
found=0
for compiler in g++ clang++; do
  # What does not run natively (on a kernel that lays memory out in another way) is not to be had here.
  command -v $compiler >/dev/null && $compiler -O1 -fsanitize=thread -o $compiler.turns turns.cc 2>/dev/null || continue
  timeout 60 ./$compiler.turns >/dev/null 2>&1 || continue
  check "ThreadSanitizer of $compiler" 2400000000 "$work/$compiler.turns"
  found=1
done
((found)) || echo "no compiler here has a ThreadSanitizer that runs"
jemalloc=$(library 'libjemalloc.so.2 .*x86-64')
if [[ -n $jemalloc ]]; then
  cc -O1 -o purges purges.c
  check jemalloc 61000000000 env MALLOC_CONF=background_thread:true LD_PRELOAD="$jemalloc" "$work/purges"
fi
