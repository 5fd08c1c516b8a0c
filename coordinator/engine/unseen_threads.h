// Threads that the kernel has in its hands, and threads and processes that run without a place in
// the run.
#pragma once

#include "coordinator/engine/engine_part.h"
#include "coordinator/tasks/event_time.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class UnseenThreads : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // Threads that the kernel holds no longer are ready again.
  void Poll();
  // The kernel no longer holds the thread, which was kUnseen.
  void ComeBack(Task& task, EventTime when);
  // Threads or processes that never registered are at work, or the kernel is about to end a thread:
  // time waits for them.
  bool UnregisteredRun();
};

}  // namespace tcs
