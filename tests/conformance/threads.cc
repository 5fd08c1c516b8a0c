// Threads that wait for each other: woken when they are, timed out when they should be, never
// early.
#include <pthread.h>
#include <semaphore.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <future>
#include <mutex>
#include <shared_mutex>
#include <thread>
#include <vector>

#include "tests/conformance/conformance.h"

using namespace conformance;
using std::chrono::milliseconds;

namespace {

// What is waited for comes after `wanted`: under tcs within what the threads themselves compute.
void ExpectPassed(std::int64_t start, std::int64_t wanted, const char* what) {
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= wanted, "%s took %lld ns, which is early", what, (long long)passed);
  if (g_mode != Mode::kNative) {
    // Where it is measured, what the making of five threads costs is the host's.
    EXPECT(passed < wanted + (g_mode == Mode::kFixed ? 2 : 15) * kMs, "%s took %lld ns", what,
           (long long)passed);
  }
}

void Conditions() {
  std::mutex mutex;
  std::condition_variable condition;
  bool flag = false;
  const std::int64_t start = Now();
  std::thread sleeper([&] {
    std::this_thread::sleep_for(milliseconds(100));
    const std::lock_guard lock(mutex);
    flag = true;
    condition.notify_one();
  });
  {
    std::unique_lock lock(mutex);
    condition.wait(lock, [&] { return flag; });
  }
  ExpectPassed(start, 100 * kMs, "a condition");
  sleeper.join();

  for (const bool steady : {true, false}) {
    std::unique_lock lock(mutex);
    const std::int64_t before = Now();
    const auto status =
        steady ? condition.wait_until(lock, std::chrono::steady_clock::now() + milliseconds(70))
               : condition.wait_until(lock, std::chrono::system_clock::now() + milliseconds(70));
    EXPECT(status == std::cv_status::timeout, "a condition that nobody notifies");
    ExpectPassed(before, 70 * kMs - 1000, "a condition's timeout");
  }
}

void Locks() {
  std::timed_mutex mutex;
  mutex.lock();
  const std::int64_t start = Now();
  std::thread waiter([&] {
    EXPECT(!mutex.try_lock_for(milliseconds(40)), "a locked mutex was locked");
    ExpectPassed(start, 40 * kMs, "try_lock_for");
    mutex.lock();
    ExpectPassed(start, 90 * kMs, "lock");
    mutex.unlock();
  });
  std::this_thread::sleep_for(milliseconds(90));
  mutex.unlock();
  waiter.join();

  std::shared_timed_mutex shared;
  shared.lock_shared();
  const std::int64_t before = Now();
  EXPECT(!shared.try_lock_for(milliseconds(30)), "a reader did not keep a writer out");
  ExpectPassed(before, 30 * kMs, "a writer's timeout");
  shared.unlock_shared();
}

void Semaphores() {
  sem_t semaphore;
  sem_init(&semaphore, 0, 0);
  std::int64_t start = Now();
  timespec deadline = ToTimespec(Now(CLOCK_REALTIME) + 60 * kMs);
  EXPECT(sem_timedwait(&semaphore, &deadline) == -1 && errno == ETIMEDOUT, "sem_timedwait");
  ExpectPassed(start, 60 * kMs, "sem_timedwait");
  start = Now();
  std::thread poster([&] {
    usleep(50'000);
    sem_post(&semaphore);
  });
  EXPECT(sem_wait(&semaphore) == 0, "sem_wait");
  ExpectPassed(start, 50 * kMs, "sem_wait");
  poster.join();
}

void JoinsAndFutures() {
  const std::int64_t start = Now();
  std::vector<std::thread> threads;
  for (int i = 1; i <= 5; ++i)
    threads.emplace_back([i] { usleep(static_cast<unsigned>(i) * 10'000); });
  for (std::thread& thread : threads) thread.join();
  ExpectPassed(start, 50 * kMs, "joining five threads");

  const std::int64_t before = Now();
  auto future = std::async(std::launch::async, [] {
    std::this_thread::sleep_for(milliseconds(80));
    return 7;
  });
  EXPECT(future.wait_for(milliseconds(30)) == std::future_status::timeout, "a future came early");
  ExpectPassed(before, 30 * kMs, "a future's timeout");
  EXPECT(future.get() == 7, "a future's value");
  ExpectPassed(before, 80 * kMs, "a future");
}

void AtomicsAndBarriers() {
  std::atomic<int> value{0};
  const std::int64_t start = Now();
  std::thread setter([&] {
    usleep(40'000);
    value = 1;
    value.notify_all();
  });
  value.wait(0);
  ExpectPassed(start, 40 * kMs, "std::atomic::wait");
  setter.join();

  pthread_barrier_t barrier;
  pthread_barrier_init(&barrier, nullptr, 3);
  const std::int64_t before = Now();
  std::vector<std::thread> threads;
  for (int i = 1; i <= 2; ++i) {
    threads.emplace_back([&, i] {
      usleep(static_cast<unsigned>(i) * 30'000);
      pthread_barrier_wait(&barrier);
    });
  }
  pthread_barrier_wait(&barrier);
  ExpectPassed(before, 60 * kMs, "a barrier");
  for (std::thread& thread : threads) thread.join();
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  Conditions();
  Locks();
  Semaphores();
  JoinsAndFutures();
  AtomicsAndBarriers();
}
