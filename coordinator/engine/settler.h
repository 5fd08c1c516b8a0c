// The settlement after a turn: whether its thread may have done what it says, and what the thread
// is charged.
#pragma once

#include "coordinator/engine/engine_part.h"
#include "coordinator/tasks/task.h"
#include "shm/clock_page.h"

namespace tcs {

class Settler : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // The thread has stopped: the charge, the new progress of its virtual CPU, credit or debt. A
  // process that has written what it cannot have done is ended.
  void Settle(Task& task);
  // False if the thread cannot have done what it has noted: the thread's process is ended for that.
  bool TakeNotesOf(Task& task);
  // Takes out time that the host's clock shows as the thread's, and that the host gave to others.
  void TakeOutUnaccounted(Task& task, const shm::ClockReading& before, HostDuration asked);
};

}  // namespace tcs
