// The usage of clients, including all processes that they have started, at any depth and whichever
// process waits for them. The usage of a living process is read where it arises; the usage of a
// process that has ended is kept here.
//
// For the coordinator's thread only. Reading one of the kernel's CPU clocks costs a system call.
#pragma once

#include <cstdint>

#include "coordinator/processes/slot_check.h"
#include "coordinator/tasks/task_table.h"
#include "coordinator/tasks/usage.h"

namespace tcs {

class UsageBook {
 public:
  UsageBook(const TaskTable& table, const SlotCheck& check) : table_(table), check_(check) {}

  // The charges of the process's threads, including the threads that have ended.
  static VirtualDuration ChargedTo(const Process& process);
  // With the client's descendants.
  VirtualDuration ChargedToAllOf(const Process& client) const;
  Usage UsageOfAll(const Process& client) const;

  // The thread ends: its usage goes to its process.
  void Keep(Task& ended) const;
  // The process has ended, and its threads' usage has been kept: the process's usage goes to its
  // client.
  static void Keep(Process& ended);

 private:
  Usage UsageOf(const Process& process) const;

  const TaskTable& table_;
  const SlotCheck& check_;
};

}  // namespace tcs
