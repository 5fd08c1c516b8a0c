// The ends of threads: what their destructors wait for takes virtual time, they can be cancelled
// where they wait, the main thread may end before others, and an exec ends them all.
#include <pthread.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <atomic>

#include "tests/conformance/conformance.h"
#include "tests/conformance/natively_until.h"

namespace {

using namespace conformance;

pthread_key_t g_key;
std::int64_t g_destroyed_ns, g_cleaned_ns;

struct Local {
  ~Local() { usleep(20'000); }
  void Touch() {}
};
thread_local Local t_local;

void DestructorsTakeTime() {
  EXPECT(pthread_key_create(&g_key,
                            [](void*) {
                              usleep(30'000);
                              g_destroyed_ns = Now();
                            }) == 0,
         "key");
  const std::int64_t start = Now();
  pthread_t thread;
  pthread_create(
      &thread, nullptr,
      [](void* value) -> void* {
        t_local.Touch();
        pthread_setspecific(g_key, value);
        usleep(10'000);
        pthread_exit(value);
      },
      &g_key);
  void* result = nullptr;
  EXPECT(pthread_join(thread, &result) == 0 && result == &g_key, "join");
  EXPECT(g_destroyed_ns - start >= 60 * kMs, "destructors took %lld ns",
         (long long)(g_destroyed_ns - start));
  EXPECT(Now() >= g_destroyed_ns, "joined before its end");
  const std::int64_t most = (g_mode == Mode::kFixed ? 65 : 80) * kMs;
  if (g_mode != Mode::kNative) EXPECT(Now() - start < most, "joined late");
}

// A thread waits in `wait` for what never comes, and is cancelled after 40 ms.
template <class Wait>
void Cancelled(const char* what, Wait wait) {
  struct Arguments {
    Wait* wait;
    std::int64_t start;
  } arguments{&wait, Now()};
  pthread_t thread;
  pthread_create(
      &thread, nullptr,
      [](void* raw) -> void* {
        pthread_cleanup_push([](void*) { g_cleaned_ns = Now(); }, nullptr);
        (*static_cast<Arguments*>(raw)->wait)();
        pthread_cleanup_pop(0);
        return nullptr;
      },
      &arguments);
  usleep(40'000);
  EXPECT(pthread_cancel(thread) == 0, "cancel");
  void* result = nullptr;
  pthread_join(thread, &result);
  EXPECT(result == PTHREAD_CANCELED, "%s was not cancelled", what);
  const std::int64_t after = g_cleaned_ns - arguments.start;
  EXPECT(after >= 40 * kMs, "%s: cleaned up %lld ns after its start", what, (long long)after);
  const std::int64_t most = (g_mode == Mode::kFixed ? 45 : 60) * kMs;
  if (g_mode != Mode::kNative) EXPECT(after < most, "%s: %lld ns", what, (long long)after);
}

void WaitsAreCancelled() {
  int ends[2];
  EXPECT(socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0, "socketpair");
  Cancelled("sleep", [] { sleep(1000); });
  Cancelled("read", [&] {
    char byte;
    if (read(ends[0], &byte, 1) != 1) Fail("read");
  });
  Cancelled("pause", [] { pause(); });
  Cancelled("a condition", [] {
    static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    static pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
    pthread_mutex_lock(&mutex);
    for (;;) pthread_cond_wait(&condition, &mutex);
  });
  Cancelled("short sleeps", [] {
    for (;;) usleep(1'000);
  });
  close(ends[0]);
  close(ends[1]);
}

int StatusOf(pid_t child) {
  int status = 0;
  EXPECT(waitpid(child, &status, 0) == child, "%s", strerror(errno));
  return status;
}

void MainEndsFirst() {
  const std::int64_t start = Now();
  const pid_t child = fork();
  if (child == 0) {
    pthread_t thread;
    pthread_create(
        &thread, nullptr,
        [](void*) -> void* {
          usleep(50'000);
          _exit(7);
        },
        nullptr);
    pthread_exit(nullptr);
  }
  const int status = StatusOf(child);
  EXPECT(WIFEXITED(status) && WEXITSTATUS(status) == 7, "status %x", status);
  ExpectSoonAfter(start, 50 * kMs, "the end", 10 * kMs + MostOfChildren());
}

// From the main thread, and from another one.
void ExecEndsThem() {
  for (const bool from_main : {true, false}) {
    const std::int64_t start = Now();
    const pid_t child = fork();
    if (child == 0) {
      static bool from_thread;
      from_thread = !from_main;
      pthread_t threads[2];
      for (pthread_t& thread : threads) {
        pthread_create(
            &thread, nullptr,
            [](void* exec) -> void* {
              usleep(10'000);
              if (exec != nullptr && from_thread)
                execl("/bin/sh", "sh", "-c", "sleep 1; exit 5", nullptr);
              sleep(1000);
              return nullptr;
            },
            &thread == &threads[1] ? &thread : nullptr);
      }
      usleep(20'000);
      if (from_main) execl("/bin/sh", "sh", "-c", "sleep 1; exit 5", nullptr);
      pthread_join(threads[0], nullptr);
    }
    const int status = StatusOf(child);
    EXPECT(WIFEXITED(status) && WEXITSTATUS(status) == 5, "status %x", status);
    // What the start of two programs costs is the host's.
    ExpectSoonAfter(start, kSecond, "a shell", (g_mode == Mode::kMeasured ? 500 : 200) * kMs);
  }
}

void EndsWithoutAWord() {
  pthread_t thread;
  static std::atomic<int> done{0};
  pthread_create(
      &thread, nullptr,
      [](void* raw) -> void* {
        usleep(5'000);
        *static_cast<std::atomic<int>*>(raw) = 1;
        syscall(SYS_exit, 0);
        return nullptr;
      },
      &done);
  usleep(20'000);
  NativelyUntil([] { return done == 1; });
  EXPECT(done == 1, "the thread did not run");
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  DestructorsTakeTime();
  WaitsAreCancelled();
  MainEndsFirst();
  ExecEndsThem();
  EndsWithoutAWord();
}
