// Turns that begin before their order, on another processor of the host (host/beside_cpu.h).
//
// The order of turns stays what it is: one after the other, the least advanced virtual CPU first,
// and what a turn has come to counts when it is its order. But a turn that nobody can change any
// more may be had before, while others have theirs:
//
//   - All threads of the robot wait for time alone, or are ready, and it has one core. So until its
//     next turn nothing happens on it that it does not do itself, whatever others do.
//   - The turn is over before the dynamics have something for the robot, and before it is further
//     from the slowest leaf than the drift bound.
//   - In its turn the thread does to others only what is looked at in its order: commands that it
//     posts (shm/command_ring.h), and datagrams to sockets that are local to its robot. It reads
//     from such sockets alone. All else ends the turn, and is done in the next one, which has its
//     order.
//
// What another robot could do all the same is to send a signal, or to reach a local socket for the
// first time. Both count as done when the turn is over (calls/local_sockets.h, Robot::Furthest),
// and the robot has no such turns from then on.
//
// Worth while for short turns, one after the other: of loops that tick, say. Only under measured
// accounting, where the world goes on meanwhile. For the coordinator's thread only.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "coordinator/engine/computing_ahead.h"
#include "coordinator/host/beside_cpu.h"
#include "coordinator/host/executor.h"
#include "coordinator/processes/run_records.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/run_clock.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class TurnsBeside {
 public:
  struct Parts {
    RunState& run;
    Executor& executor;
    const RunClock& clock;
    const ComputingAhead& ahead;
    RunRecords& records;
  };
  // `poll` has what has happened by now handled, as something of that moment.
  TurnsBeside(const Parts& parts, std::function<PollOutcome(EventTime)> poll)
      : parts_(parts), poll_(std::move(poll)) {}

  // On the first of these processors, if there is one.
  void Open(int home, const std::vector<int>& further);
  // Null: there is none.
  const BesideCpu* cpu() const { return cpu_.get(); }

  // Whether any turn may begin now, and of how many virtual CPUs it is to be looked at.
  bool MayBegin();
  static constexpr std::size_t kMostLooks = 16;
  // Whether a turn on the robot may, and of that thread, which is the next one there.
  static bool MayBegin(const Robot& robot);
  static bool MayBegin(const Task& task);
  // A turn would begin now. True if the processor is somebody else's at the moment.
  bool IsTaken();
  // The thread's page is written. False if the kernel does not let the thread go there.
  bool Begin(Task& task, VirtualTime horizon);

  // It is the turn's order. Until the thread has said something or has ended; false if it is not
  // waited for any longer: then it stands still at home, in the midst of what it does.
  bool Await(Task& task);
  // What it has said is taken, and the turn is over for this class.
  void Take(Task& task);
  // The process has ended. True if it did so in such a turn: it happens when that has its order.
  static bool NoteExitIn(const Process& process);
  // A thread that lives beside is to run here.
  void BringHome(Task& task);
  // It has ended.
  void Forget(Task& task);

  // What the thread's turn was, wherever it had it, once the thread has been answered.
  void NoteTurn(Task& task, bool beside) const;

 private:
  bool IsOver(const Task& task) const;

  const Parts parts_;
  const std::function<PollOutcome(EventTime)> poll_;
  std::unique_ptr<BesideCpu> cpu_;
};

}  // namespace tcs
