// Threads that go on because a signal is there for them. The kernel delivers signals; but a thread
// that waits runs its handler only when it is dispatched, and that is to be at the sender's virtual
// time. A wait for the signal itself ends at that time, too.
//
// For the coordinator's thread only.
#pragma once

#include <optional>
#include <utility>

#include "coordinator/calls/sent_signal.h"
#include "coordinator/host/active_threads.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/processes/undispatched_threads.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class SignalWakes {
 public:
  SignalWakes(RunState& run, Waker& waker, ActiveThreads& active, UndispatchedThreads& undispatched)
      : run_(run), waker_(waker), active_(active), undispatched_(undispatched) {}

  // True if the thread waits for a signal that is pending: then it goes on.
  bool EndAwait(Task& task, const SignalSets& sets, EventTime when);
  // The kernel has chosen the thread that handles a signal for the whole process, and has woken it.
  // A thread that sleeps on goes on waiting, whatever is pending.
  void WakeForSignals(Process& process, EventTime when);
  // The same for one signal of which its sender tells. A signal with a handler reaches one thread:
  // other threads are not asked.
  void WakeForSignal(Process& process, const SentSignal& sent, EventTime when);
  // Without levels the kernel keeps a signal from a thread whose call is trapped (os/trap.cc), so
  // only a look finds a signal that came from outside. The sender tells of a signal from inside.
  bool HasSignalForTrapped(Task& task) const;
  // When the threads of a process were looked at last; none if no threads were since this was
  // asked. A thread that was found without a signal may have begun to handle it.
  std::optional<EventTime> TakeLook() { return std::exchange(looked_at_, std::nullopt); }

 private:
  void HoldUntilDispatched(Task& task);
  // Of signals for the whole process the thread takes none of `taken`. Adds those that the thread
  // takes.
  void WakeFor(Task& task, const SignalSets& sets, std::uint64_t* taken, EventTime when);
  void AnswerAhead(Task& task);

  RunState& run_;
  Waker& waker_;
  ActiveThreads& active_;
  UndispatchedThreads& undispatched_;
  std::optional<EventTime> looked_at_;
};

}  // namespace tcs
