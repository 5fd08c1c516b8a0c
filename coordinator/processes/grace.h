// The end of a run for the clients that still live. Each client gets a signal, and a grace of
// virtual time in which it may write what it has and exit; then it is killed. The results stand
// already: the world has stopped, and nothing of this is recorded. The engine's loop goes on
// meanwhile, from one client's kill to the next one's:
//
//   Begin()                    all clients get their signals
//   while GoOnToNextKill()     the end of the loop is now then
//     the loop, until that end, or IsOver()
//     KillOverdue()            the end of clients that the kernel has in its hands is waited for
//   WarnOfThoseLeft()
//
// For the coordinator's thread only. Times are virtual nanoseconds where not said otherwise; in
// real time the grace is bounded, too (Tag::kGraceRanOut).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "coordinator/port/unique_fd.h"
#include "coordinator/processes/unregistered_children.h"
#include "coordinator/tasks/event_time.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class Grace {
 public:
  // `signalled` is called when signals have been sent, to any process.
  Grace(RunState& run, Reactor& reactor, const UnregisteredChildren& unregistered_children,
        std::function<void(EventTime)> signalled)
      : run_(run),
        reactor_(reactor),
        unregistered_children_(unregistered_children),
        signalled_(std::move(signalled)) {}

  // RunState::grace_began is set.
  void Begin();
  // Sets the run's end to when the next client is to be killed. False if there is none: all clients
  // have ended, or have been killed, or the grace is over.
  bool GoOnToNextKill();
  // A process that the kernel has in its hands gets its grace in real time, too, as virtual time
  // goes on without it: true if such a process is waited for.
  bool KillOverdue();
  void WarnOfThoseLeft();

  // No real time is left; or the user insists.
  void RanOut();
  bool IsOver() const { return ran_out_ || run_.stop.insists(); }

 private:
  void GrantDebtOf(const Process& process);
  VirtualDuration LeftInRealTime(const Process& process) const;
  void LimitRealTime();
  int StopSignalOf(const Process& process) const;
  VirtualTime KillTimeOf(const Process& process) const;
  void WarnOfKill(const Process& process, const std::string& within);

  RunState& run_;
  Reactor& reactor_;
  const UnregisteredChildren& unregistered_children_;
  std::function<void(EventTime)> signalled_;
  UniqueFd timer_;  // of real time
  HostTime began_;
  std::map<pid_t, VirtualTime> kill_times_;  // of processes that got more than their grace
  bool ran_out_ = false;
};

}  // namespace tcs
