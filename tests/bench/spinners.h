// Competitors for the processor: ordinary processes that do nothing but use it.
#pragma once

#include <sys/types.h>

#include <vector>

namespace tcs::bench {

// They run on the caller's CPUs from construction to destruction. Whatever becomes of their owner
// they end: with its thread, and after two minutes of their own.
class Spinners {
 public:
  explicit Spinners(int count);
  ~Spinners();
  Spinners(const Spinners&) = delete;
  Spinners& operator=(const Spinners&) = delete;

  bool complete() const { return complete_; }

 private:
  std::vector<pid_t> pids_;
  bool complete_ = true;
};

}  // namespace tcs::bench
