// What a process can write into the memory that it shares with the coordinator, and cannot mean:
// then a pointer has gone astray there, or the program means harm (expulsion.h). Nothing that the
// coordinator reads there is believed before it was looked at here.
//
// Reads the slots of threads that have registered and are stopped; writes nothing, makes no system
// call. Sentences go on after "has written what cannot be (". Times are virtual nanoseconds.
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

  // Of the clock of a thread that has just been stopped; null if all is well.
  const char* WhatIsImpossible(const Task& task) const;
  // Of what a thread notifies.
  static const char* WhatIsImpossible(const shm::Notification& note);

  // What was stolen from it, as far as that can be true; else 0.
  std::int64_t StolenOf(const Task& task) const;
  // How old the oldest state was that it was given, as far as that can be true; else 0.
  static std::int64_t StalenessOf(const Task& task);

 private:
  const bool is_fixed_;
  std::function<std::int64_t()> run_ns_;
};

}  // namespace tcs
