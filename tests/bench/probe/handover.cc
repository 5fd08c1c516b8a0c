#include "tests/bench/probe/handover.h"

#include <pthread.h>
#include <sched.h>

#include "tests/bench/probe/batches.h"

namespace tcs::bench {

namespace {

constexpr int kHandoverPriority = 12;

struct Turns {
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_cond_t changed = PTHREAD_COND_INITIALIZER;
  int whose = 0;  // 0: the measuring thread's, 1: the other one's, 2: over

  void Wait(int mine) {
    while (whose == 1 - mine) pthread_cond_wait(&changed, &mutex);
  }
  void GiveTo(int next) {
    whose = next;
    pthread_cond_signal(&changed);
  }
};

void* GiveBack(void* raw) {
  auto& turns = *static_cast<Turns*>(raw);
  pthread_mutex_lock(&turns.mutex);
  for (;;) {
    turns.Wait(1);
    if (turns.whose == 2) break;
    turns.GiveTo(0);
  }
  pthread_mutex_unlock(&turns.mutex);
  return nullptr;
}

}  // namespace

double HandoverTicks() {
  const sched_param param{kHandoverPriority};
  if (sched_setscheduler(0, SCHED_FIFO, &param) != 0) return -1;
  Turns turns;
  pthread_t other;
  if (pthread_create(&other, nullptr, GiveBack, &turns) != 0) return -1;
  pthread_mutex_lock(&turns.mutex);
  const double there_and_back = TicksPerCall({100, 50}, [&] {
    turns.GiveTo(1);
    turns.Wait(0);
  });
  turns.GiveTo(2);
  pthread_mutex_unlock(&turns.mutex);
  pthread_join(other, nullptr);
  return there_and_back / 2;
}

}  // namespace tcs::bench
