// Running without the right to real-time priorities: nothing but its gate keeps a thread that is
// not dispatched from running. The thread's calls begin at the gate, so that all it can do by
// itself is compute, which its clock does not show. Messages that such threads do get to the
// coordinator are put off until the dispatched thread has come to the end of what it does to
// others. The dispatched thread says so where its next call begins (kCall): until then its clock
// stands at the time of its last call, and what the thread has made ready becomes ready at that
// time, however late the coordinator looks.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "coordinator/engine/engine_part.h"
#include "coordinator/tasks/event_time.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/task.h"
#include "shm/attach_protocol.h"

namespace tcs {

class GateKeeper : public EnginePart {
 public:
  using EnginePart::EnginePart;
  using Late = std::function<PollOutcome(EventTime)>;

  void TurnBegins() { says_call_ = opens_gate_ = false; }
  // The running thread has said that a call begins, and waits for the answer.
  bool says_call() const { return says_call_; }
  // For a notification of the running thread: true if it does not end the thread's turn.
  bool MayGoOn(Task& task);
  // All events of this instant have been handled. If no other thread has to run instead, the
  // running thread goes on with its call.
  PollOutcome EndCall(PollOutcome found);
  // True once, if the running thread is to go on.
  bool TakesOpening() { return std::exchange(opens_gate_, false); }
  void OpenGate(Task& task);
  // A handler makes a system call of its own on top of an exchange that the thread has not slept
  // for yet. That exchange has its answer now: once the call is answered, nothing else tells the
  // thread to go on.
  static void AnswerBelow(Task& task);

  // True if what `by` does happens later.
  bool PutOff(const Task* by, Late late);
  PollOutcome TakePutOff(EventTime when);
  // True if the message was said before the thread's turn, which is its answer.
  bool IsSaidBeforeTurn(Task& task, const shm::PipeMessage& message);

  // The running thread is to stop, and has not said anything.
  void BringToGate(Task& task);
  // Before `sender`, which sends a signal, goes on: no other thread may be about to make a call.
  PollOutcome BringOthersToGates(const Task& sender, EventTime when);
  // Threads that were looked at for a signal may be running its handler already.
  void AwaitHandlers();
  // The time that the thread has computed since its last turn ended is a debt.
  void ChargeUndispatched(Task& task);

 private:
  struct WayToGate {
    HostDuration look_every;
    HostDuration most;  // that the way takes a thread, by its CPU clock
  };
  PollOutcome AwaitSleepAtGates(EventTime when);
  PollOutcome AwaitThreads(EventTime when, const WayToGate& way,
                           const std::function<bool(const Task&)>& is_awaited,
                           const std::function<void(Task&)>& at_first);

  bool says_call_ = false, opens_gate_ = false;
  std::vector<Late> put_off_;
};

}  // namespace tcs
