// A signal comes to a thread that is just about to wake others by a futex, and its handler does not
// restart calls. Such a call never ends with EINTR; glibc would end the program for that. The first
// thread computes while the second one, which is more urgent, sends it signals until it does not
// handle them at once any more. Where only gates keep threads apart, the first one is not kept from
// computing on.
#include <linux/futex.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/syscall.h>

#include <atomic>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr int kRounds = 300, kMostSignals = 2'000, kUnhandled = 15;

std::atomic<int> g_handled{0};
std::atomic<pid_t> g_sender{0};
std::atomic<bool> g_done{false};
std::atomic<std::int64_t> g_computed{0};

// As the C library makes them inside.
long Call(long number, long a, long b, long c) {
  register long fourth asm("r10") = 0;
  register long fifth asm("r8") = 0;
  register long sixth asm("r9") = 0;
  long result;
  asm volatile("syscall"
               : "=a"(result)
               : "a"(number), "D"(a), "S"(b), "d"(c), "r"(fourth), "r"(fifth), "r"(sixth)
               : "rcx", "r11", "memory");
  return result;
}

void* Send(void* argument) {
  const pthread_t first = *static_cast<pthread_t*>(argument);
  sched_param urgent{};
  urgent.sched_priority = 10;
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &urgent);  // may be refused natively
  sigset_t begin;
  sigemptyset(&begin);
  sigaddset(&begin, SIGUSR2);
  pthread_sigmask(SIG_BLOCK, &begin, nullptr);
  g_sender = gettid();
  int signal = 0;
  while (sigwait(&begin, &signal) == 0 && !g_done) {
    int handled = g_handled, unhandled = 0;
    for (int sent = 0; sent < kMostSignals && unhandled < kUnhandled; ++sent) {
      EXPECT(pthread_kill(first, SIGUSR1) == 0, "pthread_kill");
      const int now = g_handled;
      unhandled = now == handled ? unhandled + 1 : 0;
      handled = now;
    }
  }
  return nullptr;
}

void Compute(int steps) {
  for (int i = 0; i < steps; ++i) g_computed.store(i, std::memory_order_relaxed);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  struct sigaction action {};
  action.sa_handler = [](int) { ++g_handled; };
  sigaction(SIGUSR1, &action, nullptr);
  pthread_t self = pthread_self(), sender;
  EXPECT(pthread_create(&sender, nullptr, Send, &self) == 0, "pthread_create");
  while (g_sender == 0) usleep(100);
  unsigned word = 0, seed = 1;
  for (int round = 0; round < kRounds; ++round) {
    // Made raw the call is carried out by the kernel, and the thread computes on from there.
    EXPECT(Call(SYS_tgkill, getpid(), g_sender, SIGUSR2) == 0, "tgkill");
    seed = seed * 1664525u + 1013904223u;
    Compute(static_cast<int>(10'000'000 + (seed >> 8) % 10'000'000));
    for (int call = 0; call < 3; ++call) {
      const long woken = Call(SYS_futex, reinterpret_cast<long>(&word), FUTEX_WAKE_PRIVATE, 1);
      EXPECT(woken == 0, "FUTEX_WAKE in round %d: %ld", round, woken);
    }
  }
  g_done = true;
  EXPECT(Call(SYS_tgkill, getpid(), g_sender, SIGUSR2) == 0, "tgkill");
  EXPECT(pthread_join(sender, nullptr) == 0, "pthread_join");
  EXPECT(g_handled > 0, "no signal was handled");
}
