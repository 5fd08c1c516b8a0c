// The content of a thread's clock page for its next turn.
#pragma once

#include <cstdint>

#include "coordinator/engine/engine_part.h"
#include "coordinator/host/clock_grant.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class ClockPages : public EnginePart {
 public:
  using EnginePart::EnginePart;

  void Write(Task& task, VirtualTime horizon, VirtualTime idle_until);
  // Writes the answer to the thread's last exchange into its slot.
  static void WriteAnswer(const Task& task);
  // Grants what the thread may do without asking.
  void GrantWhatIsSafe(const VirtualCpu& cpu, ClockGrant& grant) const;

 private:
  std::int64_t ChargedUndispatched(const Task& task) const;
};

}  // namespace tcs
