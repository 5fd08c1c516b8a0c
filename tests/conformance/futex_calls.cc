// Futexes, as runtimes use them that are not the C library: all operations but those of priority
// inheritance.
#include <linux/futex.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <atomic>
#include <thread>
#include <vector>

#include "tests/conformance/conformance.h"
#include "tests/conformance/natively_until.h"

using namespace conformance;

namespace {

using Word = std::atomic<std::uint32_t>;

long Futex(Word& word, int operation, std::uint32_t value, const timespec* timeout = nullptr,
           Word* other = nullptr, std::uint32_t last = 0) {
  return syscall(SYS_futex, &word, operation, value, timeout, other, last);
}
// Where a timeout stands, some operations take a number.
const timespec* Number(std::uintptr_t n) { return reinterpret_cast<const timespec*>(n); }

void ExpectPassed(std::int64_t start, std::int64_t wanted, const char* what) {
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= wanted, "%s took %lld ns, which is early", what, (long long)passed);
  if (g_mode != Mode::kNative) {
    EXPECT(passed < wanted + (g_mode == Mode::kFixed ? 1 : 10) * kMs, "%s took %lld ns", what,
           (long long)passed);
  }
}

void Timeouts() {
  Word word{5};
  EXPECT(Futex(word, FUTEX_WAIT_PRIVATE, 4) == -1 && errno == EAGAIN, "another value");
  std::int64_t start = Now();
  timespec time = ToTimespec(30 * kMs);
  EXPECT(Futex(word, FUTEX_WAIT_PRIVATE, 5, &time) == -1 && errno == ETIMEDOUT, "a timeout");
  ExpectPassed(start, 30 * kMs, "FUTEX_WAIT");
  for (const int clock : {CLOCK_MONOTONIC, CLOCK_REALTIME}) {
    start = Now();
    time = ToTimespec(Now(clock) + 30 * kMs);
    const int flag = clock == CLOCK_REALTIME ? FUTEX_CLOCK_REALTIME : 0;
    EXPECT(Futex(word, FUTEX_WAIT_BITSET_PRIVATE | flag, 5, &time, nullptr, 1) == -1 &&
               errno == ETIMEDOUT,
           "an absolute timeout");
    ExpectPassed(start, 30 * kMs - kMs * (g_mode == Mode::kNative), "FUTEX_WAIT_BITSET");
  }
}

// Threads that wait for `word` with one bit each, and say when they have been woken.
struct Waiters {
  Word word{0}, other{0};
  Word woken[3]{};
  InOrder arrivals;
  std::vector<std::thread> threads;

  Waiters() {
    for (std::uint32_t i = 0; i < 3; ++i) {
      threads.emplace_back([this, i] {
        arrivals.Comes(static_cast<int>(i));
        EXPECT(Futex(word, FUTEX_WAIT_BITSET_PRIVATE, 0, nullptr, nullptr, 1u << i) == 0,
               "waiter %u: %s", i, strerror(errno));
        woken[i] = 1;
      });
      usleep(20'000);  // in this order
    }
    arrivals.AwaitAll(3);
  }
  ~Waiters() {
    for (std::thread& thread : threads) thread.join();
  }
  std::uint32_t Woken() const { return woken[0] | woken[1] << 1 | woken[2] << 2; }
  // Once they had time to get there; a busy machine takes its own.
  void ExpectWoken(std::uint32_t wanted) const {
    for (int turn = 0; turn < 100 && Woken() != wanted; ++turn) usleep(20'000);
    usleep(20'000);
    EXPECT(Woken() == wanted, "woken: %x", Woken());
  }
};

void Wakes() {
  {
    Waiters w;
    EXPECT(Futex(w.word, FUTEX_WAKE_BITSET_PRIVATE, 9, nullptr, nullptr, 2) == 1, "one bit");
    w.ExpectWoken(2);
    EXPECT(Futex(w.word, FUTEX_WAKE_PRIVATE, 1) == 1, "one of two");
    w.ExpectWoken(3);
    EXPECT(Futex(w.word, FUTEX_WAKE_PRIVATE, 9) == 1, "the last");
    EXPECT(Futex(w.word, FUTEX_WAKE_PRIVATE, 9) == 0, "nobody");
  }
  for (const bool compares : {false, true}) {
    Waiters w;
    const int operation = compares ? FUTEX_CMP_REQUEUE_PRIVATE : FUTEX_REQUEUE_PRIVATE;
    if (compares) {
      EXPECT(Futex(w.word, operation, 1, Number(9), &w.other, 7) == -1 && errno == EAGAIN,
             "another value");
    }
    const long n = Futex(w.word, operation, 1, Number(9), &w.other, 0);
    EXPECT(n == 3, "requeue: %ld", n);
    w.ExpectWoken(1);
    EXPECT(Futex(w.word, FUTEX_WAKE_PRIVATE, 9) == 0, "they wait elsewhere");
    EXPECT(Futex(w.other, FUTEX_WAKE_PRIVATE, 9) == 2, "they do not wait there");
  }
  {
    Waiters w;
    const auto add_5_wake_if_2 =
        static_cast<std::uint32_t>(FUTEX_OP(FUTEX_OP_ADD, 5, FUTEX_OP_CMP_EQ, 2));
    w.other = 1;
    const long n = Futex(w.word, FUTEX_WAKE_OP_PRIVATE, 2, Number(9), &w.other, add_5_wake_if_2);
    EXPECT(n == 2 && w.other == 6, "FUTEX_WAKE_OP: %ld, %u", n, w.other.load());
    EXPECT(Futex(w.word, FUTEX_WAKE_PRIVATE, 9) == 1, "the last");
  }
}

// What is no time, no bit and no address; and a number that happens to be that of a thread that has
// ended, which is no reason not to wait.
void Arguments() {
  Word word{0};
  for (const timespec wrong : {timespec{-1, 0}, timespec{0, -1}, timespec{0, kSecond}}) {
    for (const int operation : {FUTEX_WAIT_PRIVATE, FUTEX_WAIT_BITSET_PRIVATE}) {
      EXPECT(Futex(word, operation, 0, &wrong, nullptr, 1) == -1 && errno == EINVAL, "a timeout");
    }
  }
  EXPECT(Futex(word, FUTEX_WAIT_BITSET_PRIVATE, 0) == -1 && errno == EINVAL, "no bits");
  // What cannot be read: the timeout, the word with and without a timeout.
  const timespec valid{0, 1};
  Word& nowhere = *reinterpret_cast<Word*>(4096);
  EXPECT(Futex(word, FUTEX_WAIT_PRIVATE, 0, Number(4096)) == -1 && errno == EFAULT, "no timeout");
  EXPECT(Futex(nowhere, FUTEX_WAIT_PRIVATE, 0, &valid) == -1 && errno == EFAULT, "no word");
  EXPECT(Futex(nowhere, FUTEX_WAIT_PRIVATE, 0) == -1 && errno == EFAULT, "nothing");
  pthread_t thread;
  const auto routine = [](void* at) -> void* {
    *static_cast<Word*>(at) = static_cast<std::uint32_t>(gettid());
    return nullptr;
  };
  EXPECT(pthread_create(&thread, nullptr, routine, &word) == 0, "pthread_create");
  pthread_join(thread, nullptr);
  const timespec timeout = ToTimespec(20 * kMs);
  const std::int64_t start = Now();
  EXPECT(Futex(word, FUTEX_WAIT_PRIVATE, word, &timeout) == -1 && errno == ETIMEDOUT,
         "a number like a thread's: %s", strerror(errno));
  ExpectSoonAfter(start, 20 * kMs, "giving up");
}

// Between processes, by the memory they share.
void Shared() {
  auto* word = static_cast<Word*>(
      mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  const std::int64_t start = Now();
  const pid_t pid = fork();
  if (pid == 0) {
    usleep(40'000);
    NativelyUntil([] { return Sleeps(getppid()); });
    *word = 1;
    _exit(Futex(*word, FUTEX_WAKE, 9) == 1 ? 0 : 1);
  }
  EXPECT(Futex(*word, FUTEX_WAIT, 0) == 0 && *word == 1, "a shared futex: %s", strerror(errno));
  ExpectSoonAfter(start, 40 * kMs, "a shared futex");
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "the child woke nobody: %x", status);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  Timeouts();
  Wakes();
  Arguments();
  Shared();
}
