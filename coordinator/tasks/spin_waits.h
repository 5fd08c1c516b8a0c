// Threads that wait for others of their robot by looking at memory again and again: libraries for
// parallel loops do so for as long as it takes another core to come along, rather than sleep.
//
// Here one core acts after the other. A thread that spins waits for something that cannot happen
// before the other threads act, and it is to see their acts when they have acted, not a drift bound
// later. So its turn ends. The others go on in short steps, and after each step the spinning thread
// looks again. The thread is charged for the time in between, though it has not computed then: on
// the robot it spins on.
//
// The length of a step follows from how long the thread has waited. After a millisecond the thread
// does compute what it spins: most libraries count how often they look before they sleep.
//
// A thread that looks without pausing or yielding does not end its turns. Such a thread is asked
// now and then where it is; if it is in a loop that only looks (shm/machine_code/spin_loop.h), the
// cores on which threads of its process compute stay close to each other for a while.
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

  // The most that a thread of the process computes between two looks, by its clock, in ns; 0:
  // nobody is to know whether the thread spins.
  static std::uint32_t GapFor(const RunState& run, const Process& process);

  // Threads of that run are asked whether they spin.
  static bool AsksThreads(const RunState& run);
  // The thread's turn is about to begin, and it is to be asked.
  bool IsToBeAsked(Task& task) const;

  // The thread's turn, which began at `start`, has ended. True if it has begun to spin.
  bool TurnEnds(Task& task, VirtualTime start) const;
  // The turn ended since the thread spins: until the thread's next look time passes.
  void PassTime(Task& task) const;

  // The thread is about to look. It looks no earlier than the acts of others that it may see now.
  // True if the thread is to be dispatched only once it has paid what it owes.
  bool IsBeforeItsLook(Task& task) const;

  // How far the thread may go where other threads of its robot spin: they are to see what it does.
  VirtualTime LimitOf(const Task& task) const;
  // When the thread's turn ends if the thread spins; never where no other thread computes.
  VirtualTime EndOfSpin(const Task& task) const;

 private:
  static bool Passes(const Task& task);
  static VirtualDuration StepOf(const Task& task);
  static void Pass(Task& task, VirtualDuration duration);
  // How far the least advanced core is on which another thread may do what this one waits for: the
  // other thread computes, or spins and has not seen yet what others did last. Never: there is
  // none.
  VirtualTime LeastThatActs(const Task& task) const;
  // When another core of the robot acts next, whatever it does now.
  static VirtualTime NextToWake(const Task& task);

  RunState& run_;
};

}  // namespace tcs
