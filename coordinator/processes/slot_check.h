// Impossible values in the memory that a process shares with the coordinator: a stray pointer wrote
// there, or the program means harm (protocol_violations.h). The coordinator uses nothing that it
// reads there before this class has checked it.
//
// Reads the slots of threads that have registered and are stopped; writes nothing, makes no system
// call. The sentences stand in the brackets of "has written an impossible value … (". Times are
// virtual nanoseconds.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "coordinator/tasks/task.h"
#include "shm/layout.h"

namespace tcs {

class SlotCheck {
 public:
  // `run_ns` says how much real time has passed since the run began, up to where the coordinator
  // last woke.
  SlotCheck(bool is_fixed, std::function<std::int64_t()> run_ns)
      : is_fixed_(is_fixed), run_ns_(std::move(run_ns)) {}

  // Checks the clock of a thread that has just been stopped, by a copy of its page; null if all is
  // well.
  const char* WhatIsImpossible(const Task& task, const shm::ClockPage& page) const;
  // Checks a thread's notification.
  static const char* WhatIsImpossible(const shm::Notification& note);

  // The time that was stolen from the thread, if that can be true; else 0.
  std::int64_t StolenOf(const Task& task) const;
  // The age of the oldest state that the thread was given, if that can be true; else 0.
  static std::int64_t StalenessOf(const Task& task);

 private:
  const bool is_fixed_;
  std::function<std::int64_t()> run_ns_;
};

}  // namespace tcs
