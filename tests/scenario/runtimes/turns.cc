// Four threads take turns 100 times each, every one a millisecond; then a wait that nobody
// ends: 2.4 s.
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>
#include <vector>
using namespace std::chrono;
int main() {
  std::mutex mutex;
  std::condition_variable changed;
  int turn = 0;
  const auto start = steady_clock::now();
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&, i] {
      for (int k = 0; k < 100; ++k) {
        std::unique_lock<std::mutex> lock(mutex);
        changed.wait(lock, [&] { return turn == i; });
        std::this_thread::sleep_for(milliseconds(1));
        turn = (turn + 1) % 4;
        changed.notify_all();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  std::unique_lock<std::mutex> lock(mutex);
  changed.wait_for(lock, seconds(2));
  printf("%lld\n", static_cast<long long>(nanoseconds(steady_clock::now() - start).count()));
}
