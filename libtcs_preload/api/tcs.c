/* The shim is preloaded in a run, and has the symbols that are looked up here; outside there are
 * none. Where a process is does not change, so each is looked up once. */
#define _GNU_SOURCE
#include "libtcs_preload/api/tcs.h"

#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <time.h>

enum { kNsPerS = 1000000000 };

typedef void (*Call)(void);

static void Nothing(void) {}

static void Tell(const char* name, _Atomic(Call)* known) {
  const int error = errno;
  Call call = atomic_load_explicit(known, memory_order_relaxed);
  if (call == NULL) {
    *(void**)&call = dlsym(RTLD_DEFAULT, name);
    if (call == NULL) call = Nothing;
    atomic_store_explicit(known, call, memory_order_relaxed);
  }
  call();
  errno = error;
}

int tcs_is_running(void) {
  bool (*runs)(void) = NULL;
  *(void**)&runs = dlsym(RTLD_DEFAULT, "tcs_shim_runs");
  return runs != NULL && runs();
}

int64_t tcs_now(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (int64_t)now.tv_sec * kNsPerS + now.tv_nsec;
}

void tcs_mark(void) {
  static _Atomic(Call) call;
  Tell("tcs_shim_mark", &call);
}

void tcs_read(void) {
  static _Atomic(Call) call;
  Tell("tcs_shim_read", &call);
}

void tcs_write(void) {
  static _Atomic(Call) call;
  Tell("tcs_shim_write", &call);
}

int tcs_idle(int64_t until_ns) {
  if (until_ns <= 0) return 0;
  const struct timespec until = {until_ns / kNsPerS, until_ns % kNsPerS};
  return clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL);
}
