// Turns that begin before their order, on another processor of the host (host/beside_cpu.h).
//
// The order of turns stays what it is: one after the other, the least advanced virtual CPU first,
// and the result of a turn counts when the turn has its order. But a turn that nothing else can
// change any more may be had before, while others have theirs:
//
//   - All threads of the robot wait for time alone, or are ready, and the robot has one core. So
//     until its next turn nothing happens on the robot that it does not do itself, whatever others
//     do.
//   - The turn is over before the dynamics have something for the robot, and before the robot is
//     further from the slowest leaf than the drift bound.
//   - In its turn the thread does to others only what is looked at in its order: commands that it
//     posts (shm/command_ring.h), and datagrams to sockets that are local to its robot. The thread
//     reads from such sockets alone. Any other act ends the turn, and is done in the next turn,
//     which has its order.
//
// Another robot could all the same send a signal, or reach a local socket for the first time. Both
// acts count as done when the turn is over (calls/local_sockets.h, Robot::Furthest), and the robot
// has no such turns from then on.
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
  // `poll` handles what has happened by now, as something of that moment.
  TurnsBeside(const Parts& parts, std::function<PollOutcome(EventTime)> poll)
      : parts_(parts), poll_(std::move(poll)) {}

  // On the first of these processors, if there is one.
  void Open(int home, const std::vector<int>& further);
  // Null: there is none.
  const BesideCpu* cpu() const { return cpu_.get(); }

  // Whether any turn may begin now, and how many virtual CPUs are to be looked at.
  bool MayBegin();
  static constexpr std::size_t kMostLooks = 16;
  // Whether a turn on the robot may begin, and a turn of that thread, which is the next one there.
  static bool MayBegin(const Robot& robot);
  static bool MayBegin(const Task& task);
  // A turn would begin now. True if another thread has the processor at the moment.
  bool IsTaken();
  // The thread's page is written. False if the kernel does not let the thread go there.
  bool Begin(Task& task, VirtualTime horizon);

  // The turn's order has come. Waits until the thread has said something or has ended; false if the
  // thread is not waited for any longer: then it stands still at home, in the midst of what it
  // does.
  bool Await(Task& task);
  // Takes what the thread has said: the turn is over for this class.
  void Take(Task& task);
  // The process has ended. True if it ended in such a turn: the end happens when that turn has its
  // order.
  static bool NoteExitIn(const Process& process);
  // A thread that lives beside is to run here.
  void BringHome(Task& task);
  // The thread has ended.
  void Forget(Task& task);

  // Notes what the thread's turn was, wherever the thread had it, once the thread has been
  // answered.
  void NoteTurn(Task& task, bool beside) const;

 private:
  bool IsOver(const Task& task) const;

  const Parts parts_;
  const std::function<PollOutcome(EventTime)> poll_;
  std::unique_ptr<BesideCpu> cpu_;
};

}  // namespace tcs
