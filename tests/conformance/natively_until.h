// What orders processes natively. Under tcs who sleeps for 5 ms is there before who sleeps for 10:
// that is what is tested. On a loaded host it is not so, and the kernel has to be asked.
#pragma once

#include <stdio.h>
#include <string.h>
#include <sys/wait.h>

#include <atomic>

#include "tests/conformance/conformance.h"

namespace conformance {

// Natively comes back once `holds()`, however long that takes; under tcs at once.
template <class Condition>
void NativelyUntil(Condition holds) {
  while (g_mode == Mode::kNative && !holds()) usleep(1'000);
}

// Natively all parts run at once, each in a process of its own, because they mostly wait; under
// tcs, where waiting takes no real time, one after the other.
template <class Parts, class Run>
void ForEachAtOnceNatively(const Parts& parts, Run run) {
  int children = 0, failed = 0, status = 0;
  for (const auto& part : parts) {
    if (g_mode != Mode::kNative) {
      run(part);
      continue;
    }
    const pid_t child = fork();
    EXPECT(child >= 0, "fork: %s", strerror(errno));
    if (child == 0) {
      run(part);
      _exit(0);
    }
    ++children;
  }
  for (; children > 0; --children) failed += wait(&status) < 0 || status != 0;
  EXPECT(failed == 0, "%d parts failed", failed);
}

// True if the thread, of any process, sleeps in the kernel until something wakes it.
inline bool Sleeps(pid_t tid) {
  char path[32], line[256];
  snprintf(path, sizeof path, "/proc/%d/stat", tid);
  FILE* file = fopen(path, "r");
  if (file == nullptr) return false;
  const char* name_end = fgets(line, sizeof line, file) != nullptr ? strrchr(line, ')') : nullptr;
  fclose(file);
  return name_end != nullptr && strncmp(name_end, ") S", 3) == 0;
}

// Threads that come to their waits one after the other.
struct InOrder {
  static constexpr int kMost = 4;
  std::atomic<pid_t> tids[kMost]{};

  bool Waits(int place) const { return tids[place] != 0 && Sleeps(tids[place]); }
  // Each says it last before it waits.
  void Comes(int place) {
    NativelyUntil([&] { return place == 0 || Waits(place - 1); });
    if (g_mode == Mode::kNative) tids[place] = gettid();
  }
  void AwaitAll(int count) const {
    NativelyUntil([&] { return Waits(count - 1); });
  }
};

}  // namespace conformance
