// Threads that wait for others of their robot by looking at memory again and again: libraries for
// parallel loops do so for as long as it takes another core to come along, rather than sleep.
//
// Here one core acts after the other. A thread that spins waits for something that cannot happen
// before the others act, and what they do is for it to see when they have done it, not a drift
// bound later. So its turn ends. The others go on in short steps, and after each it looks again.
// The time in between it is charged, though it has not computed it: on the robot it spins on.
//
// How long a step is follows from how long it has waited. After a millisecond it does compute what
// it spins: most libraries count how often they look before they sleep.
//
// Who looks without pausing or yielding does not end its turns. Such a thread is asked now and then
// where it is; if that is in a loop that only looks (shm/machine_code/spin_loop.h), the cores on
// which threads of its process compute stay close to each other for a while.
//
// A thread that looks at its clock meanwhile, to give up in time, gets no time that it has not
// computed: it would see its clock leap. For the coordinator's thread only.
#pragma once

#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class SpinWaits {
 public:
  static constexpr VirtualDuration kLeastStep = VirtualDuration::Microseconds(20),
                                   kMostStep = VirtualDuration::Microseconds(50),
                                   kLong = VirtualDuration::Milliseconds(1),
                                   kAskEvery = VirtualDuration::Milliseconds(1),
                                   kClose = VirtualDuration::Milliseconds(10);

  explicit SpinWaits(RunState& run) : run_(run) {}

  // What a thread of the process computes between two looks at most, by its clock, in ns; 0: nobody
  // is to know whether it spins.
  static std::uint32_t GapFor(const RunState& run, const Process& process);

  // Threads of that run are asked whether they spin.
  static bool AsksThreads(const RunState& run);
  // The thread's turn is about to begin, and it is to be asked.
  bool IsToBeAsked(Task& task) const;

  // The thread's turn, which began at `start`, has ended. True if it has begun to spin.
  bool TurnEnds(Task& task, VirtualTime start) const;
  // It ended since the thread spins: until its next look time passes.
  void PassTime(Task& task) const;

  // It is about to look. What it may see now was done by then: it looks no earlier. True if it is
  // to be dispatched only once it has paid what it owes.
  bool IsBeforeItsLook(Task& task) const;

  // So far the thread may go, for others of its robot spin: they are to see what it does.
  VirtualTime LimitOf(const Task& task) const;
  // If it spins, its turn ends then; never where nobody else computes.
  VirtualTime EndOfSpin(const Task& task) const;

 private:
  static bool Passes(const Task& task);
  static VirtualDuration StepOf(const Task& task);
  static void Pass(Task& task, VirtualDuration duration);
  // How far the least advanced core is on which another thread may do what this one waits for: it
  // computes, or spins and has not seen yet what others did last. Never: there is none.
  VirtualTime LeastThatActs(const Task& task) const;
  // When another core of the robot acts next, whatever it does now.
  static VirtualTime NextToWake(const Task& task);

  RunState& run_;
};

}  // namespace tcs
