// thrd_create: the C library's own makes its threads where the shim does not see it.
#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <threads.h>

#include <cstdint>

#include "libtcs_preload/guest.h"

namespace {

struct Start {
  thrd_start_t routine;
  void* argument;
};

// thrd_join takes the result from where pthread_join leaves it.
void* Run(void* raw) {
  const Start start = *static_cast<Start*>(raw);
  free(raw);
  return reinterpret_cast<void*>(static_cast<std::intptr_t>(start.routine(start.argument)));
}

}  // namespace

TCS_EXPORT int thrd_create(thrd_t* thread, thrd_start_t routine, void* argument) {
  // As in pthread_create, which allocates too.
  auto* start = static_cast<Start*>(malloc(sizeof(Start)));
  if (start == nullptr) return thrd_nomem;
  *start = Start{routine, argument};
  const int error = pthread_create(thread, nullptr, Run, start);
  if (error == 0) return thrd_success;
  free(start);
  return error == EAGAIN ? thrd_nomem : thrd_error;
}
