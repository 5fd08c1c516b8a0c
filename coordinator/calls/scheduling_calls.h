// Requests of threads to their robot's scheduler: policies, priorities, cores. Results are the
// kernel's: 0, or negative for an errno.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/calls/priority_inheritance.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"
#include "shm/layout.h"

namespace tcs {

class SchedulingCalls {
 public:
  SchedulingCalls(RunState& run, Waker& waker, PriorityInheritance& inheritance)
      : run_(run), waker_(waker), inheritance_(inheritance) {}

  // kPriority, kPriorityGet and kAffinity; the reply is the asking thread's.
  void Handle(Task& asking, const shm::Notification& note);
  // A thread begins with the scheduling parameters of the thread that made it.
  void Inherit(Task& task, const Task& creator);

  std::int64_t Schedule(const Task& asking, Task& task, const SchedulingParameters& wanted);
  // `policy` may be shm::kKeepPolicy.
  std::int64_t SetPriority(const Task& asking, Task& task, std::int64_t policy,
                           std::int64_t priority);
  // The same for a thread that is none of the robot's: no thread of the run may set its priority.
  static std::int64_t ErrorForStranger(pid_t tid, std::int64_t policy, std::int64_t priority);
  static std::int64_t SetAffinity(const Task& asking, Task& task, std::uint64_t cores);

 private:
  static std::int64_t MaySchedule(const Task& asking, const Task& task,
                                  const SchedulingParameters& wanted);
  static std::int64_t MayPrioritize(const Task& asking, const Task& task, std::int64_t policy,
                                    std::int64_t priority);

  RunState& run_;
  Waker& waker_;
  PriorityInheritance& inheritance_;
};

}  // namespace tcs
