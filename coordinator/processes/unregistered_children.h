// Children that share their parents' memory without being threads, as a leak checker's that stops
// its parent; and children whose creation was missed. Such children do not register. The parent
// learns of their end, and virtual time waits while they run.
//
// For the coordinator's thread only. Reads /proc, and has the reactor watch for their ends
// (Tag::kUnregisteredChild, with their numbers).
#pragma once

#include <sys/types.h>

#include <map>
#include <set>

#include "coordinator/port/unique_fd.h"
#include "coordinator/processes/unregistered_threads.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/task_table.h"

namespace tcs {

class UnregisteredChildren {
 public:
  // A child that was not announced and has not registered, perhaps never will.
  struct Child {
    pid_t parent = 0;
    UniqueFd pidfd;
  };

  UnregisteredChildren(TaskTable& table, Reactor& reactor, const UnregisteredThreads& unregistered)
      : table_(table), reactor_(reactor), unregistered_(unregistered) {}

  // When a thread of the parent comes to wait for its children.
  void LookFor(const Process& parent);
  // A child has ended. Returns the child's parent, which is to be told; null if no parent lives.
  Process* Ended(pid_t pid);
  // The parent has yielded again and again: perhaps it waits for a process that shares its memory
  // and never registers (a sanitizer's that looks for leaks). If such a process runs it gets a
  // little real time, and true is returned.
  bool LetRunBeside(const Process& parent);

  bool AreOf(const Process& parent) const;
  // Whether there are children whose end virtual time waits for.
  bool AnyCounts() const;
  // Whether virtual time waits since such a child is at work.
  bool AnyRuns() const;

  // The living, by their numbers.
  const std::map<pid_t, Child>& living() const { return living_; }

 private:
  TaskTable& table_;
  Reactor& reactor_;
  const UnregisteredThreads& unregistered_;
  std::map<pid_t, Child> living_;
  std::set<pid_t> untaken_;  // children that have ended, and were not waited for yet
};

}  // namespace tcs
