// The threads of <threads.h>, and what is done once.
#include <pthread.h>
#include <threads.h>

#include <atomic>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr std::int64_t kDelay = 40 * kMs;
mtx_t g_mutex;
cnd_t g_condition;
bool g_flag = false;
once_flag g_once = ONCE_FLAG_INIT;
pthread_once_t g_pthread_once = PTHREAD_ONCE_INIT;
int g_made = 0;
std::atomic<bool> g_began{false};

void ExpectPassed(std::int64_t start, std::int64_t wanted, const char* what) {
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= wanted, "%s took %lld ns, which is early", what, (long long)passed);
  if (g_mode != Mode::kNative) {
    EXPECT(passed < wanted + (g_mode == Mode::kFixed ? 1 : 10) * kMs, "%s took %lld ns", what,
           (long long)passed);
  }
}

void MakeSlowly() {
  g_began = true;
  usleep(kDelay / 1000);
  ++g_made;
}

// A thread runs `during`, and once that has begun the caller is in `wait`.
void Meanwhile(const char* what, std::int64_t wanted, thrd_start_t during, void (*wait)()) {
  const std::int64_t start = Now();
  g_began = false;
  thrd_t thread;
  EXPECT(thrd_create(&thread, during, nullptr) == thrd_success, "thrd_create");
  while (!g_began) usleep(100);
  wait();
  ExpectPassed(start, wanted, what);
  EXPECT(thrd_join(thread, nullptr) == thrd_success, "thrd_join");
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  mtx_init(&g_mutex, mtx_plain);
  cnd_init(&g_condition);
  Meanwhile(
      "cnd_wait", kDelay,
      [](void*) {
        g_began = true;
        usleep(kDelay / 1000);
        mtx_lock(&g_mutex);
        g_flag = true;
        mtx_unlock(&g_mutex);
        return cnd_signal(&g_condition);
      },
      [] {
        mtx_lock(&g_mutex);
        while (!g_flag) cnd_wait(&g_condition, &g_mutex);
        mtx_unlock(&g_mutex);
      });
  Meanwhile(
      "mtx_lock", kDelay,
      [](void*) {
        mtx_lock(&g_mutex);
        g_began = true;
        usleep(kDelay / 1000);
        return mtx_unlock(&g_mutex);
      },
      [] {
        mtx_lock(&g_mutex);
        mtx_unlock(&g_mutex);
      });
  Meanwhile(
      "call_once", kDelay,
      [](void*) {
        call_once(&g_once, MakeSlowly);
        return 0;
      },
      [] { call_once(&g_once, MakeSlowly); });
  Meanwhile(
      "pthread_once", kDelay, [](void*) { return pthread_once(&g_pthread_once, MakeSlowly); },
      [] { pthread_once(&g_pthread_once, MakeSlowly); });
  EXPECT(g_made == 2, "made %d times", g_made);
}
