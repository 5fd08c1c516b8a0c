// ending_threads ROUNDS: so many times four threads compute, each some ms longer than the one
// before, and end without a call of theirs; they are joined in that order. Prints how many rounds
// there were.
#include <cstdio>
#include <cstdlib>
#include <thread>

namespace {

void Work(int millions) {
  volatile int sum = 0;
  for (int i = 0; i < millions * 1'000'000; ++i) sum = sum + i;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const int rounds = atoi(argv[1]);
  for (int round = 0; round < rounds; ++round) {
    std::thread threads[4];
    for (int i = 0; i < 4; ++i) threads[i] = std::thread(Work, 4 * (i + 1));
    for (std::thread& thread : threads) thread.join();
  }
  printf("%d\n", rounds);
}
