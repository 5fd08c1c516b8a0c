// A signal that comes to a thread which has just been made, and that has not had the processor yet:
// its handler runs at the thread's own turn, what it does costs what it costs, and nobody's clock
// goes back.
#include <pthread.h>
#include <signal.h>

#include <algorithm>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr int kThreads = 100;

volatile sig_atomic_t g_handled = 0;
std::int64_t g_made = 0;  // when the thread was,
std::int64_t g_seen = 0;  // and what its handler saw
int g_made_before = 0;
std::int64_t g_most_ns = 0;  // that a handler took, by its thread's processor clock

void OnSignal(int) {
  const std::int64_t begun = Now(CLOCK_THREAD_CPUTIME_ID);
  EXPECT(Now() >= g_made, "a handler ran %lld ns before its thread was made",
         (long long)(g_made - Now()));
  for (int look = 0; look < 10; ++look) g_seen = Now();
  g_most_ns = std::max(g_most_ns, Now(CLOCK_THREAD_CPUTIME_ID) - begun);
  g_handled = g_handled + 1;
}

// Until it has handled its signal.
void* LiveShortly(void*) {
  for (const int before = g_made_before; g_handled == before;) usleep(1'000);
  return nullptr;
}

}  // namespace

int main(int argc, char** argv) {
  struct sigaction action {};
  action.sa_handler = OnSignal;
  action.sa_flags = SA_RESTART;
  sigaction(SIGUSR1, &action, nullptr);
  Begin(argc, argv);
  const std::int64_t begun = Now(CLOCK_PROCESS_CPUTIME_ID);
  for (int i = 0; i < kThreads; ++i) {
    g_made = Now();
    g_made_before = i;
    pthread_t thread;
    EXPECT(pthread_create(&thread, nullptr, LiveShortly, nullptr) == 0, "a thread cannot be made");
    // Meanwhile it comes as far as it can without a turn.
    for (int work = 0; work < 300'000; ++work) __asm__ volatile("");
    EXPECT(pthread_kill(thread, SIGUSR1) == 0, "a signal cannot be sent");
    pthread_join(thread, nullptr);
    const std::int64_t now = Now();
    EXPECT(g_seen <= now, "a handler ran %lld ns in the future", (long long)(g_seen - now));
    EXPECT(g_handled == i + 1, "%d handlers after %d signals", static_cast<int>(g_handled), i + 1);
  }
  const std::int64_t took = Now(CLOCK_PROCESS_CPUTIME_ID) - begun;
  printf("a handler took %lld us at most, all together %lld us\n", (long long)(g_most_ns / 1000),
         (long long)(took / 1000));
  if (g_mode != Mode::kNative) {
    EXPECT(g_most_ns < 5 * kMs, "a handler took %lld ns", (long long)g_most_ns);
    EXPECT(took < kThreads * kMs, "it computed for %lld ns", (long long)took);
  }
}
