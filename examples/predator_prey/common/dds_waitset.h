// Waits for several conditions of DDS at once. For one thread.
#pragma once

#include <chrono>

#include "examples/predator_prey/common/dds_entity.h"

namespace predator_prey {

class Waitset {
 public:
  explicit Waitset(const DdsEntity& participant);

  // Ends when `condition` is triggered, and goes on ending while it is.
  void Attach(const DdsEntity& condition);

  void Wait();

  // Waits until `deadline` at the latest.
  void WaitUntil(std::chrono::steady_clock::time_point deadline);

 private:
  void WaitFor(dds_duration_t at_most);

  DdsEntity waitset_;
};

}  // namespace predator_prey
