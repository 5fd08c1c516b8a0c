// Thread-specific data: a program has as many keys as POSIX promises it, and a thread's destructors
// do what they do in virtual time, to the last round.
#include <limits.h>
#include <pthread.h>
#include <sys/wait.h>

#include <vector>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr std::int64_t kRoundNs = 10 * kMs;
std::vector<pthread_key_t> g_keys;
int g_rounds = 0;

// Sleeps in each of the rounds that the C library gives it.
void SleepAgain(void* value) {
  const std::int64_t start = Now();
  usleep(kRoundNs / 1000);
  EXPECT(Now() - start >= kRoundNs, "a destructor's sleep");
  if (++g_rounds < PTHREAD_DESTRUCTOR_ITERATIONS) {
    EXPECT(pthread_setspecific(g_keys.back(), value) == 0, "pthread_setspecific");
  }
}

void MakeAll() {
  pthread_key_t key;
  int error;
  // The last one first: its destructor runs after all others.
  while ((error = pthread_key_create(&key, SleepAgain)) == 0) g_keys.push_back(key);
  EXPECT(error == EAGAIN, "pthread_key_create: %d", error);
  EXPECT(g_keys.size() == PTHREAD_KEYS_MAX, "%zu keys", g_keys.size());
}

void* UseAll(void*) {
  for (const pthread_key_t key : g_keys) {
    EXPECT(pthread_getspecific(key) == nullptr, "key %u is somebody else's", key);
  }
  EXPECT(pthread_setspecific(g_keys.back(), &g_rounds) == 0, "pthread_setspecific");
  return nullptr;
}

// A thread's end is seen at its virtual time, by whoever joins it, however it goes.
void EndsAreSeen(void (*end)()) {
  g_rounds = 0;
  const std::int64_t start = Now();
  pthread_t thread;
  EXPECT(pthread_create(
             &thread, nullptr,
             [](void* raw) -> void* {
               UseAll(nullptr);
               reinterpret_cast<void (*)()>(raw)();
               return nullptr;
             },
             reinterpret_cast<void*>(end)) == 0,
         "pthread_create");
  EXPECT(pthread_join(thread, nullptr) == 0, "pthread_join");
  const std::int64_t passed = Now() - start, wanted = PTHREAD_DESTRUCTOR_ITERATIONS * kRoundNs;
  EXPECT(g_rounds == PTHREAD_DESTRUCTOR_ITERATIONS, "%d rounds", g_rounds);
  EXPECT(passed >= wanted, "joined after %lld ns", (long long)passed);
  if (g_mode != Mode::kNative) {
    EXPECT(passed < wanted + 5 * kMs, "joined after %lld ns", (long long)passed);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  MakeAll();
  EndsAreSeen([] {});
  EndsAreSeen([] { pthread_exit(nullptr); });
  EndsAreSeen([] {
    pthread_cancel(pthread_self());
    pthread_testcancel();
  });
}
