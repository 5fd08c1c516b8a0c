// The loop's decisions about a virtual CPU's next turn, once the scheduler has chosen its thread:
// how far the thread may run, whether others of the same instant go first, whether the turn only
// passes what the thread has computed already, how far the world is to be taken ahead meanwhile,
// and whether the thread counts as one that computes.
//
// loop.h carries them out. Pure: makes no system call, reads no clock.
#pragma once

#include <algorithm>
#include <optional>

#include "coordinator/tasks/task.h"
#include "shm/layout.h"
#include "shm/time_kinds.h"

namespace tcs {

// The limits of a turn, but for the other threads of its robot.
struct TurnLimits {
  VirtualTime start;                                   // the virtual CPU's progress
  VirtualTime apart = VirtualTime::Never();            // no leaf gets further from the slowest
  std::optional<VirtualDuration> cpu_time;             // until a timer on processor time runs out
  VirtualTime next_launch = VirtualTime::Never();      // a program of the robot's starts
  VirtualTime next_timer_look = VirtualTime::Never();  // at timers that rest (process_timers.h)
};

// The furthest that a clock page can tell of one dispatch.
constexpr VirtualTime FurthestOf(VirtualTime start) {
  return start + VirtualNs(shm::kMaxDispatchNs - 1);
}

// A launch or a look that is due already stops no turn before the turn has begun.
constexpr VirtualTime LimitOf(const TurnLimits& limits) {
  constexpr VirtualDuration kBetweenLooks = VirtualDuration::Microseconds(10);
  VirtualTime limit = std::min(limits.apart, FurthestOf(limits.start));
  if (limits.cpu_time.has_value())
    limit = std::min(limit, AtMostNever(limits.start, *limits.cpu_time));
  limit = std::min(limit, std::max(limits.next_launch, limits.start));
  return std::min(limit, std::max(limits.next_timer_look, limits.start + kBetweenLooks));
}

// A thread that may not run at all, because at this very instant others may still wake a thread
// that goes before it, lets those others act first, once.
constexpr bool GivesWay(VirtualTime start, VirtualTime horizon, VirtualTime next_input,
                        bool has_given_way) {
  return horizon <= start && next_input == start && !has_given_way;
}

// The thread owes so much that it would come to its horizon without running: then that time passes,
// and the thread is not dispatched. A thread that has not registered has no clock that could show
// that time. A thread that holds pays all that it owes first: it goes on, to read or to write, at
// the time that its clock shows, and that time has to be safe.
constexpr bool OnlyPays(TaskState state, VirtualTime start, VirtualDuration debt,
                        VirtualTime horizon) {
  if (state == TaskState::kHolding && debt > VirtualDuration()) return true;
  return state != TaskState::kStarting && start + debt >= horizon;
}

// How often in a row a thread has come to its horizon, after a turn that has ended at `reached`.
constexpr int UsedUpAfter(int before, VirtualTime reached, VirtualTime horizon, bool has_spoken) {
  if (reached >= horizon) return before + 1;
  return has_spoken ? 0 : before;
}

// Where the world is, before a turn.
struct WorldBeside {
  VirtualTime now;      // the virtual CPU's progress
  VirtualTime world;    // the dynamics' progress
  VirtualTime horizon;  // of the turn
  VirtualTime apart;    // as far as the drift bound lets the virtual CPU go
  VirtualDuration drift_bound;
  bool computes = false;  // the thread computes on and on
};

// How far the dynamics are to lead; none: they are near enough. To move them costs next to nothing,
// but every horizon costs a context switch. So they may lag behind while threads act for short, and
// where a thread computes on and on they lead: within the drift bound on either side its slices are
// twice as long.
constexpr std::optional<VirtualTime> WhereToLead(const WorldBeside& beside) {
  const VirtualDuration bound = std::min(beside.drift_bound, VirtualNs(shm::kMaxDispatchNs));
  const VirtualTime room =
      beside.computes ? beside.horizon : std::min(beside.horizon, beside.now + bound / 2);
  if (beside.world + bound >= room) return std::nullopt;
  // The dynamics lead as far as they may: the fewer slices, the better.
  return beside.computes ? std::min(beside.now + bound, beside.apart) : beside.now;
}

}  // namespace tcs
