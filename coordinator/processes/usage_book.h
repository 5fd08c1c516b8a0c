// What clients have used, including all processes that they have started, at any depth and
// whichever process waits for them. For a living process it is read where it arises; for one that
// has ended it is kept here.
//
// For the coordinator's thread only. What the kernel's CPU clocks say costs a system call.
#pragma once

#include <cstdint>

#include "coordinator/processes/slot_check.h"
#include "coordinator/tasks/task_table.h"
#include "coordinator/tasks/usage.h"

namespace tcs {

class UsageBook {
 public:
  UsageBook(const TaskTable& table, const SlotCheck& check) : table_(table), check_(check) {}

  // Of its threads, including the threads that have ended.
  static VirtualDuration ChargedTo(const Process& process);
  // With its descendants.
  VirtualDuration ChargedToAllOf(const Process& client) const;
  Usage UsageOfAll(const Process& client) const;

  // The thread ends: what it has had goes to its process.
  void Keep(Task& ended) const;
  // The process has ended, and its threads' has been kept: what it has had goes to its client.
  static void Keep(Process& ended);

 private:
  Usage UsageOf(const Process& process) const;

  const TaskTable& table_;
  const SlotCheck& check_;
};

}  // namespace tcs
