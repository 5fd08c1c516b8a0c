// The one door through which a thread comes to act, or to wait: every change of a thread's state
// goes through here, with the time at which it happens, and the robot's scheduler hears of it.
//
// For the coordinator's thread only. Makes no system call itself; the listeners that it tells may.
#pragma once

#include <cstdint>
#include <functional>

#include "coordinator/policy/robot_scheduler.h"
#include "coordinator/tasks/activations.h"
#include "coordinator/tasks/event_time.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/task.h"
#include "coordinator/tasks/wait.h"
#include "shm/layout.h"

namespace tcs {

class Waker {
 public:
  // The parts that keep something for a thread as long as it waits. All functions must be set but
  // the one that may be null.
  struct Listeners {
    // The wait has begun; a signal that ends it may be pending already.
    std::function<void(Task&)> began_by_signal;
    // The wait is over: the thread's place in queues is given up.
    std::function<void(Task&, tcs::Wait&)> left;
    // A wait in a trapped call ends, for that reason; `wait` is still there.
    std::function<void(Task&, shm::WakeReason)> ends_in_trapped_call;
    // A deliverer of DDS messages is held up by something else.
    std::function<void(const Process&, EventTime)> deliverer_is_held_up;
    // The virtual CPU does nothing before that time, though it has a turn; may be null.
    std::function<VirtualTime(const VirtualCpu&)> does_nothing_before;
  };

  Waker(RunState& run, Activations& activations) : run_(run), activations_(activations) {}
  void Tell(Listeners listeners) { listeners_ = std::move(listeners); }

  // The thread may act again, from `when` on, but not before others have passed that time where it
  // has waited for what they do. Nothing happens to a dead thread.
  void Wake(Task& task, shm::WakeReason reason, EventTime when);
  // The thread acts again once it can miss nothing (kRead), or be too early for nobody (kWrite).
  void Hold(Task& task, shm::NotificationKind for_what);
  // The same for a call that the kernel carries out next. Under callback nobody is ahead.
  void HoldInCall(Task& task, shm::NotificationKind for_what) {
    if (!run_.IsCallback()) Hold(task, for_what);
  }
  // The beginning of a wait, and its end; nothing happens if the thread does not wait.
  void Wait(Task& task, tcs::Wait wait);
  void Leave(Task& task);
  // Moves the deadline of a thread that waits.
  void MoveDeadline(Task& task, VirtualTime to);
  // The other changes: the thread has registered, is in the kernel's hands, has ended.
  void SetState(Task& task, TaskState state, bool goes_first = false);

  // The robot's scheduler takes note of where the thread stands, whose state is the same.
  void Requeue(Task& task, bool goes_first = false);
  // Every change of what a robot could do next ends with this call.
  void Refresh(Robot& robot);

  static bool IsRunnable(const Task& task);
  // Whether the thread is not held up by what others may still do.
  bool IsSafe(const Task& task) const;
  // Whether the thread's wait is over by time: the world's, or, where other threads of the process
  // compute while the world stands still, that of the process's own clock.
  bool HasRunOut(const Task& task, VirtualTime now) const;
  // When the thread's wait is over, as its process's clock tells it.
  static ProgramTime OwnDeadlineOf(const Task& task);
  // The wait as the thread's robot's scheduler is to know it.
  RobotScheduler::Wait WaitOf(const Task& task) const;
  // An event that arrives later than the drift bound allows for (the kernel may take its time) is
  // seen when the bound is over, not in the past of those who have gone on.
  VirtualTime EarliestWake() const;
  // Something that was sent at `sent` wakes a thread. The core that the thread runs on at once may
  // have come further.
  void NoteLateness(const Task& woken, VirtualTime sent, bool goes_first);

  // The world waits for what is written to terminals, as long as the run lasts.
  void AwaitTerminals() {
    counts_.EnteredForTerminals();
    ShowObjectWaiters();
  }

  const WaitCounts& counts() const { return counts_; }
  int unseen() const { return unseen_; }  // threads in TaskState::kUnseen

 private:
  static VirtualDuration WakeupOf(const Task& task);
  void ShowObjectWaiters();

  RunState& run_;
  Activations& activations_;
  Listeners listeners_;
  WaitCounts counts_;
  int unseen_ = 0;
};

}  // namespace tcs
